#include "alhazen/shading/microfacets/ggx_albedo.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/microfacets/ggx.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/shading/microfacets/meridian.h"
#include "alhazen/shading/optics/fresnel.h"

namespace alhazen {

namespace {

struct GgxTables {
    AlbedoTable sum{[](double mu, double alpha) { return integrate_ggx_albedo(mu, alpha).sum(); }};
    /// The part of the sum that is multiplied by f90.
    AlbedoTable grazing{[](double mu, double alpha) {
                            const SplitAlbedo a = integrate_ggx_albedo(mu, alpha);
                            return a.at_f90 / a.sum();
                        },
                        AlbedoTable::Axis::Angle};
    CubicTable<1> mean_f90{{129}, [this](const std::array<double, 1>& p) {
                               const double alpha = AlbedoAxes::alpha_of(p[0]);
                               return hemispherical_mean([&](double mu) {
                                   return sum.at(mu, alpha) * grazing.at(mu, alpha);
                               });
                           }};
};

const GgxTables& ggx_tables() {
    static const GgxTables made;
    return made;
}

}  // namespace

SplitAlbedo integrate_ggx_albedo(double mu, double alpha) {
    const Ggx ggx{alpha, alpha};
    const Vec3 v{std::sqrt(std::max(0.0, 1.0 - mu * mu)), 0, mu};
    SplitAlbedo sum{0, 0};
    for_visible_normals(
        ggx, v, [&](const Vec3& m) { return mirrored(v, m).z > 0.0 ? 1 : 0; },
        [&](const Vec3& m, double weight) {
            const Vec3 l = mirrored(v, m);
            if (!(l.z > 0.0)) return;
            const double share = weight * ggx.shadowing(v, l);
            const double grazing = schlick_weight(dot(v, m));
            sum.at_f0 += share * (1.0 - grazing);
            sum.at_f90 += share * grazing;
        });
    return sum;
}

SplitAlbedo ggx_albedo(double mu, double alpha) {
    const GgxTables& t = ggx_tables();
    const double sum = t.sum.at(mu, alpha), grazing = t.grazing.at(mu, alpha);
    return {sum * (1.0 - grazing), sum * grazing};
}

double ggx_albedo_sum(double mu, double alpha) {
    return ggx_tables().sum.at(mu, alpha);
}

AlbedoTable::Slice ggx_albedo_sums(double alpha) {
    return {ggx_tables().sum, alpha};
}

SplitAlbedo ggx_mean_albedo(double alpha) {
    const GgxTables& t = ggx_tables();
    const double f90 =
        t.mean_f90.at({AlbedoAxes::y_of(std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0))});
    return {t.sum.mean(alpha) - f90, f90};
}

}  // namespace alhazen
