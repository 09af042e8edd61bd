#pragma once
/// Divides a planar polygon of several loops into convex pieces.
///
/// Source: Eberly, "Triangulation by Ear Clipping", 2002 (bridges between holes and outlines).
/// Differs: the bridge of a hole starts at its rightmost corner and is the shortest that crosses no
/// edge.
/// Conventions: inside by the odd-even rule. A convex polygon is a single piece; others are cut
/// into triangles on their own corners. Pieces run counter-clockwise around `normal`.
/// Complexity: O(n) for convex polygons, that of triangulate.h for one loop, at most O(holes * n^2)
/// for several.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The convex pieces. `loop_ends`: one past the last corner of each loop; empty: one loop.
[[nodiscard]] std::vector<std::vector<Vec3>> convex_parts(std::span<const Vec3> corners,
                                                          std::span<const std::uint32_t> loop_ends,
                                                          const Vec3& normal);

/// True if the loop is a convex polygon.
[[nodiscard]] bool is_convex_loop(std::span<const Vec3> corners, const Vec3& normal);

}  // namespace alhazen
