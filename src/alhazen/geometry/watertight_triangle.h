#pragma once
/// The watertight ray-triangle test: no ray passes between triangles that share an edge or a
/// vertex, and every line crosses a closed mesh an even number of times.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013 (the
/// shear that makes the ray the z axis); Edelsbrunner and Mücke, "Simulation of Simplicity", ACM
/// TOG 9(1), 1990 (ties).
/// Differs: (1) All in double. Rounding is monotone, so fl(ab) - fl(cd) never has the wrong sign,
/// it can only be a false zero; zeros (and only zeros) are resolved exactly by the rounding errors
/// of the two products. (2) A true zero, the ray through an edge, is resolved as if the ray were
/// displaced by (e, e^2), e -> 0, in the sheared plane. Each ray thus intersects a mesh in general
/// position: exactly one of the triangles around an edge or a vertex is hit, or both sheets of a
/// fold, or none. (3) The weights of a triangle seen nearly edge-on are computed precisely, so that
/// the point of the ray at t is within 2^-38 of the distances involved from the triangle: bounds
/// may rely on this.
/// Conventions: vertices shared by triangles must be equal bit for bit. A degenerate triangle and
/// one seen edge-on are never hit. Triangles are hit from both sides.

#include <algorithm>
#include <cmath>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/math/quadratic.h"

namespace alhazen {

/// The shear that maps a ray to the z axis; computed once per ray.
struct RayShear {
    int kx, ky, kz;
    double sx, sy, sz;

    explicit RayShear(const Vec3& direction) {
        kz = dominant_axis(direction);
        kx = kz == 2 ? 0 : kz + 1;
        ky = kx == 2 ? 0 : kx + 1;
        sx = direction[kx] / direction[kz];
        sy = direction[ky] / direction[kz];
        sz = 1.0 / direction[kz];
    }
};

#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

/// The sign of a b - c d, for products that, or whose rounding errors, may underflow.
inline int sign_of_tiny_difference(double a, double b, double c, double d) {
    if (a == 0.0 || b == 0.0 || c == 0.0 || d == 0.0) {
        const auto product_sign = [](double x, double y) {
            return ((x > 0.0) - (x < 0.0)) * ((y > 0.0) - (y < 0.0));
        };
        return product_sign(a, b) - product_sign(c, d);
    }
    int ea, eb, ec, ed;
    a = std::frexp(a, &ea);
    b = std::frexp(b, &eb);
    c = std::frexp(c, &ec);
    d = std::frexp(d, &ed);
    // Beyond 2^8 only the sign of the other product matters.
    b = std::ldexp(b, std::clamp(ea + eb - ec - ed, -8, 8));
    const double exact = difference_of_products(a, b, c, d);
    return (exact > 0.0) - (exact < 0.0);
}

/// The sign of the edge function with zeros resolved: exactly, then by the symbolic displacement. 0
/// only if a == b.
inline int resolved_edge_sign(const ShearedVertex<double>& a, const ShearedVertex<double>& b) {
    const auto sign = [](double x) { return (x > 0.0) - (x < 0.0); };
    const double p = a.x * b.y;
    const double q = a.y * b.x;
    if (p != q) return sign(p - q);
    const double exact = std::fma(a.x, b.y, -p) - std::fma(a.y, b.x, -q);
    if (exact != 0.0) return sign(exact);
    if (std::abs(p) < 0x1p-900) {
        const int tiny = sign_of_tiny_difference(a.x, b.y, a.y, b.x);
        if (tiny != 0) return tiny;
    }
    if (a.y != b.y) return sign(a.y - b.y);
    return sign(b.x - a.x);
}

/// The power of two that scales the largest of three magnitudes to about 1; 1 if all are 0.
inline double to_unit_size(double a, double b, double c) {
    const double largest = std::max({std::abs(a), std::abs(b), std::abs(c)});
    return largest > 0.0 ? std::ldexp(1.0, std::min(-std::ilogb(largest), 1000)) : 1.0;
}

/// The edge functions of triangle (a, b, c), accurate to the last digits, after scaling all x and
/// all y.
inline void precise_edge_functions(ShearedVertex<double> a, ShearedVertex<double> b,
                                   ShearedVertex<double> c, double scale_x, double scale_y,
                                   double& eu, double& ev, double& ew) {
    for (ShearedVertex<double>* v : {&a, &b, &c}) {
        v->x *= scale_x;
        v->y *= scale_y;
    }
    eu = difference_of_products(b.x, c.y, b.y, c.x);
    ev = difference_of_products(c.x, a.y, c.y, a.x);
    ew = difference_of_products(a.x, b.y, a.y, b.x);
}

/// Tests triangle (a, b, c); on a hit in [ray.t_min, ray.t_max] sets t, u (weight of b) and v
/// (weight of c).
inline bool intersect_triangle(const Ray& ray, const RayShear& shear, const Vec3& a, const Vec3& b,
                               const Vec3& c, ShapeHit& hit) {
    const auto shear_vertex = [&](const Vec3& p) {
        return sheared<double>(p[shear.kx], p[shear.ky], p[shear.kz], ray.origin[shear.kx],
                               ray.origin[shear.ky], ray.origin[shear.kz], shear.sx, shear.sy);
    };
    const ShearedVertex<double> va = shear_vertex(a);
    const ShearedVertex<double> vb = shear_vertex(b);
    const ShearedVertex<double> vc = shear_vertex(c);
    const TriangleEdges<double> edges(va, vb, vc);
    if (edges.missed()) return false;
    double eu = edges.u, ev = edges.v, ew = edges.w;
    if (eu == 0.0 || ev == 0.0 || ew == 0.0) {
        const int su = resolved_edge_sign(vb, vc);
        if (su == 0 || su != resolved_edge_sign(vc, va) || su != resolved_edge_sign(va, vb)) {
            return false;
        }
    }
    // Includes three false zeros; three true zeros cannot occur here.
    if (!edges.well_conditioned()) {
        precise_edge_functions(va, vb, vc, 1.0, 1.0, eu, ev, ew);
        // Only the ratios matter, but neither the values nor their products with lengths may
        // underflow.
        if (std::max({std::abs(eu), std::abs(ev), std::abs(ew)}) < 0x1p-300) {
            precise_edge_functions(va, vb, vc, to_unit_size(va.x, vb.x, vc.x),
                                   to_unit_size(va.y, vb.y, vc.y), eu, ev, ew);
            // A vertex may be far nearer to the ray than the others.
            const double unit = to_unit_size(eu, ev, ew);
            eu *= unit;
            ev *= unit;
            ew *= unit;
        }
    }
    const TriangleSolution<double> s = solve_triangle(eu, ev, ew, va.z, vb.z, vc.z, shear.sz);
    // Rejects NaN (all edge functions underflowed to zero).
    if (!ray.covers(s.t)) return false;
    hit = {s.t, s.u, s.v, 0};
    return true;
}

}  // namespace alhazen
