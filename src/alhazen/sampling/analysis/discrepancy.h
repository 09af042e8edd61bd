#pragma once
/// Measures of how evenly points fill the unit square.
///
/// Source: Niederreiter, "Discrepancy and Convex Programming", Ann. Mat. Pura Appl. 93, 1972 (the
/// star discrepancy is reached at boxes through the coordinates of the points).
/// Complexity: O(n^2).

#include <span>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The star discrepancy: the largest difference, over all boxes with a corner at the origin,
/// between the area of the box and the fraction of points in it.
[[nodiscard]] double star_discrepancy(std::span<const Vec2> points);

/// The smallest distance of two points on the torus; 1 for fewer than two.
[[nodiscard]] double smallest_distance(std::span<const Vec2> points);

}  // namespace alhazen
