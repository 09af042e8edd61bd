#include "alhazen/shapes/patches/patch_borders.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/quadratic.h"

namespace alhazen {

PlaneNet plane_net(BezierView net, const PatchLine& line) {
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

PlaneNet border_net(BezierView net, const PatchLine& line) {
    PatchLine beside = line;
    beside.origin += line.tiny * (line.axis_x + 0.37 * line.axis_y);
    return plane_net(net, beside);
}

namespace {

using PlaneRow = std::array<PlanePoint, kMaxPatchOrder>;

/// Halves by midpoints: the same bits from either end, and never outside the hull of `row`.
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
/// The control points of the line v = `at`.
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

/// Crossings of the positive x axis by the segment from `a` to `b`: 1 upward, -1 downward.
int segment_crossings(PlanePoint a, PlanePoint b) {
    const bool a_up = a.y >= 0.0, b_up = b.y >= 0.0;
    if (a_up == b_up) return 0;
    const double side = difference_of_products(a.x, b.y, b.x, a.y);
    return (b_up ? side > 0.0 : side < 0.0) ? int{b_up} - int{a_up} : 0;
}

/// The line u = at or v = at of a patch, as the polyline through its points on the grid. Corners of
/// cells are computed by halving in u first, for both kinds of line, so that a corner has one
/// value. The points of an inner line v = at are halved in v first; a part of it has an additional
/// segment at each end, to the corner.
class Border {
  public:
    Border(const PlaneNet& net, bool along_v, double at, double tiny)
        : net_(net),
          at_(at),
          degree_(along_v ? net.degree_v : net.degree_u),
          ends_at_corners_(along_v || at == 0.0 || at == 1.0),
          row_(along_v ? row_at_u(net, at) : row_at_v(net, at)) {
        // Points of the polyline are about tiny / 32 apart.
        double fastest = 0.0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(degree_); ++k) {
            const PlanePoint d = row_[k + 1] - row_[k];
            fastest = std::max({fastest, std::abs(d.x), std::abs(d.y)});
        }
        const int level = fastest > 0.0 ? std::ilogb(32.0 * degree_ * fastest / tiny) + 1 : 0;
        last_ = std::ldexp(1.0, -std::clamp(level, 8, kMaxBorderLevel));
    }

    /// Signed number of crossings of the positive x axis, upward positive, in the part over [from,
    /// to].
    [[nodiscard]] int crossings(double from, double to) const {
        PlaneRow row = row_, left, right;
        double lo = 0.0, hi = 1.0;
        while (lo != from || hi != to) {
            const double middle = 0.5 * (lo + hi);
            halve_plane_row(row, degree_, left, right);
            const bool in_left = to <= middle;
            row = in_left ? left : right;
            (in_left ? hi : lo) = middle;
        }
        const int between = count(row, lo, hi);
        if (ends_at_corners_) return between;
        return between + to_corner(row[static_cast<std::size_t>(degree_)], to) -
               to_corner(row[0], from);
    }

  private:
    /// Crossings of the segment from a point of the line to the corner of cells that it represents.
    [[nodiscard]] int to_corner(PlanePoint point, double parameter) const {
        return segment_crossings(point,
                                 point_of_row(row_at_u(net_, parameter), net_.degree_v, at_));
    }

    [[nodiscard]] int count(const PlaneRow& row, double lo, double hi) const {
        const PlanePoint first = row[0], last = row[static_cast<std::size_t>(degree_)];
        PlanePoint least = first, most = first;
        for (std::size_t k = 1; k <= static_cast<std::size_t>(degree_); ++k) {
            least = {std::min(least.x, row[k].x), std::min(least.y, row[k].y)};
            most = {std::max(most.x, row[k].x), std::max(most.y, row[k].y)};
        }
        if (least.y > 0.0 || most.y < 0.0 || most.x < 0.0) return 0;
        if (least.x > 0.0) return int{last.y >= 0.0} - int{first.y >= 0.0};
        if (hi - lo <= last_) return segment_crossings(first, last);
        PlaneRow left, right;
        halve_plane_row(row, degree_, left, right);
        const double middle = 0.5 * (lo + hi);
        return count(left, lo, middle) + count(right, middle, hi);
    }

    const PlaneNet& net_;
    double at_;
    int degree_;
    bool ends_at_corners_;
    double last_;
    PlaneRow row_;
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
