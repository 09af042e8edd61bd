#pragma once
/// The normal of the plane of a polygon of one or several loops.
///
/// Source: Newell's sum (Foley, van Dam et al., "Computer Graphics", section 11.1.3).
/// Differs: where parts of opposite orientation cancel in the sum, as in a bow tie, so that it is
/// due to vertices off the plane, the normal is that of a triangle of the vertices.
/// Conventions: `loop_ends`: one past the last vertex of each loop; empty: one loop. Normals are
/// not unit vectors. Precondition: there is a vertex. Complexity: O(vertices).

#include <cstdint>
#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Newell's normal: the sum over the edges of (a - origin) x (b - origin), where the origin is the
/// first vertex; its length is twice the signed area.
[[nodiscard]] Vec3 loops_normal(std::span<const Vec3> vertices,
                                std::span<const std::uint32_t> loop_ends);

/// Of the triangles of the first vertex and the one farthest from it, twice the vector area of the
/// largest.
[[nodiscard]] Vec3 largest_triangle(std::span<const Vec3> vertices);

/// Along the normal: Newell's, or where that is due to vertices off the plane, the largest
/// triangle's. No plane is many times nearer to the vertices than that triangle's.
[[nodiscard]] Vec3 plane_normal(std::span<const Vec3> vertices,
                                std::span<const std::uint32_t> loop_ends);

}  // namespace alhazen
