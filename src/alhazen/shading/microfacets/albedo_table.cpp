#include "alhazen/shading/microfacets/albedo_table.h"

#include "alhazen/math/constants.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"

namespace alhazen {

AlbedoTable::AlbedoTable(const Function& albedo) {
    constexpr int kX = 32, kY = 28, kMeans = 257;
    table_ = CubicTable<2>({kX, kY}, [&](const std::array<double, 2>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[1]);
        return albedo(AlbedoAxes::mu_of(p[0], alpha), alpha);
    });
    // Of the interpolated table, so that its errors cancel where both are used. By the root of mu:
    // finer where the table is steep.
    const GaussLegendre<64> rule;
    mean_ = CubicTable<1>({kMeans}, [&](const std::array<double, 1>& p) {
        const double alpha = AlbedoAxes::alpha_of(p[0]);
        double sum = 0;
        for (std::size_t i = 0; i < rule.points.size(); ++i) {
            const double t = rule.points[i];
            sum += rule.weights[i] * 4.0 * t * t * t * at(t * t, alpha);
        }
        return sum;
    });
}

double AlbedoTable::at(double mu, double alpha) const {
    const double a = std::clamp(alpha, AlbedoAxes::kLeastAlpha, 1.0);
    const double m = std::clamp(mu, AlbedoAxes::kLeastMu, 1.0);
    return std::clamp(table_.at({AlbedoAxes::x_of(m, a), AlbedoAxes::y_of(a)}), 0.0, 1.0);
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
