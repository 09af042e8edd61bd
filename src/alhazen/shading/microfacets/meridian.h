#pragma once
/// Integrals over the normals visible from a view of a rough surface, along meridians of the cap of
/// visible normals, piecewise between the places where rays change sides.
///
/// Source: Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", HPG 2023 (the
/// cap); Gauss-Legendre quadrature on each piece.

#include <cmath>

#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/ggx.h"

namespace alhazen {

/// Sum of weight * f(normal), where the weights of all visible normals sum to 1. `state(normal)`: a
/// number that is constant where f is smooth. The view lies in the plane of x and z; y >= 0 stands
/// for both halves.
template <class State, class F>
void for_visible_normals(const Ggx& ggx, const Vec3& view, const State& state, const F& f) {
    static const GaussLegendre<32> turns;
    static const GaussLegendre<12> radii;
    constexpr int kSteps = 24, kHalvings = 16;
    for (std::size_t i = 0; i < turns.points.size(); ++i) {
        // Denser towards facets that lean away from the view, and (by q) towards steep ones.
        const double t = turns.points[i], turn = 0.5 * (1.0 - t * t * t);
        const double meridian = 3.0 * t * t * turns.weights[i];
        const auto normal = [&](double q) {
            return ggx.sample_visible(view, {turn, 1.0 - q * q * q});
        };
        const auto add_piece = [&](double a, double b) {
            for (std::size_t j = 0; j < radii.points.size(); ++j) {
                const double q = a + (b - a) * radii.points[j];
                f(normal(q), meridian * 3.0 * q * q * (b - a) * radii.weights[j]);
            }
        };
        double upper = 1, last = 1;
        int now = state(normal(1));
        for (int k = 1; k <= kSteps; ++k) {
            const double q = k == kSteps ? 1e-9 : 1.0 - static_cast<double>(k) / kSteps;
            const int next = state(normal(q));
            if (next != now) {
                double from = last, to = q;
                for (int step = 0; step < kHalvings; ++step) {
                    const double middle = 0.5 * (from + to);
                    (state(normal(middle)) == now ? from : to) = middle;
                }
                add_piece(to, upper);
                upper = to;
                now = next;
            }
            last = q;
        }
        add_piece(0.0, upper);
    }
}

}  // namespace alhazen
