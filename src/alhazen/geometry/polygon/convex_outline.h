#pragma once
/// The convex hull of points of the plane.
///
/// Source: A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions",
/// Information Processing Letters 9, 1979.
/// Complexity: O(n log n).

#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Counter-clockwise; fewer than three points where all lie on a line.
[[nodiscard]] std::vector<Vec2> convex_outline(std::vector<Vec2> points);

}  // namespace alhazen
