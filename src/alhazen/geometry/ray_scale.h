#pragma once
/// Rescales rays whose direction is very long or very short.
///
/// Source: IEEE 754 (a product with a power of two is exact).
/// Conventions: intersections multiply several components of a direction, which over- or underflows
/// for lengths like 1e160 or 1e-160. Such a direction is divided by a power of two near its length,
/// and t multiplied by it: both are exact, except for a t that leaves the range of double on the
/// way back (it becomes 0 or infinite, or loses digits).

#include <cmath>
#include <limits>

#include "alhazen/geometry/ray.h"

namespace alhazen {

/// Range of the longest component of rays that are traced unchanged.
inline constexpr double kShortestDirection = 0x1p-40, kLongestDirection = 0x1p40;

/// The exponent of the power of two by which to divide the direction; 0 for a direction of usual
/// length, and for one that is zero or not finite.
[[nodiscard]] inline int unusual_exponent(const Vec3& direction) {
    const double longest = max_component(abs(direction));
    if (longest >= kShortestDirection && longest <= kLongestDirection) return 0;
    return longest > 0.0 && std::isfinite(longest) ? std::ilogb(longest) : 0;
}

/// A ray with the same line and limits: a hit of the rescaled ray at t is a hit of `ray` at
/// ldexp(t, exponent).
[[nodiscard]] inline Ray rescaled(const Ray& ray, int exponent) {
    Ray usual = ray;
    for (int k = 0; k < 3; ++k) usual.direction[k] = std::ldexp(ray.direction[k], -exponent);
    usual.t_min = std::ldexp(ray.t_min, exponent);
    usual.t_max = std::ldexp(ray.t_max, exponent);
    return usual;
}

/// False for a t that may have lost digits on its way back from a rescaled ray.
[[nodiscard]] inline bool keeps_digits(double t) {
    return std::abs(t) >= std::numeric_limits<double>::min() && std::isfinite(t);
}

}  // namespace alhazen
