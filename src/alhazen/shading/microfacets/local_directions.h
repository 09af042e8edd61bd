#pragma once
/// Directions in the local frame of a surface, z along its normal.

#include <algorithm>
#include <cmath>

#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Samples a direction above the surface with density cosine / pi; u in [0, 1)^2.
[[nodiscard]] inline Vec3 cosine_direction(const Vec2& u) {
    const double radius = std::sqrt(u.x);
    const Vec2 around = direction_after(u.y);
    return {radius * around.x, radius * around.y, std::sqrt(1.0 - u.x)};
}
[[nodiscard]] inline double cosine_density(const Vec3& direction) {
    return std::max(0.0, direction.z) / kPi;
}

/// Reflection of `v` about the unit normal `m`.
[[nodiscard]] inline Vec3 mirrored(const Vec3& v, const Vec3& m) {
    return 2.0 * dot(v, m) * m - v;
}
[[nodiscard]] inline Vec3 mirrored(const Vec3& v) {
    return {-v.x, -v.y, v.z};
}
/// `v` mirrored in the tangent plane.
[[nodiscard]] inline Vec3 flipped(const Vec3& v) {
    return {v.x, v.y, -v.z};
}
[[nodiscard]] inline bool same_side(const Vec3& a, const Vec3& b) {
    return a.z * b.z > 0.0;
}

/// Direction into which `v` is refracted at a plane with unit normal `m` (on the side of v), given
/// the cosine behind it and the index on this side over that behind.
[[nodiscard]] inline Vec3 refracted(const Vec3& v, const Vec3& m, double cosine_behind,
                                    double eta) {
    return (eta * dot(v, m) - cosine_behind) * m - eta * v;
}

/// Rescales `choice` in [0, 1) after a comparison with `share`, so that it is uniform in [0, 1)
/// again.
[[nodiscard]] inline double remaining_below(double choice, double share) {
    return std::min(choice / share, 0x1.fffffffffffffp-1);
}
[[nodiscard]] inline double remaining_above(double choice, double share) {
    return std::min((choice - share) / (1.0 - share), 0x1.fffffffffffffp-1);
}

}  // namespace alhazen
