#pragma once
/// Triangulates a planar polygon, convex or not, on its own vertices.
///
/// Source: the ear clipping of ear_clipper.h and, for concave polygons of more than 1024 vertices,
/// the sweep of sweep_triangulation.h.
/// Differs: a convex polygon becomes a fan; a large polygon that the sweep rejects, because it
/// touches or crosses itself, is triangulated by ear clipping.
/// Conventions: the polygon is projected along the longest axis of its normal (polygon_plane.h);
/// triangles keep its orientation. n vertices always give n - 2 triangles, even if the polygon
/// touches or crosses itself, so that edges shared with neighbours stay shared. A polygon with a
/// non-finite coordinate becomes a fan.
/// Complexity and threads: O(n) for convex polygons, O(n log n) for simple ones of more than 1024
/// vertices, a bounded number of steps per vertex for all others (ear_clipper.h); no shared state.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Appends the triangles of `polygon`, a loop of at least 3 indices into `positions`. Precondition:
/// all indices are in range.
void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alhazen
