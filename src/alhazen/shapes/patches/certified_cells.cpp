#include "alhazen/shapes/patches/certified_cells.h"

#include "alhazen/shapes/patches/patch_lanes.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

enum class Place { Inside, Outside, Unclear };

/// Position of a root relative to a cell: certain if its distance in the plane of the line from
/// each side is above the rounding, `scale` times `tiny`.
Place place_of(PlanePoint by_u, PlanePoint by_v, double scale, double tiny, const PatchCell& cell,
               double u, double v) {
    const auto [x_u, y_u] = by_u;
    const auto [x_v, y_v] = by_v;
    // The factor of a quarter allows for the change of the derivatives across the cell.
    const double area = 0.25 * std::abs(x_u * y_v - x_v * y_u);
    const double inside_u = std::min(u - cell.u0, cell.u1 - u) * area;
    const double inside_v = std::min(v - cell.v0, cell.v1 - v) * area;
    const double margin = 4.0 * scale * tiny;
    const double margin_u = margin * std::sqrt(x_v * x_v + y_v * y_v);
    const double margin_v = margin * std::sqrt(x_u * x_u + y_u * y_u);
    if (inside_u > margin_u && inside_v > margin_v) return Place::Inside;
    if (inside_u < -margin_u || inside_v < -margin_v) return Place::Outside;
    return Place::Unclear;
}

double t_at(const Vec3& from_origin, const PatchLine& line) {
    return line.shift + dot(from_origin, line.direction) * line.per_length;
}

}  // namespace

bool certified_root(NewtonProof proof, RootOf what, BezierView net, const PatchLine& line,
                    const PatchCell& cell, double noise, double u, double v, PatchRoot& root) {
    const double width_u = cell.u1 - cell.u0, width_v = cell.v1 - cell.v0;
    const Vec3& d = line.direction;
    // Bound of the distance from the estimate to the root, if there is one, in widths.
    double reach = 0.25 * kCertified + kCellMargin, last = 1.0;
    for (int step = 0; step < 40; ++step) {
        const double far_u = reach * width_u, far_v = reach * width_v;
        if (!(u >= cell.u0 - far_u && u <= cell.u1 + far_u && v >= cell.v0 - far_v &&
              v <= cell.v1 + far_v)) {
            return false;
        }
        u = std::clamp(u, cell.u0 - kCellMargin * width_u, cell.u1 + kCellMargin * width_u);
        v = std::clamp(v, cell.v0 - kCellMargin * width_v, cell.v1 + kCellMargin * width_v);
        PatchValue at;
        if (what == RootOf::Point) {
            at = patch_value(net, u, v);
            at.point = at.point - line.origin;
        } else {
            at = weighted_value(net, line.origin, u, v);
        }
        const Vec3 across_v = cross(at.dv, d), across_u = cross(d, at.du);
        const double inverse = -1.0 / dot(at.du, across_v);
        const double du = dot(across_v, at.point) * inverse;
        const double dv = dot(across_u, at.point) * inverse;
        u += du;
        v += dv;
        reach = std::max({0.7 * reach, kCellMargin, noise});
        const double moved = std::max(std::abs(du) / width_u, std::abs(dv) / width_v);
        // Stops, unless the steps still shrink as they do before rounding dominates. Without a
        // proof of convergence, steps that do not shrink are no indication of rounding.
        const bool stalled =
            proof == NewtonProof::Converges && last < 0x1p-4 && moved > 0.25 * last;
        last = moved;
        if (moved > 0x1p-23 && !stalled) continue;
        const double scale = what == RootOf::Point ? 1.0 / at.weight : 1.0;
        const PlanePoint by_u{dot(line.axis_x, at.du), dot(line.axis_y, at.du)};
        const PlanePoint by_v{dot(line.axis_x, at.dv), dot(line.axis_y, at.dv)};
        const Place place = place_of(by_u, by_v, scale, line.tiny, cell, u, v);
        if (place == Place::Outside) return false;
        if (place == Place::Unclear && !passes_through(border_net(net, line), cell, line.tiny)) {
            return false;
        }
        // Near a border the root may lie outside the patch; the crossing is clamped to the patch.
        root.u = std::clamp(u, 0.0, 1.0);
        root.v = std::clamp(v, 0.0, 1.0);
        if (what == RootOf::Point && root.u == u && root.v == v) {
            root.t = t_at(at.point + du * at.du + dv * at.dv, line);
        } else {
            root.t = t_at(patch_value(net, root.u, root.v).point - line.origin, line);
        }
        return true;
    }
    return false;
}

