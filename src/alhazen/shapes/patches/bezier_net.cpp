#include "alhazen/shapes/patches/bezier_net.h"

#include <algorithm>
#include <cmath>

namespace alhazen {

namespace {

using Row = std::array<HomogeneousPoint, kMaxPatchOrder>;

/// The two halves of a curve; `left` may be `row`.
void halve_row(const Row& row, int degree, Row& left, Row& right) {
    Row work = row;
    for (int level = 0; level <= degree; ++level) {
        left[static_cast<std::size_t>(level)] = work[0];
        right[static_cast<std::size_t>(degree - level)] =
            work[static_cast<std::size_t>(degree - level)];
        for (int i = 0; i < degree - level; ++i) {
            const auto k = static_cast<std::size_t>(i);
            work[k] = 0.5 * (work[k] + work[k + 1]);
        }
    }
}

/// The two halves of a net in u, or in v.
std::pair<BezierNet, BezierNet> halved(const BezierNet& net, bool in_u) {
    std::pair<BezierNet, BezierNet> halves;
    auto& [low, high] = halves;
    low.degree_u = high.degree_u = net.degree_u;
    low.degree_v = high.degree_v = net.degree_v;
    const int degree = in_u ? net.degree_u : net.degree_v;
    const int rows = in_u ? net.degree_v : net.degree_u;
    Row row, left, right;
    for (int j = 0; j <= rows; ++j) {
        const auto at = [&](auto& of, int i) -> auto& {
            return in_u ? of.at(i, j) : of.at(j, i);
        };
        for (int i = 0; i <= degree; ++i) row[static_cast<std::size_t>(i)] = at(net, i);
        halve_row(row, degree, left, right);
        for (int i = 0; i <= degree; ++i) {
            at(low, i) = left[static_cast<std::size_t>(i)];
            at(high, i) = right[static_cast<std::size_t>(i)];
        }
    }
    return halves;
}

/// The part of a curve over [t0, t1]: blossoms of the ends.
void restrict_row(Row& row, int degree, double t0, double t1) {
    const auto blend = [](const HomogeneousPoint& a, const HomogeneousPoint& b, double t) {
        return (1.0 - t) * a + t * b;
    };
    Row part;
    for (int k = 0; k <= degree; ++k) {
        Row work = row;
        for (int level = 0; level < degree; ++level) {
            const double t = level < k ? t1 : t0;
            for (int i = 0; i < degree - level; ++i) {
                const auto n = static_cast<std::size_t>(i);
                work[n] = blend(work[n], work[n + 1], t);
            }
        }
        part[static_cast<std::size_t>(k)] = work[0];
    }
    row = part;
}

/// Calls `change(row)` for the curves in u, each of which is written back.
template <class Change>
BezierNet each_in_u(const BezierNet& net, const Change& change) {
    BezierNet result;
    result.degree_u = net.degree_u;
    result.degree_v = net.degree_v;
    for (int j = 0; j <= net.degree_v; ++j) {
        Row row;
        for (int i = 0; i <= net.degree_u; ++i) row[static_cast<std::size_t>(i)] = net.at(i, j);
        change(row);
        for (int i = 0; i <= net.degree_u; ++i) result.at(i, j) = row[static_cast<std::size_t>(i)];
    }
    return result;
}

/// Value and derivative of a Bezier curve.
struct CurvePoint {
    HomogeneousPoint value, first;
};
CurvePoint curve_at(Row work, int degree, double t) {
    CurvePoint at;
    at.first = {0, 0, 0, 0};
    for (int level = degree; level > 0; --level) {
        if (level == 1) at.first = static_cast<double>(degree) * (work[1] - work[0]);
        for (int i = 0; i < level; ++i) {
            const auto k = static_cast<std::size_t>(i);
            work[k] = (1.0 - t) * work[k] + t * work[k + 1];
        }
    }
    at.value = work[0];
    return at;
}

Vec3 numerator(const HomogeneousPoint& p) {
    return {p.x, p.y, p.z};
}

/// Nodes and weights of 12-point Gauss-Legendre quadrature on [0, 1] (Abramowitz and Stegun, table
/// 25.4); the other half is symmetric.
constexpr std::array<std::array<double, 2>, 6> kGauss{{
    {0.125233408511468915472441369464, 0.249147045813402785000562436043},
    {0.367831498998180193752691536644, 0.233492536538354808760849898925},
    {0.587317954286617447296702418941, 0.203167426723065921749064455810},
    {0.769902674194304687036893833213, 0.160078328543346226334652529543},
    {0.904117256370474856678465866119, 0.106939325995318430960254718194},
    {0.981560634246719250690549090149, 0.047175336386511827194615961485},
}};

PatchMeasures gauss_measures(const BezierNet& net) {
    PatchMeasures sum;
    const auto add = [&](double u, double v, double weight) {
        const PatchPoint p = derivatives_at(net, u, v);
        const Vec3 normal = cross(p.du, p.dv);
        sum.area += weight * length(normal);
        sum.flux_volume += weight * dot(p.point, normal) / 3.0;
    };
    for (const auto& [x, wx] : kGauss) {
        for (const auto& [y, wy] : kGauss) {
            for (const double u : {0.5 - 0.5 * x, 0.5 + 0.5 * x}) {
                for (const double v : {0.5 - 0.5 * y, 0.5 + 0.5 * y}) {
                    add(u, v, 0.25 * wx * wy);
                }
            }
        }
    }
    return sum;
}

/// `settled`: halving in the other direction did not change the result.
PatchMeasures adaptive_measures(const BezierNet& net, const PatchMeasures& whole,
                                double area_tolerance, double volume_tolerance, int depth,
                                bool settled) {
    const auto [low, high] = depth % 2 == 0 ? halved_u(net) : halved_v(net);
    const PatchMeasures a = gauss_measures(low);
    const PatchMeasures b = gauss_measures(high);
    const PatchMeasures both{a.area + b.area, a.flux_volume + b.flux_volume};
    const bool exact = std::abs(both.area - whole.area) <= area_tolerance &&
                       std::abs(both.flux_volume - whole.flux_volume) <= volume_tolerance;
    if ((exact && settled) || depth > 24) return both;
    const PatchMeasures x =
        adaptive_measures(low, a, 0.7 * area_tolerance, 0.7 * volume_tolerance, depth + 1, exact);
    const PatchMeasures y =
        adaptive_measures(high, b, 0.7 * area_tolerance, 0.7 * volume_tolerance, depth + 1, exact);
    return {x.area + y.area, x.flux_volume + y.flux_volume};
}

}  // namespace

BezierNet bezier_net(int degree_u, int degree_v, std::span<const Vec3> points,
                     std::span<const double> weights) {
    BezierNet net;
    net.degree_u = degree_u;
    net.degree_v = degree_v;
    for (std::size_t k = 0; k < points.size(); ++k) {
        net.points[k] = homogeneous(points[k], weights.empty() ? 1.0 : weights[k]);
    }
    return net;
}

PatchPoint derivatives_at(BezierView net, double u, double v) {
    Row values, firsts;  // of the curves in v, along u
    for (int i = 0; i <= net.degree_u; ++i) {
        Row row;
        for (int j = 0; j <= net.degree_v; ++j) row[static_cast<std::size_t>(j)] = net.at(i, j);
        const CurvePoint at = curve_at(row, net.degree_v, v);
        const auto k = static_cast<std::size_t>(i);
        values[k] = at.value;
        firsts[k] = at.first;
    }
    const CurvePoint s = curve_at(values, net.degree_u, u);
    const HomogeneousPoint s_v = curve_at(firsts, net.degree_u, u).value;
    // Quotient rule (Piegl and Tiller, The NURBS Book, equation 4.20).
    const double w = s.value.w;
    PatchPoint p;
    p.point = numerator(s.value) / w;
    p.du = (numerator(s.first) - s.first.w * p.point) / w;
    p.dv = (numerator(s_v) - s_v.w * p.point) / w;
    return p;
}

Vec3 point_at(BezierView net, double u, double v) {
    Row values;
    for (int i = 0; i <= net.degree_u; ++i) {
        Row row;
        for (int j = 0; j <= net.degree_v; ++j) row[static_cast<std::size_t>(j)] = net.at(i, j);
        values[static_cast<std::size_t>(i)] = curve_at(row, net.degree_v, v).value;
    }
    return projected(curve_at(values, net.degree_u, u).value);
}

Vec3 patch_normal(BezierView net, double u, double v) {
    // Steps towards the centre grow until the derivatives span a plane.
    for (double step = 0.0; step < 0.6; step = step == 0.0 ? 0x1p-30 : 4.0 * step) {
        const double s = u + step * (0.5 - u) * 2.0;
        const double t = v + step * (0.5 - v) * 2.0;
        const PatchPoint p = derivatives_at(net, s, t);
        const Vec3 n = cross(p.du, p.dv);
        const double size = length(n);
        if (size > 1e-10 * (dot(p.du, p.du) + dot(p.dv, p.dv)) && size > 0.0) return n / size;
    }
    return {};
}

std::pair<BezierNet, BezierNet> halved_u(const BezierNet& net) {
    return halved(net, true);
}

std::pair<BezierNet, BezierNet> halved_v(const BezierNet& net) {
    return halved(net, false);
}

BezierNet transposed(const BezierNet& net) {
    BezierNet result;
    result.degree_u = net.degree_v;
    result.degree_v = net.degree_u;
    for (int i = 0; i <= net.degree_u; ++i) {
        for (int j = 0; j <= net.degree_v; ++j) result.at(j, i) = net.at(i, j);
    }
    return result;
}

BezierNet part_of(const BezierNet& net, double u0, double u1, double v0, double v1) {
    const BezierNet in_u =
        each_in_u(net, [&](Row& row) { restrict_row(row, net.degree_u, u0, u1); });
    return transposed(
        each_in_u(transposed(in_u), [&](Row& row) { restrict_row(row, net.degree_v, v0, v1); }));
}

int boundary_curve(BezierView net, int side, std::array<HomogeneousPoint, kMaxPatchOrder>& curve) {
    const bool along_u = side % 2 == 0;
    const int degree = along_u ? net.degree_u : net.degree_v;
    const int fixed = side == 1 ? net.degree_u : side == 2 ? net.degree_v : 0;
    for (int k = 0; k <= degree; ++k) {
        curve[static_cast<std::size_t>(k)] = along_u ? net.at(k, fixed) : net.at(fixed, k);
    }
    return degree + 1;
}

Box3 control_box(BezierView net) {
    Box3 box;
    for (int k = 0; k < net.count(); ++k) {
        box.include(projected(net.points[k]));
    }
    return box;
}

PatchMeasures measures_of(const BezierNet& net) {
    const PatchMeasures whole = gauss_measures(net);
    const double size = length(control_box(net).size());
    const double area = std::max(whole.area, 1e-30 * size * size);
    const Vec3 center = abs(control_box(net).center());
    return adaptive_measures(net, whole, 1e-12 * area,
                             1e-12 * area * (max_component(center) + size), 0, false);
}

}  // namespace alhazen
