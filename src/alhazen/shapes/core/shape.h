#pragma once
/// The Shape concept, and the surface record at a crossing.
///
/// A shape is a plain struct that describes a surface in its own frame, without material, transform
/// or file format. To add one: CONTRIBUTING.md.
/// Conventions: `intersect` takes rays of any direction length and writes every crossing with t in
/// [ray.t_min, ray.t_max] (either may be infinite) in ascending order of t: at most `kMaxHits` into
/// an array, or any number into a ShapeHits where `kMaxHits` is `kManyHits`. Nearest, any and all
/// crossings are read from that list, and thus agree. A closed shape is a solid: along a line its
/// crossings alternate between entry and exit, regardless of their normals. A tangent ray has two
/// equal crossings or none, never one. A line crosses a bounded solid an even number of times; an
/// unbounded solid returns from `inside_at_minus_infinity` whether a line begins inside. Threads:
/// const functions may be called concurrently.

#include <array>
#include <concepts>
#include <span>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/geometry/box.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/math/interval.h"
#include "alhazen/shapes/core/fields.h"
#include "alhazen/shapes/core/shape_hits.h"

namespace alhazen {

/// The surface at a crossing, in the shape's frame.
struct ShapeSurface {
    Vec3 point;   ///< on the surface: re-projected, more accurate than origin + t * direction
    Vec3 normal;  ///< unit geometric normal; outward for a closed shape
    Vec3 shading_normal;  ///< unit; equal to `normal` unless the shape interpolates normals
    Vec2 uv;              ///< texture coordinates
    Vec3 dpdu, dpdv;      ///< derivatives of the point by u and by v; zero where undefined
    Vec3 error;           ///< bound of |point - true point on the surface|, per component
};

/// A shape with at most kMaxHits crossings; `intersect` returns their number.
template <class S>
concept WritesFewHits = S::kMaxHits >= 1 &&
                        S::kMaxHits <= kMaxShapeHits&& requires(const S& shape, const Ray& ray,
                                                                ShapeHit* hits) {
    { shape.intersect(ray, hits) } -> std::same_as<int>;
};

/// A shape with any number of crossings; `intersect` appends them to the list.
template <class S>
concept WritesManyHits = S::kMaxHits ==
                         kManyHits&& requires(const S& shape, const Ray& ray, ShapeHits& hits) {
    { shape.intersect(ray, hits) } -> std::same_as<void>;
};

/// A solid that may be unbounded.
template <class S>
concept UnboundedSolid = requires(const S& shape, const Ray& ray) {
    /// True if the line of the ray, regardless of its limits, is inside at t = -infinity.
    { shape.inside_at_minus_infinity(ray) } -> std::same_as<bool>;
};

template <class S>
concept Shape = requires(S& fresh, const S& shape, const Ray& ray, const ShapeHit& hit,
                         const Vec3& axis, const FileLocation& where, Diagnostics& diagnostics) {
    { S::kMaxHits } -> std::convertible_to<int>;
    { S::kName } -> std::convertible_to<const char*>;  // name in scene files: "sphere"
    {
        S::kClosed
        } -> std::convertible_to<bool>;  // whether the shape can bound a volume with some of its
                                         // options
    S::kFields;  // describing fields (fields.h); all other members are derived
    /// Sets the derived fields. Called once, after the public fields are set and validated and
    /// before any query.
    { fresh.prepare() } -> std::same_as<void>;
    /// Reports every invalid field or combination of fields (NaN, zero radius, ...).
    { shape.validate(where, diagnostics) } -> std::same_as<void>;
    /// True if this instance bounds a volume (a cylinder without caps does not).
    { shape.closed() } -> std::same_as<bool>;
    /// Contains the shape, rounded outward; infinite along the axes where the shape is unbounded.
    { shape.box() } -> std::same_as<Box3>;
    /// Range of dot(axis, p) over the shape, rounded outward.
    { shape.extent(axis) } -> std::same_as<Interval>;
    { shape.surface(ray, hit) } -> std::same_as<ShapeSurface>;
}
&&(WritesFewHits<S> || WritesManyHits<S>);

/// Appends the crossings of a shape of either kind.
template <Shape S>
inline void append_hits(const S& shape, const Ray& ray, ShapeHits& hits) {
    if constexpr (WritesManyHits<S>) {
        shape.intersect(ray, hits);
    } else {
        hits.grow(shape.intersect(ray, hits.room(S::kMaxHits)));
    }
}

/// True if the line of a ray is inside the solid at t = -infinity.
template <Shape S>
[[nodiscard]] inline bool inside_at_minus_infinity(const S& shape, const Ray& ray) {
    if constexpr (UnboundedSolid<S>) {
        return shape.inside_at_minus_infinity(ray);
    } else {
        return false;
    }
}

}  // namespace alhazen
