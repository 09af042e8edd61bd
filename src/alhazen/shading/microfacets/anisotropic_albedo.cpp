#include "alhazen/shading/microfacets/anisotropic_albedo.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/microfacets/cubic_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/visible_normals.h"

namespace alhazen {

namespace {

constexpr std::size_t kAlphaDegrees = 7, kMeanSteps = 33;
constexpr std::size_t kHeights = AnisotropicAlbedo::kHeights, kTurns = AnisotropicAlbedo::kTurns;
constexpr std::size_t kViewDegrees = kHeights * kTurns;

Ggx clamped(const Ggx& ggx) {
    return {std::clamp(ggx.x, kSmoothAlpha, 1.0), std::clamp(ggx.y, kSmoothAlpha, 1.0)};
}
bool same(const Ggx& a, const Ggx& b) {
    return a.x == b.x && a.y == b.y;
}
/// The axes of the table, -1..1 each.
///
/// Of alpha: denser towards 0.
double place_of_alpha(double alpha) {
    return std::sqrt(1.0 + 8.0 * alpha) - 2.0;
}
double alpha_of(double place) {
    const double y = 0.5 * (place + 1.0);
    return std::clamp(0.5 * y * (1.0 + y), kSmoothAlpha, 1.0);
}
/// Of the height z of the stretched view: denser towards both ends. The albedo has a term in
/// z log(z), and for small alphas it bends within the distance alpha from the normal.
double place_of_height(double z) {
    return std::acos(1.0 - 2.0 * std::clamp(z, 0.0, 1.0)) * (2.0 / kPi) - 1.0;
}
double height_of(double place) {
    return 0.5 * (1.0 - std::cos(0.5 * kPi * (place + 1.0)));
}

/// Chebyshev's polynomials of degrees below N.
template <std::size_t N>
std::array<double, N> polynomials(double x) {
    std::array<double, N> t{1.0, x};
    for (std::size_t k = 2; k < N; ++k) t[k] = 2.0 * x * t[k - 1] - t[k - 2];
    return t;
}
/// Zeros of the N-th polynomial.
template <std::size_t N>
double chebyshev_point(std::size_t k) {
    return std::cos(kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(N));
}
/// Replaces values at the zeros of the N-th polynomial, `stride` apart, by coefficients.
template <std::size_t N>
void transform(std::vector<double>& values, std::size_t stride) {
    std::array<std::array<double, N>, N> basis;
    for (std::size_t k = 0; k < N; ++k) basis[k] = polynomials<N>(chebyshev_point<N>(k));
    for (std::size_t first = 0; first < values.size(); ++first) {
        if (first / stride % N != 0) continue;
        std::array<double, N> sums{};
        for (std::size_t k = 0; k < N; ++k) {
            for (std::size_t j = 0; j < N; ++j) {
                sums[j] += (j == 0 ? 1.0 : 2.0) / N * basis[k][j] * values[first + k * stride];
            }
        }
        for (std::size_t j = 0; j < N; ++j) values[first + j * stride] = sums[j];
    }
}

/// Share of the light lost by a view whose stretched direction is `s`.
double lost_share(const Vec3& s, const Ggx& ggx) {
    return 1.0 - over_visible_normals(s, ggx, [](double, double) { return 1.0; });
}

/// Coefficients of the lost shares, by the alphas, the turn and the height.
std::vector<double> make_losses() {
    std::vector<double> losses(kAlphaDegrees * kAlphaDegrees * kViewDegrees);
    for (std::size_t a = 0; a < kAlphaDegrees; ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
            const Ggx ggx{alpha_of(chebyshev_point<kAlphaDegrees>(a)),
                          alpha_of(chebyshev_point<kAlphaDegrees>(b))};
            for (std::size_t i = 0; i < kViewDegrees; ++i) {
                const std::size_t turn = i / kHeights, height = i % kHeights;
                const double z = height_of(chebyshev_point<kHeights>(height));
                const double c = chebyshev_point<kTurns>(turn), r = 0.5 * (1.0 - z * z);
                const double lost =
                    lost_share({std::sqrt(r * (1.0 + c)), std::sqrt(r * (1.0 - c)), z}, ggx);
                losses[(a * kAlphaDegrees + b) * kViewDegrees + i] = lost;
                // The same with the two axes exchanged.
                losses[(b * kAlphaDegrees + a) * kViewDegrees + (kTurns - 1 - turn) * kHeights +
                       height] = lost;
            }
        }
    }
    transform<kHeights>(losses, 1);
    transform<kTurns>(losses, kHeights);
    transform<kAlphaDegrees>(losses, kViewDegrees);
    transform<kAlphaDegrees>(losses, kAlphaDegrees * kViewDegrees);
    return losses;
}

const std::vector<double>& losses() {
    static const std::vector<double> made = make_losses();
    return made;
}

/// Integrated from the polynomials, so that their errors cancel where both are used.
double integrate_mean(const AnisotropicAlbedo& albedo) {
    static const GaussLegendre<20> cosines;
    static const GaussLegendre<12> turns;
    double sum = 0;
    for (std::size_t i = 0; i < cosines.points.size(); ++i) {
        const double t = cosines.points[i], mu = t * t * t;
        const double sine = std::sqrt(1.0 - mu * mu);
        for (std::size_t j = 0; j < turns.points.size(); ++j) {
            const double turn = 0.5 * kPi * turns.points[j];
            sum += cosines.weights[i] * turns.weights[j] * 6.0 * mu * t * t *
                   albedo.at({sine * std::cos(turn), sine * std::sin(turn), mu});
        }
    }
    return sum;
}

/// Means by the square roots of the alphas.
CubicTable<2> make_means() {
    std::vector<double> known;
    return CubicTable<2>({kMeanSteps, kMeanSteps}, [&](const std::array<double, 2>& p) {
        const std::size_t a = known.size() / kMeanSteps, b = known.size() % kMeanSteps;
        const Ggx ggx{p[0] * p[0], p[1] * p[1]};
        known.push_back(b < a ? known[b * kMeanSteps + a] : integrate_mean(AnisotropicAlbedo(ggx)));
        return known.back();
    });
}

/// The polynomials of one pair of alphas, and recent results.
struct Recent {
    bool is_made = false;
    Ggx ggx;
    AnisotropicAlbedo albedo;
    double mean = -1;             ///< below 0: unknown
    std::uint32_t next = 0;       ///< the result to be replaced next
    std::array<Vec3, 2> views{};  ///< zero: none
    std::array<double, 2> answers{};
};

Recent& recent_of(const Ggx& ggx) {
    constexpr std::size_t kPairs = 64;
    // Made at first use: as a thread-local value it would be cleared for every thread.
    thread_local const auto pairs = std::make_unique<std::array<Recent, kPairs>>();
    const std::uint64_t x = std::bit_cast<std::uint64_t>(ggx.x);
    Recent& recent = (*pairs)[mix64(mix64(x) ^ std::bit_cast<std::uint64_t>(ggx.y)) % kPairs];
    if (!recent.is_made || !same(recent.ggx, ggx)) {
        recent = Recent{.is_made = true, .ggx = ggx, .albedo = AnisotropicAlbedo(ggx)};
    }
    return recent;
}

}  // namespace