bool certified_root(NewtonProof proof, BezierView net, const CubicLine& seen, const PatchLine& line,
                    const PatchCell& cell, double noise, double u, double v, const LineRange* range,
                    PatchRoot& root) {
    const bool converges = proof == NewtonProof::Converges;
    CubicNewton task{cell, u, v, noise, converges, converges && range != nullptr, 0, 0, 0};
    if (task.has_range) {
        task.least = range->least;
        task.most = range->most;
        task.bend = range->bend;
    }
    CubicRoot at;
    return patch_kernels().cubic_newton(seen, task, at) == NewtonEnd::Root &&
           is_root(net, line, cell, at, root);
}

bool is_root(const BezierView& net, const PatchLine& line, const PatchCell& cell,
             const CubicRoot& at, PatchRoot& root) {
    const Place place =
        place_of({at.x_u, at.y_u}, {at.x_v, at.y_v}, 1.0, line.tiny, cell, at.u, at.v);
    if (place == Place::Outside) return false;
    if (place == Place::Unclear && !passes_through(border_net(net, line), cell, line.tiny)) {
        return false;
    }
    // Near a border the root may lie outside the patch; the crossing is clamped to the patch.
    root.u = std::clamp(at.u, 0.0, 1.0);
    root.v = std::clamp(at.v, 0.0, 1.0);
    root.t = line.shift + at.z * line.per_length;
    if (!net.plain || root.u != at.u || root.v != at.v) {
        root.t = t_at(patch_value(net, root.u, root.v).point - line.origin, line);
    }
    return true;
}

namespace {

void halve_cell(const PlaneNet& net, bool along_u, PlaneNet& low, PlaneNet& high) {
    low.degree_u = high.degree_u = net.degree_u;
    low.degree_v = high.degree_v = net.degree_v;
    const int degree = along_u ? net.degree_u : net.degree_v;
    const int rows = along_u ? net.degree_v : net.degree_u;
    const int row_stride = along_u ? 1 : net.degree_v + 1;
    const int stride = along_u ? net.degree_v + 1 : 1;
    for (int r = 0; r <= rows; ++r) {
        PlanePoint work[kMaxPatchOrder];
        const auto index = [&](int k) {
            return static_cast<std::size_t>(r * row_stride + k * stride);
        };
        for (int k = 0; k <= degree; ++k) work[k] = net.at[index(k)];
        for (int level = 0; level <= degree; ++level) {
            low.at[index(level)] = work[0];
            high.at[index(degree - level)] = work[degree - level];
            for (int k = 0; k < degree - level; ++k) work[k] = 0.5 * (work[k] + work[k + 1]);
        }
    }
}

void halve_cell(const CubicCell& net, bool along_u, CubicCell& low, CubicCell& high) {
    patch_kernels().halve_cubic(net, along_u, low, high);
}

double cross2(const PlanePoint& a, const PlanePoint& b) {
    return a.x * b.y - a.y * b.x;
}
double size_of(const PlanePoint& a) {
    return std::abs(a.x) + std::abs(a.y);
}

/// Bounds of a cell of any degree.
CellBounds bounds_of(const PlaneNet& net) {
    const auto n = static_cast<std::size_t>(net.degree_u),
               m = static_cast<std::size_t>(net.degree_v);
    const auto at = [&](std::size_t i, std::size_t j) { return net.at[i * (m + 1) + j]; };
    CellBounds out{};
    double bu[kMaxPatchOrder], bv[kMaxPatchOrder], cu[kMaxPatchOrder], cv[kMaxPatchOrder];
    bernstein_values(net.degree_u, 0.5, bu, cu);
    bernstein_values(net.degree_v, 0.5, bv, cv);
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= m; ++j) {
            out.f = out.f + (bu[i] * bv[j]) * at(i, j);
            out.f_u = out.f_u + (0.5 * cu[i] * bv[j]) * at(i, j);
            out.f_v = out.f_v + (0.5 * bu[i] * cv[j]) * at(i, j);
        }
    }
    const PlanePoint along = size_of(out.f_u) > size_of(out.f_v) ? out.f_u : out.f_v;
    const double scale = size_of(along), det = cross2(out.f_u, out.f_v);
    const PlanePoint aside =
        scale > 0.0 ? PlanePoint{-along.y / scale, along.x / scale} : PlanePoint{0.5, 0.5};
    const double inverse = det != 0.0 ? 1.0 / det : 0.0;
    const auto larger = [](double& most, double x) { most = std::max(most, x); };
    const auto include = [&](int k, double& size, const PlanePoint& d) {
        larger(size, size_of(d));
        larger(out.bend_u[k], std::abs(inverse * cross2(d, out.f_v)));
        larger(out.bend_v[k], std::abs(inverse * cross2(out.f_u, d)));
    };
    std::fill_n(out.least, 3, kInfinity);
    std::fill_n(out.most, 3, -kInfinity);
    for (std::size_t i = 0; i <= n; ++i) {
        for (std::size_t j = 0; j <= m; ++j) {
            const PlanePoint p = at(i, j);
            const double x[3] = {p.x, p.y, p.x * aside.x + p.y * aside.y};
            for (int axis = 0; axis < 3; ++axis) {
                larger(out.most[axis], x[axis]);
                out.least[axis] = std::min(out.least[axis], x[axis]);
            }
            if (i < n) larger(out.extent_u, size_of(at(i + 1, j) - p));
            if (j < m) larger(out.extent_v, size_of(at(i, j + 1) - p));
            if (i + 2 <= n) include(0, out.size_uu, at(i + 2, j) - 2.0 * at(i + 1, j) + p);
            if (j + 2 <= m) include(2, out.size_vv, at(i, j + 2) - 2.0 * at(i, j + 1) + p);
            if (i < n && j < m) {
                include(1, out.size_uv, at(i + 1, j + 1) - at(i, j + 1) - at(i + 1, j) + p);
            }
        }
    }
    return out;
}

