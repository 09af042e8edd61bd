#pragma once
/// The first crossings of eight rays with a polygon, in lanes.
///
/// Source: polygon.cpp, the same formulas in the same order.
/// Differs: rays whose dominant axis is not that of the first ray, and those with an edge function
/// of zero, use the scalar code.
/// Conventions: bit i of a set stands for lane i. Every target returns the bits of the scalar code.

#include <cstdint>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/polygons/polygon.h"

namespace alhazen {

/// Output of the kernel.
struct alignas(64) PolygonHitLanes {
    double t[kRayLanes];  ///< for the lanes that hit
    std::uint32_t hit;
    std::uint32_t unsure;  ///< lanes that need the scalar code
};

/// Returns the rays of `wanted` that hit, and writes their first crossings to hits[lane]. Polygons
/// do not count as shapes with a test in lanes for the schedule (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Polygon& shape, const RayLanes& rays,
                                       std::uint32_t wanted, ShapeHit* hits);

}  // namespace alhazen
