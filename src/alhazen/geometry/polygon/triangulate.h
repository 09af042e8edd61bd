#pragma once
/// Triangulates a planar polygon, convex or not, on its own vertices.
///
/// Source: the ear clipping of ear_clipper.h and, for concave polygons of more than 4096 vertices,
/// the sweep of sweep_triangulation.h.
/// Differs: a convex polygon is a fan; a large polygon that the sweep refuses, as it touches or
/// crosses itself, is left to ear clipping.
/// Conventions: the polygon is projected along the axis in which its Newell normal is longest;
/// triangles keep its orientation. n vertices always give n - 2 triangles, also where the polygon
/// touches or crosses itself, so that edges shared with neighbours stay shared. A polygon with a
/// coordinate that is not finite is a fan.
/// Complexity and threads: O(n) for convex polygons, O(n log n) for simple ones of more than 4096
/// vertices, a bounded number of steps per vertex for all others (ear_clipper.h); no state.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Sum of the cross products of successive vertices: twice the area along the polygon's normal.
[[nodiscard]] Vec3 newell_normal(std::span<const Vec3> positions,
                                 std::span<const std::uint32_t> polygon);

/// Appends the triangles of `polygon`, a loop of indices into `positions` (all in range, at least
/// 3).
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alhazen