/// Bounds and tests of a cell from its control points.
class CellFacts {
  public:
    CellFacts(const PlaneNet& net, double tiny)
        : n_(net.degree_u), m_(net.degree_v), margin_(1.5 * tiny), bounds_(bounds_of(net)) {}
    CellFacts(const CubicCell& net, double tiny) : n_(3), m_(3), margin_(1.5 * tiny) {
        patch_kernels().cubic_bounds(net, margin_, bounds_);
    }

    enum class Hull { Beside, Thin, Around };
    /// Beside: no root, as all points are on one side of a line through the origin, by more than
    /// 1.5 `tiny`. Thin: all are within 2 `tiny` of a line through the origin.
    [[nodiscard]] Hull hull(double tiny) const {
        bool thin = false;
        for (int axis = 0; axis < 3; ++axis) {
            const double least = bounds_.least[axis], most = bounds_.most[axis];
            if (least > margin_ || most < -margin_) return Hull::Beside;
            thin = thin || std::max(-least, most) <= 2.0 * tiny;
        }
        return thin ? Hull::Thin : Hull::Around;
    }
    enum class Newton { Certified, Unique, NoRoot, Unsure };
    /// Classifies Newton's method in the cell; sets the first step from the middle, in half-widths,
    /// and the approximate distance of the cell's borders from its middle. NoRoot: the step leads
    /// farther out of the cell than possible for a root in it, with a margin for `tiny`.
    Newton newton(double tiny, PlanePoint& step, double& radius) const {
        const PlanePoint &f = bounds_.f, &f_u = bounds_.f_u, &f_v = bounds_.f_v;
        const double det = cross2(f_u, f_v), size = size_of(f_u) * size_of(f_v);
        if (!(std::abs(det) > 0x1p-40 * size)) return Newton::Unsure;
        step = {-cross2(f, f_v) / det, -cross2(f_u, f) / det};
        radius = std::abs(det) / std::max(size_of(f_u), size_of(f_v));
        // Factor by which Bernstein coefficients bound the change over the cell with its margin.
        const double growth = 0.25 * (1.0 + 2.5 * kCellMargin * (n_ + m_));
        const double uu = growth * (n_ * (n_ - 1)), uv = 2.0 * growth * (n_ * m_);
        const double vv = growth * (m_ * (m_ - 1));
        const auto sum = [&](const double(&b)[3]) { return uu * b[0] + uv * b[1] + vv * b[2]; };
        const double bend_u = sum(bounds_.bend_u), bend_v = sum(bounds_.bend_v);
        const double margin = 1.001 + 8.0 * tiny / radius;
        if (std::abs(step.x) > margin + 0.5 * bend_u || std::abs(step.y) > margin + 0.5 * bend_v) {
            return Newton::NoRoot;
        }
        const double bend = std::max(bend_u, bend_v);
        return bend <= kCertified ? Newton::Certified
               : bend < kUnique   ? Newton::Unique
                                  : Newton::Unsure;
    }
    /// True to halve in u: the direction of the larger bend or, if the mixed difference is largest,
    /// of the larger extent.
    [[nodiscard]] bool split_u() const {
        const double bend_u = n_ * (n_ - 1) * bounds_.size_uu;
        const double bend_v = m_ * (m_ - 1) * bounds_.size_vv;
        if (std::max(bend_u, bend_v) > n_ * m_ * bounds_.size_uv) return bend_u > bend_v;
        return n_ * bounds_.extent_u > m_ * bounds_.extent_v;
    }

