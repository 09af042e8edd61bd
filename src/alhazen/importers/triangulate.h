#pragma once
/// Cuts a planar polygon, convex or not, into triangles on its own vertices.
///
/// Source: Eberly, "Triangulation by Ear Clipping", Geometric Tools, 2002 (only reflex vertices are
/// tested; the state of an ear's two neighbours is renewed when it is cut off). Differs: a convex
/// polygon is a fan; a polygon without a true ear left (it crosses itself or has no area) is cut at
/// its least bad corner, so that n vertices always give n - 2 triangles and edges shared with
/// neighbours stay shared.
/// Conventions: the polygon is looked at along the axis in which its Newell normal is longest;
/// triangles keep its orientation. Complexity: O(n) for convex, O(n r) with r reflex vertices for
/// other polygons; const inputs, no state.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Concave polygons with more vertices are refused: their cost is quadratic.
inline constexpr std::size_t kMaxConcaveVertices = 4096;

/// Sum of the cross products of successive vertices: twice the area along the polygon's normal.
[[nodiscard]] Vec3 newell_normal(std::span<const Vec3> positions,
                                 std::span<const std::uint32_t> polygon);

/// Appends the triangles of `polygon`, a loop of indices into `positions` (all in range, at least
/// 3). False, and nothing appended, for a concave polygon of more than kMaxConcaveVertices
/// vertices.
[[nodiscard]] bool triangulate(std::span<const Vec3> positions,
                               std::span<const std::uint32_t> polygon,
                               std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace alhazen
