#pragma once
/// Mirror and refracted directions.
///
/// Source: Heckbert, "Writing a Ray Tracer", in Glassner (ed.), An Introduction to Ray Tracing,
/// 1989.
/// Conventions: `d` and `n` unit, dot(d, n) <= 0 for the side the ray comes from; results unit.

#include <cmath>

#include "alhazen/math/vec.h"

namespace alhazen {

inline Vec3 mirror(const Vec3& d, const Vec3& n) {
    return normalize(d - (2.0 * dot(d, n)) * n);
}

/// Sets `direction` by Snell's law; `eta` = index on the incoming side / index beyond. False for
/// total internal reflection.
[[nodiscard]] inline bool refract(const Vec3& d, const Vec3& n, double eta, Vec3& direction) {
    const double cos_i = -dot(d, n);
    const double k = 1.0 - eta * eta * (1.0 - cos_i * cos_i);
    if (!(k >= 0.0)) return false;
    direction = normalize(eta * d + (eta * cos_i - std::sqrt(k)) * n);
    return true;
}

}  // namespace alhazen
