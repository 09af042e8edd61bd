#pragma once
/// All crossings of a line with a solid in 113 bits, computed from the definition of the shape by
/// other formulas than the ray tracer's.
///
/// Source: the definitions in the headers of the shapes.
/// Differs: written for any number type, and for simplicity. To add a shape, add an overload of
/// `exact_crossings` below or in a header exact_*.h of this folder; shapes without an overload are
/// not checked.
/// Conventions: crossings ascend, and each changes between inside and outside. They are infinite
/// where an unbounded solid has no end.

#include <concepts>

#include "alhazen/csg/csg_solid.h"
#include "alhazen/shapes/shape_list.h"
#include "alhazen/verification/exact_blob.h"
#include "alhazen/verification/exact_height_field.h"
#include "alhazen/verification/exact_polynomials.h"
#include "alhazen/verification/exact_superellipsoid.h"
#include "alhazen/verification/exact_swept.h"

namespace alhazen {

// ---- Formulas.

template <class R>
CrossingsOf<R> exact_crossings(const Sphere& sphere, const LineOf<R>& line) {
    const Vec3Of<R> f = line.origin - Vec3Of<R>(sphere.center);
    const R radius = sphere.radius;
    return {false, quadratic_roots<R>(dot(line.direction, line.direction), dot(f, line.direction),
                                      dot(f, f) - radius * radius)};
}

template <class R>
CrossingsOf<R> exact_crossings(const BoxShape& box, const LineOf<R>& line) {
    bool begun = false;
    R entry{}, exit{};
    for (int k = 0; k < 3; ++k) {
        const SlabOf<R> s = slab<R>(line.origin[k], line.direction[k], R(box.lo[k]), R(box.hi[k]));
        if (s.empty) return {};
        if (s.unlimited) continue;
        entry = begun && entry > s.lo ? entry : s.lo;
        exit = begun && exit < s.hi ? exit : s.hi;
        begun = true;
    }
    if (!(entry < exit)) return {};
    return {false, {entry, exit}};
}

/// Points whose height along the axis is in [0, 1] (base to top) and whose distance from the axis
/// is at most the radius, which is linear in the height.
template <class R>
CrossingsOf<R> exact_frustum(const Vec3& base, const Vec3& top, double base_radius,
                             double top_radius, const LineOf<R>& line) {
    const Vec3Of<R> axis = Vec3Of<R>(top) - Vec3Of<R>(base);
    const Vec3Of<R> w = line.origin - Vec3Of<R>(base);
    const Vec3Of<R>& d = line.direction;
    const R squared = dot(axis, axis);
    const R z0 = dot(w, axis) / squared, z1 = dot(d, axis) / squared;
    const SlabOf<R> ends = slab<R>(z0, z1, R(0), R(1), keeps_face(top - base));
    if (ends.empty) return {};
    const R growth = R(top_radius) - R(base_radius);
    const R r0 = R(base_radius) + growth * z0, r1 = growth * z1;
    // |w + t d|^2 - height^2 - radius^2 <= 0.
    const R a = dot(d, d) - z1 * z1 * squared - r1 * r1;
    const R b = dot(w, d) - z0 * z1 * squared - r0 * r1;
    const R c = dot(w, w) - z0 * z0 * squared - r0 * r0;
    const auto clipped = [&](R lo, R hi) -> CrossingsOf<R> {
        if (!ends.unlimited) {
            if (ends.lo > lo) lo = ends.lo;
            if (ends.hi < hi) hi = ends.hi;
        }
        if (!(lo < hi)) return {};
        return {false, {lo, hi}};
    };
    if (a > 0) {
        const std::vector<R> roots = quadratic_roots<R>(a, b, c);
        return roots.empty() ? CrossingsOf<R>{} : clipped(roots[0], roots[1]);
    }
    if (ends.unlimited) return {};  // along the planes of the ends a is not negative
    if (a == 0) {
        if (b == 0) return c <= 0 ? clipped(ends.lo, ends.hi) : CrossingsOf<R>{};
        const R root = -c / (2 * b);
        return b > 0 ? clipped(ends.lo, root) : clipped(root, ends.hi);
    }
    // The inside is outside the roots; the part beyond the apex lies outside the ends.
    const std::vector<R> roots = quadratic_roots<R>(a, b, c);
    if (roots.empty()) return clipped(ends.lo, ends.hi);
    const CrossingsOf<R> before = clipped(ends.lo, roots[0]);
    return before.t.empty() ? clipped(roots[1], ends.hi) : before;
}

template <class R>
CrossingsOf<R> exact_crossings(const Cylinder& c, const LineOf<R>& line) {
    return exact_frustum<R>(c.base, c.top, c.radius, c.radius, line);
}
template <class R>
CrossingsOf<R> exact_crossings(const Cone& c, const LineOf<R>& line) {
    return exact_frustum<R>(c.base, c.top, c.base_radius, c.top_radius, line);
}

template <class R>
CrossingsOf<R> exact_crossings(const HalfSpace& half, const LineOf<R>& line) {
    const Vec3Of<R> n(half.normal);
    const R rate = dot(n, line.direction);
    if (rate == 0) {
        const R height = dot(n, line.origin - Vec3Of<R>(half.point));
        return {height < 0 || (height == 0 && keeps_face(half.normal)), {}};
    }
    return {rate > 0, {dot(n, Vec3Of<R>(half.point) - line.origin) / rate}};
}

/// Uses the prepared faces: points and unit normals.
template <class R>
CrossingsOf<R> exact_crossings(const Polyhedron& solid, const LineOf<R>& line) {
    bool has_entry = false, has_exit = false;
    R entry{}, exit{};
    for (const OrientedPlane& face : solid.faces) {
        const Vec3Of<R> n(face.normal);
        const R rate = dot(n, line.direction);
        const R height = dot(n, line.origin - Vec3Of<R>(face.point));
        if (rate == 0) {
            if (!(height < 0 || (height == 0 && keeps_face(face.normal)))) return {};
            continue;
        }
        const R t = -height / rate;
        if (rate < 0) {
            if (!has_entry || t > entry) entry = t;
            has_entry = true;
        } else {
            if (!has_exit || t < exit) exit = t;
            has_exit = true;
        }
    }
    if (!has_entry || !has_exit || !(entry < exit)) return {};
    return {false, {entry, exit}};
}

template <class S>
concept HasExactCrossings = requires(const S& shape, const ExactLine& line) {
    { exact_crossings(shape, line) } -> std::same_as<ExactCrossings>;
};

// ---- Primitives of a table and solids made of them.

/// True if a closed shape has a formula; false for meshes and instances.
[[nodiscard]] bool has_exact_crossings(const PrimitiveTable& table, PrimitiveId id);
/// The crossings with a primitive in its stored placement. Precondition: has_exact_crossings.
[[nodiscard]] ExactCrossings exact_crossings(const PrimitiveTable& table, PrimitiveId id,
                                             const ExactLine& line);
/// True if all leaves have formulas.
[[nodiscard]] bool has_exact_crossings(const CsgSolid& solid);
/// Evaluates the expression between consecutive crossings of leaves; parts not longer than `least`
/// (in t) are omitted.
[[nodiscard]] ExactCrossings exact_crossings(const CsgSolid& solid, const ExactLine& line,
                                             Real128 least);

/// Removes spans and gaps not longer than `least`.
void drop_thin(ExactCrossings& crossings, Real128 least);

}  // namespace alhazen
