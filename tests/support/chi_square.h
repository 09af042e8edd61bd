#pragma once
/// The chi-square test of samples of a density on the sphere.
///
/// Source: Pearson, "On the Criterion that a Given System of Deviations...", Philosophical Magazine
/// 50, 1900; Sidak, "Rectangular Confidence Regions for the Means of Multivariate Normal
/// Distributions", JASA 62, 1967; Press et al., "Numerical Recipes", 3rd edition, 2007, section 6.2
/// (the incomplete gamma function).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/math/vec.h"

namespace alhazen::testing {

/// P(chi-square >= x) for `degrees` degrees of freedom.
inline double chi_square_tail(double x, int degrees) {
    const double a = 0.5 * degrees, y = 0.5 * x;
    if (!(y > 0.0)) return 1.0;
    const double scale = std::exp(-y + a * std::log(y) - std::lgamma(a));
    if (y < a + 1.0) {
        double term = 1.0 / a, sum = term;
        for (int n = 1; n < 2000; ++n) sum += term *= y / (a + n);
        return 1.0 - sum * scale;
    }
    // Lentz's continued fraction.
    double b = y + 1.0 - a, c = 1e300, d = 1.0 / b, h = d;
    for (int n = 1; n < 2000; ++n) {
        const double an = -n * (n - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        h *= d * c;
    }
    return scale * h;
}

/// The level of each of `tests` tests for a probability `together` that any fails by chance.
inline double sidak_level(double together, int tests) {
    return 1.0 - std::pow(1.0 - together, 1.0 / tests);
}

/// Cells of the sphere, uniform in the cosine to z and in the angle around it.
struct SphereCells {
    static constexpr int kHeights = 24, kTurns = 32, kCount = kHeights * kTurns;

    static int cell_of(const Vec3& d) {
        const double turn = std::atan2(d.y, d.x) / (2.0 * kPi);
        const int i = std::clamp(static_cast<int>((0.5 * d.z + 0.5) * kHeights), 0, kHeights - 1);
        const int j = static_cast<int>((turn < 0.0 ? turn + 1.0 : turn) * kTurns);
        return i * kTurns + std::clamp(j, 0, kTurns - 1);
    }
};

namespace detail {

template <class F>
double rectangle_sum(const F& f, double z0, double z1, double t0, double t1) {
    constexpr double kPoints[] = {0.06943184420297371, 0.33000947820757187, 0.66999052179242813,
                                  0.93056815579702629};
    constexpr double kWeights[] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                   0.17392742256872693};
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
        const double z = z0 + (z1 - z0) * kPoints[i], s = std::sqrt(std::max(0.0, 1.0 - z * z));
        for (int j = 0; j < 4; ++j) {
            const double t = t0 + (t1 - t0) * kPoints[j];
            sum += kWeights[i] * kWeights[j] * f(Vec3{s * std::cos(t), s * std::sin(t), z});
        }
    }
    return sum * (z1 - z0) * (t1 - t0);
}

template <class F>
double integrate_rectangle(const F& f, double z0, double z1, double t0, double t1, double whole,
                           int depth) {
    const double z = 0.5 * (z0 + z1), t = 0.5 * (t0 + t1);
    const double a = rectangle_sum(f, z0, z, t0, t), b = rectangle_sum(f, z0, z, t, t1);
    const double c = rectangle_sum(f, z, z1, t0, t), d = rectangle_sum(f, z, z1, t, t1);
    if (depth == 0 || std::abs(a + b + c + d - whole) < 1e-5) return a + b + c + d;
    return integrate_rectangle(f, z0, z, t0, t, a, depth - 1) +
           integrate_rectangle(f, z0, z, t, t1, b, depth - 1) +
           integrate_rectangle(f, z, z1, t0, t, c, depth - 1) +
           integrate_rectangle(f, z, z1, t, t1, d, depth - 1);
}

}  // namespace detail

/// Integrals of a function of directions over the cells, adaptively; error about 1e-5 each.
template <class F>
std::vector<double> integrate_cells(const F& f) {
    std::vector<double> result;
    for (int i = 0; i < SphereCells::kHeights; ++i) {
        for (int j = 0; j < SphereCells::kTurns; ++j) {
            const double z0 = 2.0 * i / SphereCells::kHeights - 1.0;
            const double z1 = 2.0 * (i + 1) / SphereCells::kHeights - 1.0;
            const double t0 = 2.0 * kPi * j / SphereCells::kTurns;
            const double t1 = 2.0 * kPi * (j + 1) / SphereCells::kTurns;
            const double whole = detail::rectangle_sum(f, z0, z1, t0, t1);
            result.push_back(detail::integrate_rectangle(f, z0, z1, t0, t1, whole, 6));
        }
    }
    return result;
}

/// Probability of counts that deviate at least as much as these from `shares` * `samples`. Cells
/// with fewer than five expected samples are pooled; 1 minus the sum of the shares is one more
/// cell.
inline double chi_square_probability(const std::vector<double>& shares,
                                     const std::vector<std::size_t>& counts, std::size_t samples) {
    const double n = static_cast<double>(samples);
    double statistic = 0, pooled_expected = n, pooled_count = n;
    int degrees = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double expected = shares[i] * n, count = static_cast<double>(counts[i]);
        if (expected < 5.0) continue;
        statistic += (count - expected) * (count - expected) / expected;
        pooled_expected -= expected;
        pooled_count -= count;
        ++degrees;
    }
    if (pooled_expected >= 5.0) {
        const double difference = pooled_count - pooled_expected;
        return chi_square_tail(statistic + difference * difference / pooled_expected, degrees);
    }
    // A pool with far more samples than expected fails the test.
    if (pooled_count > pooled_expected + 30.0) return 0.0;
    return degrees > 1 ? chi_square_tail(statistic, degrees - 1) : 1.0;
}

}  // namespace alhazen::testing
