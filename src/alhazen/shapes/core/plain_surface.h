#pragma once
/// The surface of a shape without texture coordinates, which take longer than all the rest.
///
/// Conventions: the bits of `surface`, but for uv, dpdu and dpdv, which are zero. A shape declares
/// `ShapeSurface plain_surface(const S&, const Ray&, const ShapeHit&)` in its own header.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

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
