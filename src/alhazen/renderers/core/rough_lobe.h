#pragma once
/// The lobe of directions into which a rough surface sends a ray.
///
/// Source: Cook, Porter and Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984, sections 4.1 and
/// 4.2 (gloss, translucency); Phong 1975 (cos^n about the mirror direction); Walter et al. 2007
/// (normals of roughness alpha as a Blinn-Phong lobe of exponent 2 / alpha^2 - 2).
/// Conventions: alpha = roughness^2. The lobe of directions has a quarter of the exponent of the
/// lobe of normals, whose angles are half as large.

#include <algorithm>
#include <cmath>

#include "alhazen/math/unit_vector.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

/// The exponent n of the lobe cos^n for a roughness above 0.
[[nodiscard]] inline double lobe_exponent(double roughness) {
    const double alpha = roughness * roughness;
    return std::max(0.0, 0.25 * (2.0 / (alpha * alpha) - 2.0));
}

/// A direction of the lobe cos^n about the unit `axis`, for `u` in the unit square.
[[nodiscard]] inline Vec3 in_lobe(const Vec3& axis, double n, const Vec2& u) {
    const Vec2 p = on_unit_disc(u);
    const double share = p.x * p.x + p.y * p.y;  // uniform in 0 .. 1
    const double cosine = std::pow(1.0 - share, 1.0 / (n + 1.0));
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    const double scale = share > 0.0 ? sine / std::sqrt(share) : 0.0;
    const Vec3 a = perpendicular(axis), b = cross(axis, a);
    return normalize(cosine * axis + (scale * p.x) * a + (scale * p.y) * b);
}

/// The half angle of the cone of uniform directions with the spread of the lobe: the mean of sin^2
/// is 2 / (n + 3) in the lobe and sin^2(a) / 2 in a narrow cone of half angle a.
[[nodiscard]] inline double lobe_half_angle(double roughness) {
    if (!(roughness > 0.0)) return 0.0;
    return std::asin(std::min(1.0, 2.0 / std::sqrt(lobe_exponent(roughness) + 3.0)));
}

}  // namespace alhazen
