#pragma once
/// The convex hull of points in the plane.
///
/// Source: A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions",
/// Information Processing Letters 9, 1979.
/// Complexity: O(n log n).

#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The hull, counter-clockwise; fewer than three points if all are collinear.
[[nodiscard]] std::vector<Vec2> convex_outline(std::vector<Vec2> points);

}  // namespace alhazen
