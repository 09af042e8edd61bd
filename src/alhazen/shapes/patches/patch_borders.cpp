#include "alhazen/shapes/patches/patch_borders.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/quadratic.h"

namespace alhazen {

PlaneNet plane_net(const BezierNet& net, const PatchLine& line) {
    PlaneNet plane;
    plane.degree_u = net.degree_u;
    plane.degree_v = net.degree_v;
    for (int k = 0; k < net.count(); ++k) {
        const HomogeneousPoint& p = net.points[static_cast<std::size_t>(k)];
        const Vec3 offset = Vec3{p.x, p.y, p.z} - p.w * line.origin;
        plane.at[static_cast<std::size_t>(k)] = {dot(line.axis_x, offset),
                                                 dot(line.axis_y, offset)};
    }
    return plane;
}

namespace {

using PlaneRow = std::array<PlanePoint, kMaxPatchOrder>;

/// By midpoints: the same bits from either end, and never outside of the hull of `row`.
void halve_plane_row(const PlaneRow& row, int degree, PlaneRow& left, PlaneRow& right) {
    PlaneRow work = row;
    for (int level = 0; level <= degree; ++level) {
        const auto last = static_cast<std::size_t>(degree - level);
        left[static_cast<std::size_t>(level)] = work[0];
        right[last] = work[last];
        for (std::size_t k = 0; k < last; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
    }
}

/// The curve's point at a parameter of the grid.
PlanePoint point_of_row(PlaneRow row, int degree, double at) {
    if (at == 0.0) return row[0];
    double lo = 0.0, hi = 1.0;
    PlaneRow left, right;
    while (at != hi) {
        const double middle = 0.5 * (lo + hi);
        halve_plane_row(row, degree, left, right);
        const bool in_left = at <= middle;
        row = in_left ? left : right;
        (in_left ? hi : lo) = middle;
    }
    return row[static_cast<std::size_t>(degree)];
}

/// The control points of the line u = `at`.
PlaneRow row_at_u(const PlaneNet& net, double at) {
    PlaneRow result;
    const auto order_v = static_cast<std::size_t>(net.degree_v) + 1;
    for (std::size_t j = 0; j < order_v; ++j) {
        PlaneRow row;
        for (std::size_t i = 0; i <= static_cast<std::size_t>(net.degree_u); ++i) {
            row[i] = net.at[i * order_v + j];
        }
        result[j] = point_of_row(row, net.degree_u, at);
    }
    return result;
}
/// Those of the line v = `at`.
PlaneRow row_at_v(const PlaneNet& net, double at) {
    PlaneRow result;
    const auto order_v = static_cast<std::size_t>(net.degree_v) + 1;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(net.degree_u); ++i) {
        PlaneRow row;
        for (std::size_t j = 0; j < order_v; ++j) row[j] = net.at[i * order_v + j];
        result[i] = point_of_row(row, net.degree_v, at);
    }
    return result;
}

/// The line u = at or v = at of a patch, as the polyline through its points on the grid. A point is
/// found by halving in u first, on either kind of line: one value, whoever asks.
class Border {
  public:
    Border(const PlaneNet& net, bool along_v, double at, double tiny)
        : net_(net),
          along_v_(along_v),
          at_(at),
          tiny_(tiny),
          degree_(along_v ? net.degree_v : net.degree_u),
          // The points of an inner line v = at were halved in the other order.
          slack_(along_v || at == 0.0 || at == 1.0 ? 0.0 : 0.25 * tiny),
          row_(along_v ? row_at_u(net, at) : row_at_v(net, at)) {}

    /// Crossings of the positive x axis upward, less those downward, in the part over [from, to].
    int crossings(double from, double to) {
        PlaneRow row = row_, left, right;
        double lo = 0.0, hi = 1.0;
        while (lo != from || hi != to) {
            const double middle = 0.5 * (lo + hi);
            halve_plane_row(row, degree_, left, right);
            const bool in_left = to <= middle;
            row = in_left ? left : right;
            (in_left ? hi : lo) = middle;
        }
        return count(row, lo, hi);
    }

  private:
    struct Point {
        PlanePoint at;
        bool up = false;  ///< y >= 0
    };

    [[nodiscard]] Point point(const PlaneRow& row, bool last, double parameter) const {
        PlanePoint p = row[last ? static_cast<std::size_t>(degree_) : 0];
        if (slack_ != 0.0) p = point_of_row(row_at_u(net_, parameter), net_.degree_v, at_);
        if (std::abs(p.x) <= tiny_ && std::abs(p.y) <= tiny_) p = {tiny_, tiny_};
        return {p, p.y >= 0.0};
    }

    int count(const PlaneRow& row, double lo, double hi) {
        PlanePoint least = row[0], most = row[0];
        for (std::size_t k = 1; k <= static_cast<std::size_t>(degree_); ++k) {
            least = {std::min(least.x, row[k].x), std::min(least.y, row[k].y)};
            most = {std::max(most.x, row[k].x), std::max(most.y, row[k].y)};
        }
        const double beyond = tiny_ + slack_, within = tiny_ - slack_;
        if (least.y > slack_ || most.y < -beyond || most.x < -beyond) return 0;
        if (std::max({-least.x, -least.y, most.x, most.y}) <= within) return 0;
        const auto rise = [&](const Point& a, const Point& b) { return int{b.up} - int{a.up}; };
        if (least.x > slack_) return rise(point(row, false, lo), point(row, true, hi));
        if (hi - lo <= std::ldexp(1.0, -kMaxBorderLevel) || ++steps_ > kMostSteps) {
            const Point a = point(row, false, lo), b = point(row, true, hi);
            const double side = difference_of_products(a.at.x, b.at.y, b.at.x, a.at.y);
            return (b.up ? side > 0.0 : side < 0.0) ? rise(a, b) : 0;
        }
        PlaneRow left, right;
        halve_plane_row(row, degree_, left, right);
        const double middle = 0.5 * (lo + hi);
        return count(left, lo, middle) + count(right, middle, hi);
    }

    // A border that lies within some 2^-50 of the edge of the square of side 2 `tiny` for all its
    // length would be followed to its last point.
    static constexpr int kMostSteps = 2000;

    const PlaneNet& net_;
    bool along_v_;
    double at_, tiny_;
    int degree_;
    double slack_;
    PlaneRow row_;
    int steps_ = 0;
};

}  // namespace

bool passes_through(const PlaneNet& whole, const PatchCell& cell, double tiny) {
    const int sum = Border(whole, false, cell.v0, tiny).crossings(cell.u0, cell.u1) +
                    Border(whole, true, cell.u1, tiny).crossings(cell.v0, cell.v1) -
                    Border(whole, false, cell.v1, tiny).crossings(cell.u0, cell.u1) -
                    Border(whole, true, cell.u0, tiny).crossings(cell.v0, cell.v1);
    return sum % 2 != 0;
}

}  // namespace alhazen
