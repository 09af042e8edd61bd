#pragma once
/// Random shapes of each type for the conformance tests. Shapes without a specialisation here are
/// made by the units of their fields (shape_source.h).

#include <string>

#include "alhazen/shapes/shape_list.h"
#include "support/random_exact_shapes.h"
#include "support/random_patches.h"
#include "support/shape_source.h"

namespace alhazen::testing {

template <>
struct RandomShape<Disc> {
    static Disc make(const ShapeSource& from) {
        const double radius = from.length();
        return {.center = from.point(),
                .normal = from.vector(),
                .radius = radius,
                .inner_radius = from.random.coin() ? 0.0 : 0.5 * radius};
    }
};

template <>
struct RandomShape<Rectangle> {
    static Rectangle make(const ShapeSource& from) {
        for (;;) {
            const Rectangle r{
                .corner = from.point(), .edge_u = from.vector(), .edge_v = from.vector()};
            const double area = length(cross(r.edge_u, r.edge_v));
            if (area > 0.05 * length(r.edge_u) * length(r.edge_v)) return r;
        }
    }
};

template <>
struct RandomShape<BoxShape> {
    static BoxShape make(const ShapeSource& from) {
        const Vec3 lo = from.point();
        const double x = from.length();
        const double y = from.length();
        return {.lo = lo, .hi = lo + Vec3{x, y, from.length()}};
    }
};

template <>
struct RandomShape<Cylinder> {
    static Cylinder make(const ShapeSource& from) {
        const Vec3 base = from.point();
        return {.base = base,
                .top = base + from.vector(),
                .radius = from.length(),
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Cone> {
    static Cone make(const ShapeSource& from) {
        const Vec3 base = from.point();
        const int kind = from.random.below(4);
        return {.base = base,
                .top = base + from.vector(),
                .base_radius = kind == 0 ? 0.0 : from.length(),
                .top_radius = kind == 1 ? 0.0 : from.length(),
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Polygon> {
    /// A star around a point, in half of the cases with a hole; or an L along the axes.
    static Polygon make(const ShapeSource& from) {
        const Vec3 middle = from.point();
        Vec3 x{1, 0, 0}, y{0, 1, 0};
        if (from.lattice) {
            const int k = from.random.below(3);
            x = y = {};
            x[k] = from.length();
            y[(k + 1) % 3] = from.length();
            Polygon ell;
            for (const Vec2 c : {Vec2{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) {
                ell.vertices.push_back(middle + c.x * x + c.y * y);
            }
            return ell;
        }
        x = from.random.unit_vector();
        y = perpendicular(x);
        const double size = from.length();
        const int count = 3 + from.random.below(20);
        Polygon star;
        const int loops = from.random.coin() ? 1 : 2;
        for (int loop = 0; loop < loops; ++loop) {
            for (int i = 0; i < count; ++i) {
                const double angle = 2 * 3.14159265358979 * i / count;
                // With three corners only the inscribed circle of radius 1/2 is certainly inside.
                const double r = loop == 0 ? size * from.random.uniform(0.9, 1.5) : 0.2 * size;
                star.vertices.push_back(middle + r * std::cos(angle) * x + r * std::sin(angle) * y);
            }
            star.loop_ends.push_back(static_cast<std::uint32_t>(star.vertices.size()));
        }
        return star;
    }
};

template <>
struct RandomShape<Polyhedron> {
    /// A box as points, some of which may coincide; or planes around a point.
    static Polyhedron make(const ShapeSource& from) {
        const Vec3 middle = from.point();
        const double size = from.length();
        Random& random = from.random;
        if (from.lattice || random.coin()) {
            const double y = from.length(), z = from.length();
            std::array<Vec3, 8> p{Vec3{0, 0, 0}, {size, 0, 0}, {size, y, 0}, {0, y, 0},
                                  Vec3{0, 0, z}, {size, 0, z}, {size, y, z}, {0, y, z}};
            const int kind = random.below(3);
            if (kind >= 1) p[6] = p[5], p[7] = p[4];   // a wedge
            if (kind == 2) p[5] = p[6] = p[7] = p[4];  // a pyramid
            const Vec3 shear = from.lattice ? Vec3{} : random.in_cube(0.3);
            for (Vec3& v : p) v = middle + v + v.z * shear;
            return hexahedron(p);
        }
        Polyhedron solid;
        for (int k = 0; k < 3; ++k) {
            for (const double side : {-1.0, 1.0}) {
                Vec3 axis{};
                axis[k] = side;
                solid.planes.push_back({middle + size * axis, 3.0 * axis});
            }
        }
        for (int k = random.below(12); k > 0; --k) {
            const Vec3 n = random.unit_vector();
            solid.planes.push_back({middle + random.uniform(0.4, 1.5) * size * n, n});
        }
        return solid;
    }
};

template <class S>
S random_shape(const ShapeSource& from) {
    S shape = RandomShape<S>::make(from);
    shape.prepare();
    return shape;
}

}  // namespace alhazen::testing

#include "support/random_profiles.h"
