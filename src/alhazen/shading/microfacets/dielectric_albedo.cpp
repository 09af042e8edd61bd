#include "alhazen/shading/microfacets/dielectric_albedo.h"

#include <vector>

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

constexpr double kLargestRatio = 3.0;

/// Tables of one way through: into the denser medium (eta <= 1), or out of it. The third axis is
/// the root of log(ratio): where media differ little the loss changes fast.
class OneWay {
  public:
    explicit OneWay(bool inward) : inward_(inward) {
        constexpr int kX = 16, kY = 14, kZ = 9, kMeans = 33;
        std::vector<double> sums;
        reflected_ = CubicTable<3>({kZ, kY, kX}, [&](const std::array<double, 3>& p) {
            const double alpha = AlbedoAxes::alpha_of(p[1]);
            const DielectricAlbedo a =
                integrate_dielectric_albedo(AlbedoAxes::mu_of(p[2], alpha), alpha, eta_of(p[0]));
            sums.push_back(a.sum);
            return a.reflected;
        });
        std::size_t next = 0;
        sum_ = CubicTable<3>({kZ, kY, kX}, [&](const auto&) { return sums[next++]; });
        const GaussLegendre<48> rule;
        mean_ = CubicTable<2>({kMeans, kMeans}, [&](const std::array<double, 2>& p) {
            const double alpha = AlbedoAxes::alpha_of(p[1]), eta = eta_of(p[0]);
            double sum = 0;
            for (std::size_t i = 0; i < rule.points.size(); ++i) {
                const double t = rule.points[i];
                sum += rule.weights[i] * 4.0 * t * t * t * at(t * t, alpha, eta).sum;
            }
            return sum;
        });
    }

    [[nodiscard]] DielectricAlbedo at(double mu, double alpha, double eta) const {
        const std::array<double, 3> p{z_of(eta), AlbedoAxes::y_of(alpha),
                                      AlbedoAxes::x_of(mu, alpha)};
        const double sum = std::clamp(sum_.at(p), 0.0, 1.0);
        return {std::clamp(reflected_.at(p), 0.0, sum), sum};
    }
    [[nodiscard]] double mean(double alpha, double eta) const {
        return std::clamp(mean_.at({z_of(eta), AlbedoAxes::y_of(alpha)}), 0.0, 1.0);
    }

  private:
    [[nodiscard]] static double z_of(double eta) {
        return std::sqrt(std::abs(std::log(eta)) / std::log(kLargestRatio));
    }
    [[nodiscard]] double eta_of(double z) const {
        const double ratio = std::exp(z * z * std::log(kLargestRatio));
        return inward_ ? 1.0 / ratio : ratio;
    }

    bool inward_;
    CubicTable<3> reflected_, sum_;
    CubicTable<2> mean_;
};

const OneWay& way_of(double eta) {
    static const OneWay inward(true), outward(false);
    return eta <= 1.0 ? inward : outward;
}

double clamped_ratio(double eta) {
    return std::clamp(eta, 1.0 / kLargestRatio, kLargestRatio);
}

}  // namespace

DielectricAlbedo integrate_dielectric_albedo(double mu, double alpha, double eta) {
    static const GaussLegendre<20> turns;
    static const GaussLegendre<28> radii;
    const Ggx ggx{alpha, alpha};
    const Vec3 v{std::sqrt(std::max(0.0, 1.0 - mu * mu)), 0, mu};
    DielectricAlbedo result{0, 0};
    for (std::size_t i = 0; i < turns.points.size(); ++i) {
        const double t = turns.points[i];
        for (std::size_t j = 0; j < radii.points.size(); ++j) {
            // Finer where facets are steep and lean away from the view.
            const double q = radii.points[j];
            const Vec3 m = ggx.sample_visible(v, {0.5 * (1.0 - t * t * t), 1.0 - q * q * q});
            const double weight = 9.0 * t * t * q * q * turns.weights[i] * radii.weights[j];
            double behind = 0;
            const double r = dielectric_reflectance(dot(v, m), eta, behind);
            if (const Vec3 l = mirrored(v, m); l.z > 0.0) {
                result.reflected += weight * r * ggx.shadowing(v, l);
            }
            if (const Vec3 l = refracted(v, m, behind, eta); r < 1.0 && l.z < 0.0) {
                result.sum += weight * (1.0 - r) * ggx.masking(l);
            }
        }
    }
    result.sum += result.reflected;
    return result;
}

DielectricAlbedo dielectric_albedo(double mu, double alpha, double eta) {
    const double e = clamped_ratio(eta);
    return way_of(e).at(std::clamp(mu, AlbedoAxes::kLeastMu, 1.0),
                        std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0), e);
}

double mean_dielectric_albedo(double alpha, double eta) {
    const double e = clamped_ratio(eta);
    return way_of(e).mean(std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0), e);
}

}  // namespace alhazen
