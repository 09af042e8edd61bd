#pragma once
/// The derivative of the shading normal by the surface point.
///
/// Source: do Carmo, "Differential Geometry of Curves and Surfaces", 1976, section 3.2 (the
/// differential of the Gauss map). Transforms: Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
/// Differs: exact for spheres, flat shapes, circular cylinders, quadrics, and triangles with and
/// without vertex normals, under any affine placement; for other shapes by central differences of
/// the exact normals of neighbouring points.
/// Conventions: a matrix K with dn = K dp for steps dp in the tangent plane, where n is the
/// surface's `shading_normal`. At edges it is that of one of the sides.
/// Threads: free functions.

#include <optional>

#include "alhazen/math/affine.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

/// `ray` found `hit` in `aggregate`, where the surface is `surface`. Empty if there is no
/// derivative.
[[nodiscard]] std::optional<Mat3> normal_change(const Aggregate& aggregate, const Ray& ray,
                                                const Hit& hit, const Surface& surface, float time);

/// The same by differences only.
[[nodiscard]] std::optional<Mat3> normal_change_by_differences(const Aggregate& aggregate,
                                                               const Ray& ray, const Hit& hit,
                                                               const Surface& surface, float time);

}  // namespace alhazen
