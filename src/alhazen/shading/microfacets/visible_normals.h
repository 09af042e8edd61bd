#pragma once
/// Integrals over the normals of rough facets that a view sees and that reflect it upwards.
///
/// Source: Heitz, "Sampling the GGX Distribution of Visible Normals", JCGT 2018 (the space in which
/// the surface is a hemisphere); Walter et al., "Microfacet Models for Refraction through Rough
/// Surfaces", EGSR 2007 (shadowing).
/// Differs: of each azimuth of the stretched normal, the facets that reflect the view upwards are
/// those up to the root of a quadratic equation: the integrand ends there, without a bend.
/// Complexity: 4 x 10 x 10 points.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

/// By symmetry, of the first quadrant: the view in the space where the surface is a hemisphere.
[[nodiscard]] inline Vec3 stretched(const Vec3& view, const Ggx& ggx) {
    const Vec3 s{ggx.x * std::abs(view.x), ggx.y * std::abs(view.y), view.z};
    return s / length(s);
}

/// The mean over the visible normals of G2 / G1 times `f`, of normals that reflect the view
/// upwards. `f(c, l)`: the cosine of the view to the facet's normal is c / sqrt(l) times that to
/// the surface's. `s`: the stretched view, z above 0.
template <class F>
[[nodiscard]] double over_visible_normals(const Vec3& s, const Ggx& ggx, const F& f) {
    static const GaussLegendre<10> turns, tangents;
    // By the azimuth of the stretched normal and the tangent t of its angle to z. Lengths are
    // relative to the z of the view.
    const double ax = ggx.x * ggx.x, ay = ggx.y * ggx.y;
    const double vx = s.x / s.z, vy = s.y / s.z, v = 1.0 / s.z;
    // Pieces between the azimuths across the view, and the axis of least roughness, near which
    // the functions change fast.
    const double azimuth = std::atan2(s.y, s.x), axis = ax < ay ? 0.0 : 0.5 * kPi;
    std::array<double, 5> ends{azimuth - 0.5 * kPi, azimuth + 0.5 * kPi, azimuth + 1.5 * kPi, axis,
                               axis + kPi};
    for (double& end : ends) {
        if (end < ends[0]) end += 2.0 * kPi;
    }
    std::sort(ends.begin(), ends.end());
    double sum = 0;
    for (std::size_t piece = 0; piece + 1 < ends.size(); ++piece) {
        const double width = ends[piece + 1] - ends[piece];
        for (std::size_t i = 0; i < turns.points.size(); ++i) {
            const double turn = ends[piece] + width * turns.points[i];
            const double c = std::cos(turn), d = std::sin(turn);
            const double along = s.x * c + s.y * d, q = ax * c * c + ay * d * d;
            const double root = std::sqrt(along * along + s.z * s.z * q);
            const double most = along < 0.0 ? s.z / (root - along) : (along + root) / (s.z * q);
            const double last = most / (1.0 + most);
            double inner = 0;
            for (std::size_t j = 0; j < tangents.points.size(); ++j) {
                // Denser towards the last.
                const double y = 1.0 - tangents.points[j];
                const double u = last * (1.0 - y * y), t = u / (1.0 - u);
                const double weight =
                    tangents.weights[j] * 2.0 * y * last / ((1.0 - u) * (1.0 - u));
                // The reflected direction, stretched.
                const double lean = 1.0 + q * t * t, cosine = along * t * v + 1.0;
                const double facet = 2.0 * cosine / lean;
                const double lx = facet * ax * t * c - vx, ly = facet * ay * t * d - vy;
                const double lz = std::max(0.0, facet - 1.0);
                const double l = std::sqrt(lx * lx + ly * ly + lz * lz);
                const double shadowing = lz * (1.0 + v) / (l + lz * v);
                const double tt = 1.0 + t * t;
                inner += weight * (along * t + s.z) * t / (tt * tt) * shadowing * f(cosine, lean);
            }
            sum += width * turns.weights[i] * inner;
        }
    }
    return 2.0 * sum / (kPi * (1.0 + s.z));
}

}  // namespace alhazen
