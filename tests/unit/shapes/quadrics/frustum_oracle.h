#pragma once
/// Cylinders and cones in quadruple precision by the textbook formulas.

#include <algorithm>

#include "alhazen/geometry/ray.h"
#include "support/quad.h"

namespace alhazen::testing {

struct ExactFrustum {
    QuadVec base, axis;
    Quad height, base_radius, slope;

    ExactFrustum(const Vec3& from, const Vec3& to, double radius, double top_radius)
        : base(from),
          axis(normalize(QuadVec(to) - QuadVec(from))),
          height(length(QuadVec(to) - QuadVec(from))),
          base_radius(radius),
          slope((Quad(top_radius) - Quad(radius)) / height) {}

    /// Interval of a line inside the solid, for a line that is neither grazing nor parallel to a
    /// generator.
    struct Span {
        bool hit;
        bool clear;  ///< far enough from special cases to be compared
        double entry, exit;
    };
    Span span(const Ray& ray) const {
        const QuadVec o = QuadVec(ray.origin) - base, d(ray.direction);
        const Quad oz = dot(o, axis), dz = dot(d, axis);
        const Quad r = base_radius + slope * oz, dr = slope * dz;
        const Quad a = dot(d, d) - dz * dz - dr * dr;
        const Quad b = dot(o, d) - oz * dz - r * dr;
        const Quad c = dot(o, o) - oz * oz - r * r;
        const Quad disc = b * b - a * c;
        const Quad dd = dot(d, d);
        const Quad clearance = Quad(1e-6);
        if (magnitude(a) < clearance * dd || magnitude(dz) < clearance ||
            magnitude(disc) < clearance * dd * base_radius * base_radius) {
            return {false, false, 0, 0};
        }
        const Quad cap0 = -oz / dz, cap1 = (height - oz) / dz;
        Quad entry = std::min(cap0, cap1), exit = std::max(cap0, cap1);
        if (disc < 0) return {false, true, 0, 0};
        const Quad root = square_root(disc);
        const Quad t0 = std::min((-b - root) / a, (-b + root) / a);
        const Quad t1 = std::max((-b - root) / a, (-b + root) / a);
        if (a > 0) {
            if (r + (t0 + t1) / 2 * dr < 0) return {false, true, 0, 0};
            entry = std::max(entry, t0);
            exit = std::min(exit, t1);
        } else if (dr > 0) {
            entry = std::max(entry, t1);
        } else {
            exit = std::min(exit, t0);
        }
        return {entry<exit, magnitude(exit - entry)> clearance, static_cast<double>(entry),
                static_cast<double>(exit)};
    }

    /// Distance of a point from the surface `part`, along its normal.
    double distance(const Vec3& p, std::uint32_t part) const {
        const QuadVec q = QuadVec(p) - base;
        const Quad z = dot(q, axis);
        if (part == 1) return static_cast<double>(magnitude(z));
        if (part == 2) return static_cast<double>(magnitude(z - height));
        const Quad across = length(q - z * axis);
        return static_cast<double>(magnitude(across - base_radius - slope * z) /
                                   square_root(1 + slope * slope));
    }
};

}  // namespace alhazen::testing
