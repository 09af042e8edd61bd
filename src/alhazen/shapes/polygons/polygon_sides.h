#pragma once
/// The sides of a ray on which the corners of a polygon lie, for many corners at a time.

#include <cstddef>
#include <cstdint>
#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Largest number of corners of a call.
inline constexpr std::size_t kMostSides = 64;

/// What determines `ShearedVertex::y` of a corner: the ray's dominant axis, its origin along the
/// axes ky and kz of RayShear, and its slope.
struct SideRay {
    int kz;
    double oy, oz, sy;
};

/// Bit i is set if corner i has y > 0 in the sheared space of the ray, with the bits of `sheared`
/// (geometry/watertight_triangle.h).
[[nodiscard]] std::uint64_t corners_above(std::span<const Vec3> corners, const SideRay& ray);

}  // namespace alhazen
