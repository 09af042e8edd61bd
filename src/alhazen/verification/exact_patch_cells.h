#pragma once
/// Control points of a patch relative to a line, in double precision or 113 bits, and the
/// properties of a part of the patch that they prove.
///
/// Source: see exact_patches.h.
/// Conventions: internal to exact_patches.cpp.

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/patches/bezier_net.h"
#include "alhazen/verification/exact_line.h"

namespace alhazen {

inline constexpr std::size_t kMostPoints = std::size_t{kMaxPatchOrder} * kMaxPatchOrder;
// A Jacobian that differs from the identity by at most this bound is one to one.
inline constexpr double kContraction = 0.9;
inline constexpr double kMostNoise = 0.01;  // of a cell's half-width

/// The two coordinates perpendicular to the line, times the weight.
template <class R>
struct LineNet {
    int n = 0, m = 0;
    std::array<R, kMostPoints> x, y;

    [[nodiscard]] std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i * (m + 1) + j);
    }
    [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>((n + 1) * (m + 1)); }
};

struct DyadicCell {
    Real128 u = 0, v = 0;  // lower corner
    int level_u = 0, level_v = 0;

    [[nodiscard]] Real128 width_u() const { return std::ldexp(1.0, -level_u); }
    [[nodiscard]] Real128 width_v() const { return std::ldexp(1.0, -level_v); }
    [[nodiscard]] DyadicCell half(bool along_u, bool high) const {
        DyadicCell c = *this;
        (along_u ? c.level_u : c.level_v)++;
        if (high) (along_u ? c.u : c.v) += along_u ? c.width_u() : c.width_v();
        return c;
    }
};

template <class R>
void halve_row(const std::array<R, kMostPoints>& from, std::size_t first, std::size_t stride,
               int degree, std::array<R, kMostPoints>& low, std::array<R, kMostPoints>& high) {
    R work[kMaxPatchOrder];
    const auto at = [&](int k) { return first + static_cast<std::size_t>(k) * stride; };
    for (int k = 0; k <= degree; ++k) work[k] = from[at(k)];
    R scale = 1;
    for (int level = 0; level <= degree; ++level) {
        low[at(level)] = scale * work[0];
        high[at(degree - level)] = scale * work[degree - level];
        for (int k = 0; k < degree - level; ++k) work[k] += work[k + 1];
        scale *= R(0.5);
    }
}

template <class R>
void halve(const LineNet<R>& net, bool along_u, LineNet<R>& low, LineNet<R>& high) {
    low.n = high.n = net.n;
    low.m = high.m = net.m;
    const int rows = along_u ? net.m : net.n, degree = along_u ? net.n : net.m;
    const auto width = static_cast<std::size_t>(net.m + 1);
    for (int r = 0; r <= rows; ++r) {
        const std::size_t first = static_cast<std::size_t>(r) * (along_u ? 1 : width);
        const std::size_t stride = along_u ? width : 1;
        halve_row(net.x, first, stride, degree, low.x, high.x);
        halve_row(net.y, first, stride, degree, low.y, high.y);
    }
}

/// The line and two planes through it, in 113 bits.
struct ExactFrame {
    Vec3Of<Real128> origin, direction, a, b;

    explicit ExactFrame(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
        const auto cross = [](const Vec3Of<Real128>& p, const Vec3Of<Real128>& q) {
            return Vec3Of<Real128>{p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z,
                                   p.x * q.y - p.y * q.x};
        };
        const auto unit = [](const Vec3Of<Real128>& p) {
            return (Real128(1) / square_root(dot(p, p))) * p;
        };
        const Vec3 size = abs(ray.direction);
        const Vec3Of<Real128> aside = size.x <= size.y && size.x <= size.z
                                          ? Vec3Of<Real128>{1, 0, 0}
                                      : size.y <= size.z ? Vec3Of<Real128>{0, 1, 0}
                                                         : Vec3Of<Real128>{0, 0, 1};
        a = unit(cross(direction, aside));
        b = unit(cross(direction, a));
    }

    [[nodiscard]] Vec3Of<Real128> offset(const HomogeneousPoint& p) const {
        const Real128 w = p.w;
        return {p.x - w * origin.x, p.y - w * origin.y, p.z - w * origin.z};
    }
};

inline LineNet<Real128> exact_net(const BezierNet& net, const ExactFrame& frame) {
    LineNet<Real128> out;
    out.n = net.degree_u;
    out.m = net.degree_v;
    for (std::size_t k = 0; k < out.count(); ++k) {
        const Vec3Of<Real128> p = frame.offset(net.points[k]);
        out.x[k] = dot(frame.a, p);
        out.y[k] = dot(frame.b, p);
    }
    return out;
}

