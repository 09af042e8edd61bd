#pragma once
/// What a shape must offer, and what it answers about a point on it.
///
/// A shape is a plain struct that describes a surface in its own frame. It knows neither materials
/// nor transforms nor file formats. To add one: docs in CONTRIBUTING.md. Conventions: `intersect`
/// works on un-normalised rays; it writes every crossing with t in [ray.t_min, ray.t_max] in
/// ascending order of t, at most `kMaxHits`. The nearest crossing, any crossing and all crossings
/// are all read from that one list, so they cannot disagree. A tangent ray may be reported as two
/// equal crossings or none, never as one (for closed shapes the count is even). Threads: const
/// functions may be called from many threads.

#include <array>
#include <concepts>
#include <span>
#include <vector>

#include "alhazen/base/diagnostics.h"
#include "alhazen/geometry/box.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/math/interval.h"

namespace alhazen {

/// The surface at a crossing, in the shape's frame.
struct ShapeSurface {
    Vec3 point;           ///< on the surface: re-projected, not merely origin + t * direction
    Vec3 normal;          ///< unit geometric normal; outward for a closed shape
    Vec3 shading_normal;  ///< unit; equal to `normal` unless the shape interpolates normals
    Vec2 uv;              ///< texture coordinates
    Vec3 dpdu, dpdv;      ///< change of the point by u and by v; zero where there is none
    Vec3 error;           ///< bound of |point - true point on the surface|, component by component
};

template <class S>
concept Shape = requires(S& fresh, const S& shape, const Ray& ray, ShapeHit* hits,
                         const ShapeHit& hit, const Vec3& axis, const FileLocation& where,
                         Diagnostics& diagnostics) {
    { S::kMaxHits } -> std::convertible_to<int>;
    { S::kName } -> std::convertible_to<const char*>;  // as in scene files: "sphere"
    { S::kClosed } -> std::convertible_to<bool>;       // could bound a volume whatever its options
    /// Sets derived fields. Called once, after the public fields are set and validated, before any
    /// query.
    { fresh.prepare() } -> std::same_as<void>;
    /// Reports every way in which the fields make no such shape (NaN, zero radius, ...).
    { shape.validate(where, diagnostics) } -> std::same_as<void>;
    /// True when this instance bounds a volume (a cylinder without caps does not).
    { shape.closed() } -> std::same_as<bool>;
    /// Holds the shape, rounded outward; infinite along an axis where the shape is.
    { shape.box() } -> std::same_as<Box3>;
    /// Range of dot(axis, p) over the shape, rounded outward.
    { shape.extent(axis) } -> std::same_as<Interval>;
    { shape.intersect(ray, hits) } -> std::same_as<int>;
    { shape.surface(ray, hit) } -> std::same_as<ShapeSurface>;
};

}  // namespace alhazen
