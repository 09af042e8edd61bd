#pragma once
/// Random quadrics, tori and algebraic surfaces.

#include "support/shape_source.h"

namespace alhazen::testing {

/// Three vectors far from coplanar.
inline Mat3 random_axes(const ShapeSource& from) {
    for (;;) {
        if (from.lattice) {
            return {{from.length(), 0, 0}, {0, from.length(), 0}, {0, 0, from.length()}};
        }
        const double size = from.length();
        const auto axis = [&] {
            return size * from.random.log_uniform(0.3, 3) * from.random.unit_vector();
        };
        const Mat3 m{axis(), axis(), axis()};
        const double volume = length(m.x_axis) * length(m.y_axis) * length(m.z_axis);
        if (std::abs(determinant(m)) > 0.3 * volume) return m;
    }
}

template <>
struct RandomShape<Ellipsoid> {
    static Ellipsoid make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        return {.center = from.point(),
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .axis_c = axes.z_axis};
    }
};

template <>
struct RandomShape<EllipticCylinder> {
    static EllipticCylinder make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const Vec3 base = from.point();
        return {.base = base,
                .top = base + axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<EllipticCone> {
    static EllipticCone make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const Vec3 base = from.point();
        return {.base = base,
                .top = base + axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .top_scale = from.random.coin() ? 0.0 : from.random.log_uniform(0.2, 2),
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Tgc> {
    static Tgc make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        // No ends without area: they have edges with two normals (tgc_test.cpp).
        const auto scale = [&] {
            return from.lattice ? 0.5 * (1 + from.random.below(4))
                                : from.random.log_uniform(0.3, 2);
        };
        return {.base = from.point(),
                .height = axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .axis_c = scale() * axes.x_axis,
                .axis_d = scale() * axes.y_axis,
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Torus> {
    static Torus make(const ShapeSource& from) {
        const double major = from.length();
        return {
            .center = from.point(),
            .axis = from.vector(),
            .major_radius = major,
            .minor_radius = from.lattice ? 0.5 * major : major * from.random.log_uniform(0.02, 1)};
    }
};

template <>
struct RandomShape<Paraboloid> {
    static Paraboloid make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const Vec3 apex = from.point();
        return {.apex = apex,
                .rim = apex + axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Hyperboloid> {
    static Hyperboloid make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const Vec3 base = from.point();
        return {.base = base,
                .top = base + axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .waist = from.random.uniform(0.1, 0.9),
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<TwoSheetHyperboloid> {
    static TwoSheetHyperboloid make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const Vec3 base = from.point();
        return {.base = base,
                .top = base + axes.z_axis,
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .gap = from.random.uniform(0.1, 0.6),
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Quadric> {
    /// Any signature and thus any kind; mostly clipped by a box, sometimes also by planes.
    static Quadric make(const ShapeSource& from) {
        Random& random = from.random;
        const auto number = [&] {
            return from.lattice ? 0.5 * (random.below(5) - 2) : random.uniform(-1, 1);
        };
        const auto three = [&] { return Vec3{number(), number(), number()}; };
        Quadric s{.squares = three(),
                  .products = from.lattice ? Vec3{} : three(),
                  .linear = three(),
                  .constant = 2.0 * number()};
        if (s.squares == Vec3{} && s.linear == Vec3{}) s.squares.x = 1.0;
        if (random.below(4) != 0) {
            const double size = from.lattice ? 2.0 : random.uniform(1, 4);
            s.clip_box = {{-size, -size, -size}, {size, size, size}};
        }
        for (int k = random.below(3); k > 0; --k) {
            s.clip_planes.push_back({from.vector(), random.uniform(0, 2)});
        }
        s.capped = random.below(4) != 0;
        return s;
    }
};

template <>
struct RandomShape<Algebraic> {
    static Algebraic make(const ShapeSource& from) {
        const char* expressions[] = {
            "x^2 + y^2 + z^2 - 1",
            "x^4 + y^4 + z^4 - 1.5",
            "(x^2 + y^2 + z^2 + 0.75)^2 - 4*(x^2 + y^2) - 0.1*x*y*z",
            "x^2 + y^3 - z^5 + 0.25*x*y - 0.3",
            "x^6 + y^6 + z^6 - x^2*y^2*z^2 - 1",
            "2*x - y + 0.25*z - 0.1",
            "x^2*y + y^2*z + z^2*x - 0.5",
        };
        const double size = from.lattice ? 1.5 : from.random.uniform(0.8, 2.5);
        return {.expression = expressions[from.random.below(7)],
                .clip_box = {{-size, -1.25 * size, -size}, {size, size, 1.5 * size}},
                .capped = from.random.below(4) != 0};
    }
};

template <>
struct RandomShape<Superellipsoid> {
    /// No exponents above 2, whose shapes have edges with two normals, and none close to a box,
    /// whose rounded edges are smaller than the steps of the tests.
    static Superellipsoid make(const ShapeSource& from) {
        const Mat3 axes = random_axes(from);
        const auto exponent = [&] {
            return from.lattice ? 0.5 * (1 + from.random.below(3))
                                : from.random.log_uniform(0.5, 1.6);
        };
        return {.center = from.point(),
                .axis_a = axes.x_axis,
                .axis_b = axes.y_axis,
                .axis_c = axes.z_axis,
                .east = exponent(),
                .north = exponent()};
    }
};

}  // namespace alhazen::testing
