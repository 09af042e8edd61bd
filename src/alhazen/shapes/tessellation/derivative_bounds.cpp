#include "alhazen/shapes/tessellation/derivative_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alhazen {

namespace {

Vec3 numerator_about(const HomogeneousPoint& p, const Vec3& center) {
    return Vec3{p.x, p.y, p.z} - p.w * center;
}

/// Largest |first or second difference| of positions about a centre, and of weights.
struct NetDifferences {
    double point = 0, weight = 0;

    void include(const HomogeneousPoint& d, const Vec3& center, double factor) {
        point = std::max(point, factor * length(numerator_about(d, center)));
        weight = std::max(weight, factor * std::abs(d.w));
    }
};

}  // namespace

PatchDerivativeBounds second_derivative_bounds(const BezierNet& net) {
    const Box3 box = control_box(net);
    const Vec3 center = box.center();
    const double reach = 0.5 * length(box.size());
    double least_weight = std::numeric_limits<double>::infinity();
    NetDifferences u, v, uu, uv, vv;
    const int m = net.degree_u, n = net.degree_v;
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
            const HomogeneousPoint& p = net.at(i, j);
            least_weight = std::min(least_weight, p.w);
            if (i < m) u.include(net.at(i + 1, j) - p, center, m);
            if (j < n) v.include(net.at(i, j + 1) - p, center, n);
            if (i + 1 < m) {
                uu.include(net.at(i + 2, j) - 2.0 * net.at(i + 1, j) + p, center, m * (m - 1.0));
            }
            if (j + 1 < n) {
                vv.include(net.at(i, j + 2) - 2.0 * net.at(i, j + 1) + p, center, n * (n - 1.0));
            }
            if (i < m && j < n) {
                uv.include(net.at(i + 1, j + 1) - net.at(i + 1, j) - net.at(i, j + 1) + p, center,
                           static_cast<double>(m) * n);
            }
        }
    }
    // Quotient rule for numerator / weight about the centre.
    const double first_u = (u.point + u.weight * reach) / least_weight;
    const double first_v = (v.point + v.weight * reach) / least_weight;
    return {(uu.point + 2.0 * u.weight * first_u + uu.weight * reach) / least_weight,
            (uv.point + u.weight * first_v + v.weight * first_u + uv.weight * reach) / least_weight,
            (vv.point + 2.0 * v.weight * first_v + vv.weight * reach) / least_weight};
}

Vec2 first_derivative_bounds(const BezierNet& net) {
    const Box3 box = control_box(net);
    const Vec3 center = box.center();
    const double reach = 0.5 * length(box.size());
    double least_weight = std::numeric_limits<double>::infinity();
    NetDifferences u, v;
    const int m = net.degree_u, n = net.degree_v;
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) {
            const HomogeneousPoint& p = net.at(i, j);
            least_weight = std::min(least_weight, p.w);
            if (i < m) u.include(net.at(i + 1, j) - p, center, m);
            if (j < n) v.include(net.at(i, j + 1) - p, center, n);
        }
    }
    return {(u.point + u.weight * reach) / least_weight,
            (v.point + v.weight * reach) / least_weight};
}

}  // namespace alhazen
