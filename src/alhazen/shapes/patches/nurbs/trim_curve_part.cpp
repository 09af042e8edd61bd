#include "alhazen/shapes/patches/nurbs/trim_curve_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace alhazen {

namespace {

/// Inserts a knot once (Boehm). Points are homogeneous (u w, v w, w).
void insert_trim_knot(std::size_t degree, std::vector<double>& knots, std::vector<Vec3>& points,
                      double u) {
    std::size_t span = degree;
    while (span + 1 < points.size() && knots[span + 1] <= u) ++span;
    std::vector<Vec3> out(points.begin(), points.begin() + std::ptrdiff_t(span - degree + 1));
    for (std::size_t i = span - degree + 1; i <= span; ++i) {
        const double width = knots[i + degree] - knots[i];
        const double a = width > 0.0 ? (u - knots[i]) / width : 0.0;
        out.push_back((1.0 - a) * points[i - 1] + a * points[i]);
    }
    out.insert(out.end(), points.begin() + std::ptrdiff_t(span), points.end());
    points = std::move(out);
    knots.insert(knots.begin() + std::ptrdiff_t(span + 1), u);
}

}  // namespace

TrimCurve trim_curve_part(TrimCurve curve, double from, double to) {
    const std::size_t degree = curve.degree;
    const double lo = std::fmin(from, to), hi = std::fmax(from, to);
    if (lo > curve.knots[degree] || hi < curve.knots[curve.points.size()]) {
        std::vector<Vec3> points;
        for (std::size_t k = 0; k < curve.points.size(); ++k) {
            const double w = curve.weights.empty() ? 1.0 : curve.weights[k];
            points.push_back({w * curve.points[k].x, w * curve.points[k].y, w});
        }
        for (const double end : {lo, hi}) {
            auto known = std::size_t(std::count(curve.knots.begin(), curve.knots.end(), end));
            for (; known < degree; ++known) insert_trim_knot(degree, curve.knots, points, end);
        }
        // Copies from the last knot at `lo` to the first at `hi`, with degree + 1 knots at each.
        const auto last = std::size_t(std::upper_bound(curve.knots.begin(), curve.knots.end(), lo) -
                                      curve.knots.begin() - 1);
        const auto first = std::size_t(
            std::lower_bound(curve.knots.begin(), curve.knots.end(), hi) - curve.knots.begin());
        std::vector<double> knots(degree + 1, lo);
        for (std::size_t k = last + 1; k < first; ++k) knots.push_back(curve.knots[k]);
        knots.insert(knots.end(), degree + 1, hi);
        const std::size_t begin = last - degree;
        const bool rational = !curve.weights.empty();
        curve.points.clear();
        curve.weights.clear();
        for (std::size_t k = begin; k < begin + knots.size() - degree - 1; ++k) {
            curve.points.push_back({points[k].x / points[k].z, points[k].y / points[k].z});
            if (rational) curve.weights.push_back(points[k].z);
        }
        curve.knots = std::move(knots);
    }
    if (from > to) {
        std::reverse(curve.points.begin(), curve.points.end());
        std::reverse(curve.weights.begin(), curve.weights.end());
        std::reverse(curve.knots.begin(), curve.knots.end());
        for (double& knot : curve.knots) knot = lo + hi - knot;
    }
    return curve;
}

}  // namespace alhazen
