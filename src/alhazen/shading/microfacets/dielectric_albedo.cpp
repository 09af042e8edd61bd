#include "alhazen/shading/microfacets/dielectric_albedo.h"

#include <vector>

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/microfacets/meridian.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

constexpr double kLargestRatio = 3.0;

/// Tables for one direction: into the denser medium (eta <= 1), or out of it. The third axis is the
/// square root of log(ratio): the loss changes fast for media of similar index.
class OneWay {
  public:
    explicit OneWay(bool inward) : inward_(inward) {
        const int kX = inward ? 24 : 40;
        constexpr int kY = 15, kZ = 10, kMeansOfAxis = 33;
        std::vector<double> sums;
        reflected_ = CubicTable<3>({kZ, kY, kX}, [&](const std::array<double, 3>& p) {
            const double alpha = AlbedoAxes::alpha_of(p[1]);
            const DielectricAlbedo a =
                integrate_dielectric_albedo(mu_of(p[2], alpha), alpha, eta_of(p[0]));
            sums.push_back(a.sum);
            return a.reflected;
        });
        std::size_t next = 0;
        sum_ = CubicTable<3>({kZ, kY, kX}, [&](const auto&) { return sums[next++]; });
        mean_ = CubicTable<2>({kMeansOfAxis, kMeansOfAxis}, [&](const std::array<double, 2>& p) {
            const double alpha = AlbedoAxes::alpha_of(p[1]), eta = eta_of(p[0]);
            return hemispherical_mean([&](double mu) { return at(mu, alpha, eta).sum; });
        });
    }

    [[nodiscard]] DielectricAlbedo at(double mu, double alpha, double eta) const {
        const std::array<double, 3> p{z_of(eta), AlbedoAxes::y_of(alpha), x_of(mu, alpha)};
        const double sum = std::clamp(sum_.at(p), 0.0, 1.0);
        return {std::clamp(reflected_.at(p), 0.0, sum), sum};
    }
    [[nodiscard]] double mean(double alpha, double eta) const {
        return std::clamp(mean_.at({z_of(eta), AlbedoAxes::y_of(alpha)}), 0.0, 1.0);
    }

  private:
    // Outward, the function varies most at the critical angle: an axis of angles.
    [[nodiscard]] double x_of(double mu, double alpha) const {
        return inward_ ? AlbedoAxes::x_of(mu, alpha) : std::sqrt(mu);
    }
    [[nodiscard]] double mu_of(double x, double alpha) const {
        return inward_ ? AlbedoAxes::mu_of(x, alpha) : std::max(x * x, AlbedoAxes::kLeastMu);
    }
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
    const Ggx ggx{alpha, alpha};
    const Vec3 v{std::sqrt(std::max(0.0, 1.0 - mu * mu)), 0, mu};
    DielectricAlbedo result{0, 0};
    const auto state = [&](const Vec3& m) {
        double behind = 0;
        const bool passes = dielectric_reflectance(dot(v, m), eta, behind) < 1.0;
        const bool up = mirrored(v, m).z > 0.0;
        return (up ? 1 : 0) + (passes ? refracted(v, m, behind, eta).z < 0.0 ? 2 : 4 : 0);
    };
    for_visible_normals(ggx, v, state, [&](const Vec3& m, double weight) {
        double behind = 0;
        const double r = dielectric_reflectance(dot(v, m), eta, behind);
        if (const Vec3 l = mirrored(v, m); l.z > 0.0) {
            result.reflected += weight * r * ggx.shadowing(v, l);
        }
        if (const Vec3 l = refracted(v, m, behind, eta); r < 1.0 && l.z < 0.0) {
            result.sum += weight * (1.0 - r) * ggx.masking(l);
        }
    });
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
