#pragma once
/// The surface of a shape without texture coordinates, which are the most expensive part.
///
/// Conventions: the bits of `surface`, except uv, dpdu and dpdv, which are zero. A shape declares
/// `ShapeSurface plain_surface(const S&, const Ray&, const ShapeHit&)` in its own header.

#include "alhazen/shapes/core/shape.h"

namespace alhazen {

/// For any shape; computes texture coordinates only where the shape has no `plain_surface`.
template <Shape S>
[[nodiscard]] inline ShapeSurface surface_of_shape(const S& shape, const Ray& ray,
                                                   const ShapeHit& hit, bool with_uv) {
    if constexpr (requires { plain_surface(shape, ray, hit); }) {
        if (!with_uv) return plain_surface(shape, ray, hit);
    }
    return shape.surface(ray, hit);
}

}  // namespace alhazen