inline LineNet<double> rounded_net(const BezierNet& net, const ExactFrame& frame) {
    const auto vec = [](const Vec3Of<Real128>& v) {
        return Vec3{static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
    };
    const Vec3 a = vec(frame.a), b = vec(frame.b), origin = vec(frame.origin);
    LineNet<double> out;
    out.n = net.degree_u;
    out.m = net.degree_v;
    for (std::size_t k = 0; k < out.count(); ++k) {
        const HomogeneousPoint& p = net.points[k];
        const Vec3 offset = Vec3{p.x, p.y, p.z} - p.w * origin;
        out.x[k] = dot(a, offset);
        out.y[k] = dot(b, offset);
    }
    return out;
}

/// The result of the control points of a cell, in units of half its widths.
struct CellProof {
    enum class Answer { None, OneToOne, Divide, Unknown } answer = Answer::Divide;
    bool along_u = true;
};

/// Examines a cell. `noise`: bound of the rounding errors of a control point.
template <class R>
CellProof prove(const LineNet<R>& net, double noise) {
    using Answer = CellProof::Answer;
    std::array<double, kMostPoints> x, y;
    double lo_x = 1e300, hi_x = -1e300, lo_y = 1e300, hi_y = -1e300, most = 0;
    for (std::size_t k = 0; k < net.count(); ++k) {
        x[k] = static_cast<double>(net.x[k]);
        y[k] = static_cast<double>(net.y[k]);
        lo_x = std::min(lo_x, x[k]), hi_x = std::max(hi_x, x[k]);
        lo_y = std::min(lo_y, y[k]), hi_y = std::max(hi_y, y[k]);
        most = std::max({most, std::abs(x[k]), std::abs(y[k])});
    }
    noise += 0x1p-50 * most;  // of the conversion to double, and of the differences
    if (lo_x > noise || hi_x < -noise || lo_y > noise || hi_y < -noise) return {Answer::None};
    const int n = net.n, m = net.m;
    const auto mean = [&](const std::array<double, kMostPoints>& f, bool along_u) {
        const double corner[4] = {f[net.index(0, 0)], f[net.index(0, m)], f[net.index(n, 0)],
                                  f[net.index(n, m)]};
        return along_u ? 0.25 * (corner[2] + corner[3] - corner[0] - corner[1])
                       : 0.25 * (corner[1] + corner[3] - corner[0] - corner[2]);
    };
    const double x_u = mean(x, true), x_v = mean(x, false);
    const double y_u = mean(y, true), y_v = mean(y, false);
    const double det = x_u * y_v - x_v * y_u;
    double widest[2] = {0, 0};
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            const auto change = [&](std::size_t p, std::size_t q) {
                return std::abs(x[p] - x[q]) + std::abs(y[p] - y[q]);
            };
            if (i < n) {
                widest[0] = std::max(widest[0], change(net.index(i, j), net.index(i + 1, j)));
            }
            if (j < m) {
                widest[1] = std::max(widest[1], change(net.index(i, j), net.index(i, j + 1)));
            }
        }
    }
    const bool along_u = n * widest[0] >= m * widest[1];
    if (std::max(widest[0], widest[1]) <= 4.0 * noise) return {Answer::Unknown, along_u};
    if (!(std::abs(det) > 0)) return {Answer::Divide, along_u};
    const double i_ux = y_v / det, i_uy = -x_v / det, i_vx = -y_u / det, i_vy = x_u / det;
    const double gain = std::max(std::abs(i_ux) + std::abs(i_uy), std::abs(i_vx) + std::abs(i_vy));
    const double unsure = gain * noise + 0x1p-45 * gain * most;
    double lo_a = 1e300, hi_a = -1e300, lo_b = 1e300, hi_b = -1e300;
    for (std::size_t k = 0; k < net.count(); ++k) {
        const double a = i_ux * x[k] + i_uy * y[k], b = i_vx * x[k] + i_vy * y[k];
        lo_a = std::min(lo_a, a), hi_a = std::max(hi_a, a);
        lo_b = std::min(lo_b, b), hi_b = std::max(hi_b, b);
    }
    if (lo_a > unsure || hi_a < -unsure || lo_b > unsure || hi_b < -unsure) return {Answer::None};
    double a_u = 0, a_v = 0, b_u = 0, b_v = 0;  // largest differences from the identity
    const auto larger = [](double& to, double value) { to = std::max(to, std::abs(value)); };
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= m; ++j) {
            const std::size_t k = net.index(i, j);
            if (i < n) {
                const std::size_t q = net.index(i + 1, j);
                const double dx = 0.5 * n * (x[q] - x[k]), dy = 0.5 * n * (y[q] - y[k]);
                larger(a_u, i_ux * dx + i_uy * dy - 1.0);
                larger(b_u, i_vx * dx + i_vy * dy);
            }
            if (j < m) {
                const std::size_t q = net.index(i, j + 1);
                const double dx = 0.5 * m * (x[q] - x[k]), dy = 0.5 * m * (y[q] - y[k]);
                larger(a_v, i_ux * dx + i_uy * dy);
                larger(b_v, i_vx * dx + i_vy * dy - 1.0);
            }
        }
    }
    const bool one = std::max(a_u + a_v, b_u + b_v) + 16.0 * unsure < kContraction;
    return {one && unsure < kMostNoise ? Answer::OneToOne : Answer::Divide, along_u};
}

}  // namespace alhazen
