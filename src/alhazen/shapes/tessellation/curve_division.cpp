#include "alhazen/shapes/tessellation/curve_division.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "alhazen/shapes/tessellation/derivative_bounds.h"

namespace alhazen {

namespace {

constexpr int kMaxHalvings = 20;

using CurveRow = std::array<HomogeneousPoint, kMaxPatchOrder>;

struct CurveDivider {
    int degree;
    double tolerance;
    std::vector<CurveDivisionPoint>& points;

    /// True if the chord, at the same parameter, is within the tolerance of the curve. Straight
    /// curves of uneven speed are divided as well, because adjacent triangles follow the parameter.
    [[nodiscard]] bool is_flat(const CurveRow& row) const {
        BezierNet ribbon;
        ribbon.degree_u = degree;
        ribbon.degree_v = 1;
        for (int i = 0; i <= degree; ++i) {
            ribbon.at(i, 0) = ribbon.at(i, 1) = row[static_cast<std::size_t>(i)];
        }
        return second_derivative_bounds(ribbon).uu <= 8.0 * tolerance;
    }

    /// Appends the points of the part after its first one.
    void divide(const CurveRow& row, double from, double to, int depth) {
        if (depth == kMaxHalvings || is_flat(row)) {
            points.push_back({to, projected(row[static_cast<std::size_t>(degree)])});
            return;
        }
        CurveRow work = row, left, right;
        for (int level = 0; level <= degree; ++level) {
            const auto last = static_cast<std::size_t>(degree - level);
            left[static_cast<std::size_t>(level)] = work[0];
            right[last] = work[last];
            for (std::size_t k = 0; k < last; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
        }
        const double middle = 0.5 * (from + to);
        divide(left, from, middle, depth + 1);
        divide(right, middle, to, depth + 1);
    }
};

/// True if the curve read from its end compares greater or equal.
bool is_canonical(std::span<const HomogeneousPoint> curve) {
    for (std::size_t k = 0; k < curve.size(); ++k) {
        const HomogeneousPoint& a = curve[k];
        const HomogeneousPoint& b = curve[curve.size() - 1 - k];
        const auto x = std::tie(a.x, a.y, a.z, a.w);
        const auto y = std::tie(b.x, b.y, b.z, b.w);
        if (x != y) return x < y;
    }
    return true;
}

}  // namespace

std::vector<CurveDivisionPoint> divided_curve(std::span<const HomogeneousPoint> curve,
                                              double tolerance) {
    CurveRow row;
    const bool canonical = is_canonical(curve);
    for (std::size_t k = 0; k < curve.size(); ++k) {
        row[k] = curve[canonical ? k : curve.size() - 1 - k];
    }
    std::vector<CurveDivisionPoint> points{{0.0, projected(row[0])}};
    CurveDivider{static_cast<int>(curve.size()) - 1, tolerance, points}.divide(row, 0.0, 1.0, 0);
    if (!canonical) {
        std::reverse(points.begin(), points.end());
        for (CurveDivisionPoint& point : points) point.parameter = 1.0 - point.parameter;
    }
    return points;
}

}  // namespace alhazen
