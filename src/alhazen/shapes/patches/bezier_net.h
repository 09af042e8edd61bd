#pragma once
/// A rational tensor product Bezier patch as its net of homogeneous control points.
///
/// Source: Farin, "Curves and Surfaces for CAGD", 5th ed., Morgan Kaufmann, 2002, chapters 13
/// (rational curves) and 14 (tensor product patches); de Casteljau's algorithm for values and
/// subdivision.
/// Conventions: points are u-major, [i * (degree_v + 1) + j] for u^i, v^j; u and v from 0 to 1.
/// Weights are positive, so that the patch lies in the convex hull of its control points. All
/// weights 1: a polynomial patch. Halving uses midpoints alone, thus a boundary depends only on its
/// own control points, and has the same bits read from either end.

#include <array>
#include <span>
#include <utility>

#include "alhazen/geometry/box.h"
#include "alhazen/math/vec.h"

namespace alhazen {

inline constexpr int kMaxPatchDegree = 7;
inline constexpr int kMaxPatchOrder = kMaxPatchDegree + 1;

/// The point (x / w, y / w, z / w).
struct HomogeneousPoint {
    double x = 0, y = 0, z = 0, w = 1;
    friend bool operator==(const HomogeneousPoint&, const HomogeneousPoint&) = default;
};

inline HomogeneousPoint operator+(const HomogeneousPoint& a, const HomogeneousPoint& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
inline HomogeneousPoint operator-(const HomogeneousPoint& a, const HomogeneousPoint& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
inline HomogeneousPoint operator*(double s, const HomogeneousPoint& a) {
    return {s * a.x, s * a.y, s * a.z, s * a.w};
}
inline HomogeneousPoint homogeneous(const Vec3& p, double w = 1.0) {
    return {w * p.x, w * p.y, w * p.z, w};
}
/// Precondition: w is not zero.
inline Vec3 projected(const HomogeneousPoint& p) {
    return p.w == 1.0 ? Vec3{p.x, p.y, p.z} : Vec3{p.x / p.w, p.y / p.w, p.z / p.w};
}

struct BezierNet {
    int degree_u = 3, degree_v = 3;  ///< 1 to kMaxPatchDegree
    std::array<HomogeneousPoint, kMaxPatchOrder * kMaxPatchOrder> points{};

    [[nodiscard]] int count() const { return (degree_u + 1) * (degree_v + 1); }
    HomogeneousPoint& at(int i, int j) {
        return points[static_cast<std::size_t>(i * (degree_v + 1) + j)];
    }
    [[nodiscard]] const HomogeneousPoint& at(int i, int j) const {
        return points[static_cast<std::size_t>(i * (degree_v + 1) + j)];
    }
};

/// A non-owning view of a net, for functions that only read it.
struct BezierView {
    int degree_u, degree_v;
    const HomogeneousPoint* points;
    bool plain;  ///< all weights are known to be 1

    BezierView(int u, int v, const HomogeneousPoint* first, bool without_weights = false)
        : degree_u(u), degree_v(v), points(first), plain(without_weights) {}
    BezierView(const BezierNet& net)  // NOLINT(google-explicit-constructor)
        : BezierView(net.degree_u, net.degree_v, net.points.data()) {}

    [[nodiscard]] int count() const { return (degree_u + 1) * (degree_v + 1); }
    [[nodiscard]] bool is_bicubic() const { return degree_u == 3 && degree_v == 3; }
    [[nodiscard]] const HomogeneousPoint& at(int i, int j) const {
        return points[i * (degree_v + 1) + j];
    }
};

/// A net from points and weights, u-major; without weights all are 1. Preconditions: (degree_u + 1)
/// * (degree_v + 1) points, and as many weights or none.
[[nodiscard]] BezierNet bezier_net(int degree_u, int degree_v, std::span<const Vec3> points,
                                   std::span<const double> weights = {});

/// A point of the patch with its derivatives by u and v.
struct PatchPoint {
    Vec3 point;
    Vec3 du, dv;
};
[[nodiscard]] Vec3 point_at(BezierView net, double u, double v);
[[nodiscard]] PatchPoint derivatives_at(BezierView net, double u, double v);
/// The unit normal du x dv; where that is zero (an edge that is one point, coincident control
/// points) the limit from inside the patch. Zero for a patch without area.
[[nodiscard]] Vec3 patch_normal(BezierView net, double u, double v);

/// Two halves at u = 1/2 or v = 1/2, by midpoints.
[[nodiscard]] std::pair<BezierNet, BezierNet> halved_u(const BezierNet& net);
[[nodiscard]] std::pair<BezierNet, BezierNet> halved_v(const BezierNet& net);
/// The part over [u0, u1] x [v0, v1], as a patch over the unit square.
[[nodiscard]] BezierNet part_of(const BezierNet& net, double u0, double u1, double v0, double v1);
[[nodiscard]] BezierNet transposed(const BezierNet& net);

/// The four boundary curves in order: v = 0, u = 1, v = 1, u = 0; each towards rising parameters.
/// Returns its number of points, written to `curve`.
int boundary_curve(BezierView net, int side, std::array<HomogeneousPoint, kMaxPatchOrder>& curve);

/// Contains the control points, and thus the patch; not rounded outward.
[[nodiscard]] Box3 control_box(BezierView net);

/// Area, and flux volume (a third of the integral of P . (Pu x Pv)), by Gauss quadrature in
/// adaptively halved parts to the relative error of about 1e-12. The flux volume of a closed set of
/// patches is the volume that they enclose, positive where du x dv points outward.
struct PatchMeasures {
    double area = 0, flux_volume = 0;
};
[[nodiscard]] PatchMeasures measures_of(const BezierNet& net);

}  // namespace alhazen
