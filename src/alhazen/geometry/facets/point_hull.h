#pragma once
/// Reduces points to the corners of their convex hull, or of an enclosing polytope with few
/// corners.
///
/// Source: Kallay, "The Complexity of Incremental Convex Hull Algorithms in R^d", Information
/// Processing Letters 19, 1984 (points are added one by one; each sees some of the faces); Kay and
/// Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs of given normals).
/// Differs: a hull of more than `most` corners, or of many more points, is replaced by the
/// enclosing polytope of 26 planes, whose corners are the faces of the hull of the dual points.
/// Conventions: no point lies farther outside the result than 1e-9 times the extent of the points.
/// Complexity: O(n) and O(most^2).

#include <cstddef>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Replaces the points by the corners.
void reduce_to_hull(std::vector<Vec3>& points, std::size_t most);

}  // namespace alhazen
