#include "alhazen/shading/microfacets/ggx_albedo.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/shading/microfacets/albedo_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

/// Sum over the normals that a view sees along one meridian, u.x = `turn`. They are taken by q =
/// cbrt(1 - u.y), which is finer where facets are steep, piece by piece between the q at which the
/// reflected ray changes sides.
class Meridian {
  public:
    Meridian(const Ggx& ggx, const Vec3& view, double turn) : ggx_(ggx), v_(view), turn_(turn) {}

    [[nodiscard]] SplitAlbedo integral() const {
        constexpr int kSteps = 16;
        SplitAlbedo sum{0, 0};
        double upper = 1, last = 1;
        bool above = height(1) > 0.0;
        for (int k = 1; k <= kSteps; ++k) {
            const double q = k == kSteps ? 1e-9 : 1.0 - static_cast<double>(k) / kSteps;
            if ((height(q) > 0.0) != above) {
                const double change = crossing(last, q, above);
                if (above) add(change, upper, sum);
                upper = change;
                above = !above;
            }
            last = q;
        }
        if (above) add(0.0, upper, sum);
        return sum;
    }

  private:
    [[nodiscard]] Vec3 normal(double q) const {
        return ggx_.sample_visible(v_, {turn_, 1.0 - q * q * q});
    }
    [[nodiscard]] double height(double q) const { return mirrored(v_, normal(q)).z; }
    [[nodiscard]] double crossing(double from, double to, bool above_at_from) const {
        for (int step = 0; step < 16; ++step) {
            const double middle = 0.5 * (from + to);
            ((height(middle) > 0.0) == above_at_from ? from : to) = middle;
        }
        return 0.5 * (from + to);
    }
    void add(double a, double b, SplitAlbedo& sum) const {
        static const GaussLegendre<12> rule;
        for (std::size_t i = 0; i < rule.points.size(); ++i) {
            const double q = a + (b - a) * rule.points[i];
            const Vec3 m = normal(q), l = mirrored(v_, m);
            if (!(l.z > 0.0)) continue;
            const double share = 3.0 * q * q * (b - a) * rule.weights[i] * ggx_.shadowing(v_, l);
            const double grazing = schlick_weight(dot(v_, m));
            sum.at_f0 += share * (1.0 - grazing);
            sum.at_f90 += share * grazing;
        }
    }

    Ggx ggx_;
    Vec3 v_;
    double turn_;
};

struct GgxTables {
    std::vector<double> second;  ///< of the first table's integrals, for the second
    std::size_t next = 0;
    AlbedoTable at_f0{[this](double mu, double alpha) {
        const SplitAlbedo a = integrate_ggx_albedo(mu, alpha);
        second.push_back(a.at_f90);
        return a.at_f0;
    }};
    AlbedoTable at_f90{[this](double, double) { return second[next++]; }};
};

const GgxTables& ggx_tables() {
    static const GgxTables made;
    return made;
}

}  // namespace

SplitAlbedo integrate_ggx_albedo(double mu, double alpha) {
    static const GaussLegendre<24> rule;
    const double sine = std::sqrt(std::max(0.0, 1.0 - mu * mu));
    SplitAlbedo sum{0, 0};
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
        // Both halves are alike; finer towards the facets that lean away from the view.
        const double t = rule.points[i];
        const SplitAlbedo part =
            Meridian({alpha, alpha}, {sine, 0, mu}, 0.5 * (1.0 - t * t * t)).integral();
        sum.at_f0 += 3.0 * t * t * rule.weights[i] * part.at_f0;
        sum.at_f90 += 3.0 * t * t * rule.weights[i] * part.at_f90;
    }
    return sum;
}

SplitAlbedo ggx_albedo(double mu, double alpha) {
    const GgxTables& t = ggx_tables();
    return {t.at_f0.at(mu, alpha), t.at_f90.at(mu, alpha)};
}

SplitAlbedo ggx_mean_albedo(double alpha) {
    const GgxTables& t = ggx_tables();
    return {t.at_f0.mean(alpha), t.at_f90.mean(alpha)};
}

}  // namespace alhazen
