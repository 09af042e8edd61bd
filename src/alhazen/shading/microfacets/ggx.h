#pragma once
/// Microfacet distribution GGX (Trowbridge-Reitz), isotropic or anisotropic.
///
/// Source: Trowbridge and Reitz, "Average Irregularity Representation of a Rough Surface for Ray
/// Reflection", JOSA 65, 1975; Walter et al., "Microfacet Models for Refraction through Rough
/// Surfaces", EGSR 2007; Heitz, "Understanding the Masking-Shadowing Function in Microfacet-Based
/// BRDFs", JCGT 3(2), 2014 (equations 72 and 99); Dupuy and Benyoub, "Sampling Visible GGX Normals
/// with Spherical Caps", HPG 2023, algorithm 3.
/// Conventions: local frame; normals of microfacets have z > 0; views above the surface.

#include <algorithm>
#include <cmath>

#include "alhazen/math/angles.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"

namespace alhazen {

/// Roughness below which a surface counts as smooth: the lobe is narrower than pixels resolve.
inline constexpr double kSmoothAlpha = 5e-4;

struct Ggx {
    double x = 0.1, y = 0.1;  ///< roughness alpha along the tangents

    /// Length of `v` in the space where the surface is a hemisphere; used by the masking.
    [[nodiscard]] double stretched_length(const Vec3& v) const {
        return std::sqrt(x * x * v.x * v.x + y * y * v.y * v.y + v.z * v.z);
    }

    /// Distribution of normals D(m), per solid angle and area of the surface.
    [[nodiscard]] double normals(const Vec3& m) const {
        const double a = m.x / x, b = m.y / y;
        const double s = a * a + b * b + m.z * m.z;
        return 1.0 / (kPi * x * y * s * s);
    }

    /// Masking G1(v): share of the facets turned to `v` that are visible from it.
    [[nodiscard]] double masking(const Vec3& v) const {
        const double z = std::abs(v.z);
        return 2.0 * z / (z + stretched_length(v));
    }
    /// Share of the facets visible from `v` that are visible from `l` too.
    [[nodiscard]] double shadowing(const Vec3& v, const Vec3& l) const {
        const double vz = std::abs(v.z), lz = std::abs(l.z);
        const double a = stretched_length(v);
        return lz * (vz + a) / (vz * stretched_length(l) + lz * a);
    }

    /// Density of the visible normals divided by dot(v, m): times `cosine` = dot(v, m) > 0 it is
    /// the density of `m` by solid angle.
    [[nodiscard]] double visible_normals(const Vec3& v, const Vec3& m, double cosine) const {
        return 2.0 * cosine * normals(m) / (v.z + stretched_length(v));
    }

    /// Samples a normal visible from `v`, with the density of `visible_normals`.
    [[nodiscard]] Vec3 sample_visible(const Vec3& v, const Vec2& u) const {
        const Vec3 s = Vec3{x * v.x, y * v.y, v.z} / stretched_length(v);
        const Vec2 around = direction_after(u.x);
        const double z = (1.0 - u.y) * (1.0 + s.z) - s.z;
        const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
        const Vec3 h = Vec3{radius * around.x, radius * around.y, z} + s;
        // At grazing views the sampled facet may be edge-on and lean away: z is clamped.
        return h == Vec3{} ? Vec3{0, 0, 1} : normalize(Vec3{x * h.x, y * h.y, std::max(h.z, 0.0)});
    }
};

}  // namespace alhazen