  private:
    int n_, m_;
    double margin_;
    CellBounds bounds_;
};

constexpr double kSmallestCell = 1.0 / static_cast<double>(1LL << kMaxCellLevel);

/// The halves of a cell.
std::array<PatchCell, 2> halves_of(const PatchCell& cell, bool along_u) {
    const double u = 0.5 * (cell.u0 + cell.u1), v = 0.5 * (cell.v0 + cell.v1);
    if (along_u) return {PatchCell{cell.u0, u, cell.v0, cell.v1}, {u, cell.u1, cell.v0, cell.v1}};
    return {PatchCell{cell.u0, cell.u1, cell.v0, v}, {cell.u0, cell.u1, v, cell.v1}};
}

}  // namespace

template <>
CellSearch<PlaneNet>::CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell)
    : CellSettling(net, line) {
    size_ = 1;
    stack_[0].net = plane_net(net, line);
    // Halves down to the cell, dropping the other halves.
    PatchCell& at = stack_[0].cell;
    at = {0, 1, 0, 1};
    const auto inside = [&] {
        return at.u0 == cell.u0 && at.u1 == cell.u1 && at.v0 == cell.v0 && at.v1 == cell.v1;
    };
    while (!inside()) {
        const bool along_u = at.u0 != cell.u0 || at.u1 != cell.u1;
        push_halves(along_u);
        size_ = 1;
        if (along_u ? cell.u0 >= at.u1 : cell.v0 >= at.v1) stack_[0] = stack_[1];
    }
}

template <>
CellSearch<CubicCell>::CellSearch(BezierView net, const PatchLine& line, const PatchCell& cell,
                                  const CubicLine& seen, const LineRange* range)
    : CellSettling(net, line), CellSearchFacts{&seen, range, cell} {
    size_ = 1;
    patch_kernels().cubic_part(seen, cell, stack_[0].net);
    stack_[0].cell = cell;
}

template <>
bool CellSearch<PlaneNet>::find_root(NewtonProof proof, const PatchCell& cell, double noise,
                                     double u, double v, PatchRoot& root) const {
    return certified_root(proof, RootOf::WeightedPoint, net_, line_, cell, noise, u, v, root);
}

template <>
bool CellSearch<CubicCell>::find_root(NewtonProof proof, const PatchCell& cell, double noise,
                                      double u, double v, PatchRoot& root) const {
    if (range == nullptr) {
        return certified_root(proof, net_, *seen, line_, cell, noise, u, v, nullptr, root);
    }
    const double part = std::max((cell.u1 - cell.u0) / (whole.u1 - whole.u0),
                                 (cell.v1 - cell.v0) / (whole.v1 - whole.v0));
    LineRange of_cell = *range;
    of_cell.bend *= part * part;
    return certified_root(proof, net_, *seen, line_, cell, noise, u, v, &of_cell, root);
}

/// Replaces the last entry by its halves.
template <class Net>
void CellSearch<Net>::push_halves(bool along_u) {
    Entry& low = stack_[size_ - 1];
    Entry& high = stack_[size_++];
    halve_cell(low.net, along_u, low.net, high.net);
    const auto halves = halves_of(low.cell, along_u);
    low.cell = halves[0];
    high.cell = halves[1];
}

