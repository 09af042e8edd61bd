#pragma once
/// Rays with directions of any length that double holds, asked about as rays of usual length.
///
/// Source: IEEE 754 (a product with a power of two does not round). Differs: nothing.
/// Conventions: intersections take products of a few components of a direction, which overflow or
/// vanish for lengths like 1e160 or 1e-160. Such a direction is divided by a power of two near its
/// length, and t multiplied: both are exact, but for a t that leaves the range of double on the
/// way back (it is then 0, infinite, or of fewer digits).

#include <cmath>

#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Rays whose longest component lies between these are traced as they are.
inline constexpr double kShortestDirection = 0x1p-40, kLongestDirection = 0x1p40;

/// The power of two to divide the direction by; 0 for a usual one, and for none at all.
[[nodiscard]] inline int unusual_exponent(const Vec3& direction) {
    const double longest = max_component(abs(direction));
    if (longest >= kShortestDirection && longest <= kLongestDirection) return 0;
    return longest > 0.0 && std::isfinite(longest) ? std::ilogb(longest) : 0;
}

/// The same line and limits: what the ray meets at t it meets at ldexp(t, exponent).
[[nodiscard]] inline Ray rescaled(const Ray& ray, int exponent) {
    Ray usual = ray;
    for (int k = 0; k < 3; ++k) usual.direction[k] = std::ldexp(ray.direction[k], -exponent);
    usual.t_min = std::ldexp(ray.t_min, exponent);
    usual.t_max = std::ldexp(ray.t_max, exponent);
    return usual;
}

}  // namespace alhazen
