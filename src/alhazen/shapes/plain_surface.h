#pragma once
/// The surface of shapes without texture coordinates, which take longer than all the rest.
///
/// Source: the shapes' own `surface`. Differs: nothing. Conventions: the bits of `surface`, but for
/// uv, dpdu and dpdv, which are zero.

#include "alhazen/shapes/algebraic.h"
#include "alhazen/shapes/blob.h"
#include "alhazen/shapes/sphere.h"
#include "alhazen/shapes/torus.h"

namespace alhazen {

[[nodiscard]] ShapeSurface plain_surface(const Algebraic& shape, const Ray& ray,
                                         const ShapeHit& hit);
[[nodiscard]] ShapeSurface plain_surface(const Blob& shape, const Ray& ray, const ShapeHit& hit);
[[nodiscard]] ShapeSurface plain_surface(const Sphere& shape, const Ray& ray, const ShapeHit& hit);
[[nodiscard]] ShapeSurface plain_surface(const Torus& shape, const Ray& ray, const ShapeHit& hit);

/// For any shape, with texture coordinates or, where it can, without.
template <Shape S>
[[nodiscard]] inline ShapeSurface surface_of_shape(const S& shape, const Ray& ray,
                                                   const ShapeHit& hit, bool with_uv) {
    if constexpr (requires { plain_surface(shape, ray, hit); }) {
        if (!with_uv) return plain_surface(shape, ray, hit);
    }
    return shape.surface(ray, hit);
}

}  // namespace alhazen