template <class Net>
bool CellSearch<Net>::next(PatchRoot& root) {
    while (size_ > 0) {
        const Entry& top = stack_[size_ - 1];
        const PatchCell cell = top.cell;
        const double width_u = cell.u1 - cell.u0, width_v = cell.v1 - cell.v0;
        const CellFacts facts(top.net, line_.tiny);
        const auto hull = facts.hull(line_.tiny);
        if (hull == CellFacts::Hull::Beside) {
            --size_;
            continue;
        }
        PlanePoint step;
        double radius = 0.0;
        auto newton = CellFacts::Newton::Unsure;
        if (hull == CellFacts::Hull::Around) newton = facts.newton(line_.tiny, step, radius);
        if (newton == CellFacts::Newton::NoRoot) {
            --size_;
            continue;
        }
        if (newton == CellFacts::Newton::Certified || newton == CellFacts::Newton::Unique) {
            const double u = cell.u0 + 0.5 * (1.0 + step.x) * width_u;
            const double v = cell.v0 + 0.5 * (1.0 + step.y) * width_v;
            const double noise = 2.0 * line_.tiny / radius;
            const bool sure = newton == CellFacts::Newton::Certified;
            const NewtonProof proof = sure ? NewtonProof::Converges : NewtonProof::Unique;
            const bool met = noise > 0x1p-6 ? sure && settle(cell, root)
                                            : find_root(proof, cell, noise, u, v, root);
            if (met || sure) --size_;
            if (met) return true;
            if (sure) continue;
        }
        bool along_u = facts.split_u();
        if ((along_u ? width_u : width_v) <= kSmallestCell) along_u = !along_u;
        if (hull == CellFacts::Hull::Thin || ++cells_ > kMostCells ||
            (along_u ? width_u : width_v) <= kSmallestCell) {
            --size_;
            if (settle(cell, root)) return true;
            continue;
        }
        push_halves(along_u);
    }
    return false;
}

/// Reports one root if the winding number is odd: descends into the halves where it is odd, then
/// takes the nearest point to the line there or nearby. Where a derivative is zero, the displaced
/// half-line moves the root by the square root of `tiny`.
bool CellSettling::settle(PatchCell cell, PatchRoot& root) const {
    const PlaneNet whole = border_net(net_, line_);
    if (!passes_through(whole, cell, line_.tiny)) return false;
    constexpr double kFine = 0x1p-18;
    while (std::max(cell.u1 - cell.u0, cell.v1 - cell.v0) > kFine) {
        const auto halves = halves_of(cell, cell.u1 - cell.u0 >= cell.v1 - cell.v0);
        cell = halves[passes_through(whole, halves[0], line_.tiny) ? 0 : 1];
    }
    cell = {std::max(cell.u0 - kFine, 0.0), std::min(cell.u1 + kFine, 1.0),
            std::max(cell.v0 - kFine, 0.0), std::min(cell.v1 + kFine, 1.0)};
    root = nearest_point(cell);
    root.t = t_at(patch_value(net_, root.u, root.v).point - line_.origin, line_);
    return true;
}

/// Source: Levenberg, "A Method for the Solution of Certain Non-Linear Problems in Least Squares",
/// Quarterly of Applied Mathematics 2(2), 1944. Without damping it is Newton's method; if the
/// derivatives are parallel, or one is zero, it still converges in the other direction.
PatchRoot CellSettling::nearest_point(const PatchCell& cell) const {
    constexpr double kLeastDamping = 0x1p-40;
    PatchRoot root{.u = 0.5 * (cell.u0 + cell.u1), .v = 0.5 * (cell.v0 + cell.v1)};
    const Vec3& d = line_.direction;
    PatchValue at = weighted_value(net_, line_.origin, root.u, root.v);
    Vec3 off = cross(at.point, d);
    double damping = 0.0;
    for (int step = 0; step < 60; ++step) {
        const Vec3 by_u = cross(at.du, d), by_v = cross(at.dv, d);
        const double added = damping * (dot(by_u, by_u) + dot(by_v, by_v));
        const double uu = dot(by_u, by_u) + added, vv = dot(by_v, by_v) + added;
        const double uv = dot(by_u, by_v), det = uu * vv - uv * uv;
        if (det > 0.0) {
            const double u = dot(by_u, off), v = dot(by_v, off);
            PatchRoot next = root;
            next.u = std::clamp(root.u - (vv * u - uv * v) / det, cell.u0, cell.u1);
            next.v = std::clamp(root.v - (uu * v - uv * u) / det, cell.v0, cell.v1);
            const PatchValue next_at = weighted_value(net_, line_.origin, next.u, next.v);
            const Vec3 next_off = cross(next_at.point, d);
            if (dot(next_off, next_off) < dot(off, off)) {
                root = next;
                at = next_at;
                off = next_off;
                damping = damping > kLeastDamping ? 0x1p-4 * damping : 0.0;
                continue;
            }
        }
        if (damping > 1.0) break;
        damping = std::max(16.0 * damping, kLeastDamping);
    }
    return root;
}

template class CellSearch<PlaneNet>;
template class CellSearch<CubicCell>;

}  // namespace alhazen