AnisotropicAlbedo::AnisotropicAlbedo(const Ggx& ggx) : ggx_(clamped(ggx)) {
    const auto x = polynomials<kAlphaDegrees>(place_of_alpha(ggx_.x));
    const auto y = polynomials<kAlphaDegrees>(place_of_alpha(ggx_.y));
    const double* next = losses().data();
    for (const double a : x) {
        for (const double b : y) {
            for (double& coefficient : losses_) coefficient += a * b * *next++;
        }
    }
}

double AnisotropicAlbedo::at(const Vec3& view) const {
    const double x = ggx_.x * view.x, y = ggx_.y * view.y;
    const double xx = x * x, yy = y * y, r = xx + yy;
    const auto turns = polynomials<kTurns>(r > 0.0 ? (xx - yy) / r : 0.0);
    const auto heights =
        polynomials<kHeights>(place_of_height(view.z / std::sqrt(r + view.z * view.z)));
    double lost = 0;
    for (std::size_t i = 0; i < kTurns; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < kHeights; ++j) sum += heights[j] * losses_[i * kHeights + j];
        lost += turns[i] * sum;
    }
    return std::clamp(1.0 - lost, 0.0, 1.0);
}

double anisotropic_albedo(const Vec3& view, const Ggx& ggx) {
    Recent& recent = recent_of(ggx);
    for (std::size_t i = 0; i < recent.views.size(); ++i) {
        if (recent.views[i] == view) return recent.answers[i];
    }
    const double found = recent.albedo.at(view);
    recent.views[recent.next] = view;
    recent.answers[recent.next] = found;
    recent.next = 1 - recent.next;
    return found;
}

double mean_anisotropic_albedo(const Ggx& ggx) {
    const Ggx g = clamped(ggx);
    // There the losses are no larger than the errors of the polynomials, and not smooth.
    constexpr double kUneven = 0.02;
    if (std::max(g.x, g.y) < kUneven) {
        Recent& recent = recent_of(ggx);
        if (recent.mean < 0.0) recent.mean = integrate_mean(recent.albedo);
        return recent.mean;
    }
    static const CubicTable<2> means = make_means();
    return std::clamp(means.at({std::sqrt(g.x), std::sqrt(g.y)}), 0.0, 1.0);
}

double integrate_anisotropic_albedo(const Vec3& view, const Ggx& ggx) {
    const Ggx g = clamped(ggx);
    return 1.0 - lost_share(stretched(view, g), g);
}

}  // namespace alhazen
