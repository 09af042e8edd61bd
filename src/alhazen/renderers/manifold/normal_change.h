#pragma once
/// How the shading normal changes along a surface: its derivative by the point.
///
/// Source: do Carmo, "Differential Geometry of Curves and Surfaces", 1976, section 3.2 (the
/// differential of the Gauss map). Transforms: Igehy, "Tracing Ray Differentials", SIGGRAPH 1999.
/// Differs: exact for spheres, what is flat, round cylinders, quadrics, and triangles with and
/// without normals at their vertices, under any affine placement; of all other shapes by central
/// differences of the exact normals of neighbouring points.
/// Conventions: a matrix K with dn = K dp for steps dp in the tangent plane, n = the
/// `shading_normal` of the surface as it is given. At edges it is that of one of the sides.
/// Threads: free functions.

#include <optional>

#include "alhazen/math/affine.h"
#include "alhazen/primitives/surface.h"

namespace alhazen {

/// `ray` found `hit` in `aggregate`, and `surface` is there.
[[nodiscard]] std::optional<Mat3> normal_change(const Aggregate& aggregate, const Ray& ray,
                                                const Hit& hit, const Surface& surface, float time);

/// The same by differences alone.
[[nodiscard]] std::optional<Mat3> normal_change_by_differences(const Aggregate& aggregate,
                                                               const Ray& ray, const Hit& hit,
                                                               const Surface& surface, float time);

}  // namespace alhazen
