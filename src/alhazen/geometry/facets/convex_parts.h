#pragma once
/// Convex pieces of a planar polygon of several loops.
///
/// Source: Eberly, "Triangulation by Ear Clipping", 2002 (bridges between holes and outlines).
/// Differs: a bridge is the shortest one from the rightmost corner of a hole that crosses no edge.
/// Conventions: inside by the odd-even rule. A convex polygon is its own piece; others are cut into
/// triangles on their own corners. Pieces run counter-clockwise around `normal`.
/// Complexity: O(n) for convex polygons, that of triangulate.h for one loop, O(holes * n^2) at most
/// for several.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// `loop_ends`: one past the last corner of each loop; empty: one loop.
[[nodiscard]] std::vector<std::vector<Vec3>> convex_parts(std::span<const Vec3> corners,
                                                          std::span<const std::uint32_t> loop_ends,
                                                          const Vec3& normal);

/// Whether one loop is its own convex piece.
[[nodiscard]] bool is_convex_loop(std::span<const Vec3> corners, const Vec3& normal);

}  // namespace alhazen
