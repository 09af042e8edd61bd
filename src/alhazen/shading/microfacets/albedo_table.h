#pragma once
/// Directional albedo of a lobe by the cosine of the view and the roughness, and its mean over the
/// hemisphere; the deficit to 1 can be restored by a matt lobe.
///
/// Source: Kelemen and Szirmay-Kalos, "A Microfacet Based Coupled Specular-Matte BRDF Model with
/// Importance Sampling", Eurographics 2001 (the matt lobe); Kulla and Conty, "Revisiting Physically
/// Based Shading at Imageworks", SIGGRAPH 2017 course (tables of the deficit).
/// Differs: the axis of the view is mu / (mu + alpha), which follows the shadowing at grazing
/// angles, so that a small table suffices.
/// Conventions: mu is the cosine of the view, 0..1; alpha the roughness, 0..1. Both are clamped.
/// Threads: const functions may be called concurrently. Each thread caches the values of the alphas
/// that it uses repeatedly.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "alhazen/shading/microfacets/cubic_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"

namespace alhazen {

/// The axes of a table of albedos: 0..1 each.
struct AlbedoAxes {
    static constexpr double kBend = 0.7, kLeastAlpha = 1e-6, kLeastMu = 1e-7;

    [[nodiscard]] static double x_of(double mu, double alpha) {
        return std::pow(mu * (1.0 + alpha) / (mu + alpha), kBend);
    }
    [[nodiscard]] static double mu_of(double x, double alpha) {
        const double y = std::pow(x, 1.0 / kBend);
        return std::clamp(alpha * y / (1.0 + alpha - y), kLeastMu, 1.0);
    }
    [[nodiscard]] static double y_of(double alpha) { return std::sqrt(alpha); }
    [[nodiscard]] static double alpha_of(double y) { return std::max(y * y, kLeastAlpha); }
};

class AlbedoTable {
  public:
    using Function = std::function<double(double mu, double alpha)>;

    /// `Shadow`: for functions smooth in mu / (mu + alpha); `Angle`: smooth in the square root of
    /// mu.
    enum class Axis { Shadow, Angle };
    static constexpr std::size_t kCosines = 44;

    explicit AlbedoTable(const Function& albedo, Axis axis = Axis::Shadow);

    [[nodiscard]] double at(double mu, double alpha) const;

    /// The table at one alpha.
    class Slice {
      public:
        Slice(const AlbedoTable& table, double alpha);
        /// The bits of AlbedoTable::at.
        [[nodiscard]] double at(double mu) const;

      private:
        Axis axis_;
        double alpha_;
        std::array<CubicTable<2>::Piece, kCosines - 1> pieces_;
    };
    /// Cosine-weighted mean over the hemisphere.
    [[nodiscard]] double mean(double alpha) const;

  private:
    [[nodiscard]] static double place_of(Axis axis, double mu, double alpha) {
        return axis == Axis::Shadow ? AlbedoAxes::x_of(mu, alpha) : std::sqrt(mu);
    }

    std::uint64_t id_;  ///< unique to the table
    Axis axis_;
    CubicTable<2> table_;
    CubicTable<1> mean_;
};

/// Cosine-weighted mean of f(mu) over the hemisphere, with nodes by the square root of mu.
template <class F>
[[nodiscard]] double hemispherical_mean(const F& f) {
    static const GaussLegendre<64> rule;
    double sum = 0;
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
        const double t = rule.points[i];
        sum += rule.weights[i] * 4.0 * t * t * t * f(t * t);
    }
    return sum;
}

/// A reciprocal matt lobe that restores the deficit: its albedo for a view is exactly
/// `missing(mu_view)`. `mean_missing`: the mean over the hemisphere. Excludes the cosine.
[[nodiscard]] double matt_rest(double missing_at_view, double missing_at_light,
                               double mean_missing);

}  // namespace alhazen
