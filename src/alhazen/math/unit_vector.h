#pragma once
/// Unit vectors along vectors of any length, with a fallback.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The unit vector along `v`, or `fallback` if `v` is zero or not finite. Does not over- or
/// underflow.
inline Vec3 unit_or(const Vec3& v, const Vec3& fallback) {
    const double squared = length_squared(v);
    if (squared > 1e-200 && squared < 1e200) return v / std::sqrt(squared);
    const double largest = max_component(abs(v));
    if (!(largest > 0.0) || !is_finite(v)) return fallback;
    // Scales by a power of two, which is exact (in two steps, for subnormals).
    const int exponent = std::ilogb(largest);
    const double half = std::ldexp(1.0, -exponent / 2);
    const double rest = std::ldexp(1.0, -exponent - (-exponent / 2));
    return normalize((v * half) * rest);
}

}  // namespace alhazen
