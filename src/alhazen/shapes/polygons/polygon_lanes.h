#pragma once
/// The first crossings of eight rays with a polygon, in lanes.
///
/// Source: polygon.cpp, the same formulas in the same order.
/// Differs: rays along another axis than the first one, and those whose edge function is zero, are
/// left to the scalar code.
/// Conventions: bit i of a set stands for lane i. Every target returns the bits of the scalar code.

#include <cstdint>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/shapes/polygons/polygon.h"

namespace alhazen {

/// What the kernel finds.
struct alignas(64) PolygonHitLanes {
    double t[kRayLanes];  ///< for the lanes that hit
    std::uint32_t hit;
    std::uint32_t unsure;  ///< lanes left to the scalar code
};

/// Of the rays `wanted`: returns those that hit, and writes their crossings to [lane]. Shapes with
/// this form alone are none that packets are made for (shapes/core/first_hits.h).
[[nodiscard]] std::uint32_t first_hits(const Polygon& shape, const RayLanes& rays,
                                       std::uint32_t wanted, ShapeHit* hits);

}  // namespace alhazen
