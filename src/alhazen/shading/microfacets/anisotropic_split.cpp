#include "alhazen/shading/microfacets/anisotropic_split.h"

#include <algorithm>
#include <cmath>

#include "alhazen/shading/microfacets/anisotropic_albedo.h"
#include "alhazen/shading/microfacets/cubic_table.h"
#include "alhazen/shading/microfacets/gauss_legendre.h"
#include "alhazen/shading/microfacets/visible_normals.h"

namespace alhazen {

namespace {

/// The axes of the table, 0..1 each.
struct SplitAxes {
    static constexpr int kAlphas = 15, kViews = 22;
    static constexpr double kLeast = 1e-6;  ///< of the lengths of a Place

    /// Even steps of the fourth root.
    static double place_of(double alpha) {
        const double first = fourth_root(kSmoothAlpha);
        return (fourth_root(alpha) - first) / (1.0 - first);
    }
    static double alpha_of(double place) {
        const double first = fourth_root(kSmoothAlpha), root = first + place * (1.0 - first);
        return std::clamp(root * root * root * root, kSmoothAlpha, 1.0);
    }
    static double fourth_root(double x) { return std::sqrt(std::sqrt(x)); }

    /// The square roots of a view's length across the y axis, and of its cosine to the normal when
    /// seen along that axis.
    struct Place {
        double across = 1, cosine = 1;
    };
    static Place place_of(const Vec3& view) {
        const double across = std::sqrt(view.x * view.x + view.z * view.z);
        return {std::sqrt(across), std::sqrt(view.z / across)};
    }
    static Vec3 view_of(const Place& place) {
        const double across = std::max(place.across * place.across, kLeast);
        const double cosine = std::max(place.cosine * place.cosine, kLeast);
        return {across * std::sqrt(1.0 - cosine * cosine), std::sqrt(1.0 - across * across),
                across * cosine};
    }
};

double integrate_f90(const Vec3& view, const Ggx& ggx) {
    return over_visible_normals(stretched(view, ggx), ggx, [&](double c, double l) {
        const double miss = std::max(0.0, 1.0 - view.z * c / std::sqrt(l));
        const double square = miss * miss;
        return square * square * miss;
    });
}

struct SplitTables : SplitAxes {
    CubicTable<4> albedos;  ///< by the larger alpha, the smaller one and the Place
    CubicTable<2> means;

    SplitTables() {
        const auto is_read = [](double a, double b) {
            // Cubics of alphas a >= b reach no further.
            return std::lround((b - a) * (kAlphas - 1)) <= 3;
        };
        albedos = CubicTable<4>({kAlphas, kAlphas, kViews, kViews}, [&](const auto& p) {
            if (!is_read(p[0], p[1])) return 0.0;
            return integrate_f90(view_of({p[2], p[3]}), {alpha_of(p[0]), alpha_of(p[1])});
        });
        means = CubicTable<2>({kAlphas, kAlphas}, [&](const auto& p) {
            return is_read(p[0], p[1]) ? mean(p[0], p[1]) : 0.0;
        });
    }

    [[nodiscard]] double at(double a, double b, const Vec3& view) const {
        const Place place = place_of(view);
        return albedos.at({a, b, place.across, place.cosine});
    }
    /// Over the hemisphere, by the square root of the cosine and by the azimuth.
    [[nodiscard]] double mean(double a, double b) const {
        static const GaussLegendre<20> cosines;
        static const GaussLegendre<12> turns;
        double sum = 0;
        for (std::size_t i = 0; i < cosines.points.size(); ++i) {
            const double t = cosines.points[i], mu = t * t, sine = std::sqrt(1.0 - mu * mu);
            for (std::size_t j = 0; j < turns.points.size(); ++j) {
                const double turn = 0.5 * kPi * turns.points[j];
                sum += cosines.weights[i] * turns.weights[j] * 4.0 * mu * t *
                       at(a, b, {sine * std::cos(turn), sine * std::sin(turn), mu});
            }
        }
        return sum;
    }
};

const SplitTables& split_tables() {
    static const SplitTables made;
    return made;
}

/// With the larger alpha first; along the axes of a view the same way.
Ggx sorted(const Ggx& ggx) {
    const double x = std::clamp(ggx.x, kSmoothAlpha, 1.0);
    const double y = std::clamp(ggx.y, kSmoothAlpha, 1.0);
    return {std::max(x, y), std::min(x, y)};
}
Vec3 sorted(const Vec3& view, const Ggx& ggx) {
    const Vec3 v = ggx.x < ggx.y ? Vec3{view.y, view.x, view.z} : view;
    return {std::abs(v.x), std::abs(v.y), std::max(v.z, SplitAxes::kLeast)};
}

SplitAlbedo split(double sum, double at_f90) {
    const double f90 = std::clamp(at_f90, 0.0, sum);
    return {sum - f90, f90};
}

}  // namespace

SplitAlbedo anisotropic_split_albedo(const Vec3& view, const Ggx& ggx) {
    const Ggx g = sorted(ggx);
    return split(
        anisotropic_albedo(view, ggx),
        split_tables().at(SplitAxes::place_of(g.x), SplitAxes::place_of(g.y), sorted(view, ggx)));
}

SplitAlbedo mean_anisotropic_split_albedo(const Ggx& ggx) {
    const Ggx g = sorted(ggx);
    return split(mean_anisotropic_albedo(ggx),
                 split_tables().means.at({SplitAxes::place_of(g.x), SplitAxes::place_of(g.y)}));
}

SplitAlbedo integrate_anisotropic_split_albedo(const Vec3& view, const Ggx& ggx) {
    return split(integrate_anisotropic_albedo(view, ggx),
                 integrate_f90(sorted(view, ggx), sorted(ggx)));
}

}  // namespace alhazen
