#pragma once
/// The plane of a polygon of one or several loops.
///
/// Source: Newell's sum, as in Sutherland, Sproull and Schumacker, "A Characterization of Ten
/// Hidden-Surface Algorithms", ACM Computing Surveys 6(1), 1974.
/// Differs: where parts of opposite orientation cancel, as in a bow tie, so that the sum is due to
/// corners off the plane or to rounding, the normal is that of the largest triangle of the first
/// corner and the one farthest from it. No plane is many times nearer to the corners than that.
/// Conventions: normals point to where the loops run counterclockwise from, and have no unit
/// length; those of loops that cancel point to either side. Coordinates are finite, their products
/// in the range of doubles.
/// Complexity and threads: O(corners), edges_cancel O(n log n); no shared state.

#include <cstdint>
#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Newell's normal of a loop of indices into `positions`: sum of the cross products of successive
/// corners, twice the signed area along the normal.
[[nodiscard]] Vec3 newell_normal(std::span<const Vec3> positions,
                                 std::span<const std::uint32_t> polygon);
/// The same over loops of consecutive vertices; `loop_ends`: [loop] one past its last vertex;
/// empty: one loop.
[[nodiscard]] Vec3 newell_normal_of_loops(std::span<const Vec3> vertices,
                                          std::span<const std::uint32_t> loop_ends);

/// Along the normal of the plane; zero only if all corners are on one line.
[[nodiscard]] Vec3 plane_normal(std::span<const Vec3> positions,
                                std::span<const std::uint32_t> polygon);
[[nodiscard]] Vec3 plane_normal_of_loops(std::span<const Vec3> vertices,
                                         std::span<const std::uint32_t> loop_ends);

/// Along the normal of the largest triangle of the first vertex and the one farthest from it.
[[nodiscard]] Vec3 largest_triangle(std::span<const Vec3> vertices);

/// True if every edge occurs an even number of times: by the odd-even rule nothing is inside.
[[nodiscard]] bool edges_cancel(std::span<const Vec3> vertices,
                                std::span<const std::uint32_t> loop_ends);

/// True if no vertex is farther from the plane through the first one than 1e-4 of the largest
/// coordinate of the others from there: in a file with few digits the polygon is meant to be flat.
[[nodiscard]] bool is_flat(std::span<const Vec3> vertices, const Vec3& unit_normal);

}  // namespace alhazen
