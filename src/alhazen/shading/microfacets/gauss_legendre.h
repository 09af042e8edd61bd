#pragma once
/// Nodes and weights of Gauss-Legendre quadrature over [0, 1].
///
/// Source: Abramowitz and Stegun, "Handbook of Mathematical Functions", 1964, 25.4.29; Newton's
/// method from 22.16.6.

#include <array>
#include <cmath>
#include <cstddef>

#include "alhazen/math/constants.h"

namespace alhazen {

template <std::size_t N>
struct GaussLegendre {
    std::array<double, N> points{}, weights{};

    GaussLegendre() {
        constexpr double kN = N;
        for (std::size_t i = 0; i < N; ++i) {
            double x = std::cos(kPi * (static_cast<double>(i) + 0.75) / (kN + 0.5)), slope = 1;
            for (int step = 0; step < 20; ++step) {
                double before = 1, now = x;
                for (std::size_t k = 2; k <= N; ++k) {
                    const double d = static_cast<double>(k);
                    const double next = ((2.0 * d - 1.0) * x * now - (d - 1.0) * before) / d;
                    before = now;
                    now = next;
                }
                slope = kN * (x * now - before) / (x * x - 1.0);
                x -= now / slope;
            }
            points[i] = 0.5 * (1.0 - x);
            weights[i] = 1.0 / ((1.0 - x * x) * slope * slope);
        }
    }
};

}  // namespace alhazen
