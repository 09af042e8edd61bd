#include "alhazen/shading/microfacets/albedo_table.h"

#include "alhazen/math/constants.h"

namespace alhazen {

AlbedoTable::AlbedoTable(const Function& albedo, Axis axis) : axis_(axis) {
    constexpr int kX = 44, kY = 32, kMeans = 257;
    table_ = CubicTable<2>({kX, kY}, [&](const std::array<double, 2>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[1]);
        return albedo(axis == Axis::Shadow ? AlbedoAxes::mu_of(p[0], alpha)
                                           : std::max(p[0] * p[0], AlbedoAxes::kLeastMu),
                      alpha);
    });
    // Of the interpolated table, so that its errors cancel where both are used.
    mean_ = CubicTable<1>({kMeans}, [&](const std::array<double, 1>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[0]);
        return hemispherical_mean([&](double mu) { return at(mu, alpha); });
    });
}

double AlbedoTable::at(double mu, double alpha) const {
    const double a = std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0);
    const double m = std::clamp(mu, AlbedoAxes::kLeastMu, 1.0);
    const double x = axis_ == Axis::Shadow ? AlbedoAxes::x_of(m, a) : std::sqrt(m);
    return std::clamp(table_.at({x, AlbedoAxes::y_of(a)}), 0.0, 1.0);
}

double AlbedoTable::mean(double alpha) const {
    const double a = std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0);
    return std::clamp(mean_.at({AlbedoAxes::y_of(a)}), 0.0, 1.0);
}

double matt_rest(double missing_at_view, double missing_at_light, double mean_missing) {
    if (!(mean_missing > 0.0)) return 0.0;
    return missing_at_view * missing_at_light / (kPi * mean_missing);
}

}  // namespace alhazen
