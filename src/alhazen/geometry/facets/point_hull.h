#pragma once
/// The corners of the convex hull of points, or of a polytope around it with few corners.
///
/// Source: Kallay, "The Complexity of Incremental Convex Hull Algorithms in R^d", Information
/// Processing Letters 19, 1984 (points one after the other, each sees some of the faces); Kay and
/// Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986 (slabs of given normals).
/// Differs: a hull of more than `most` corners, or of many more points, is replaced by the polytope
/// of 26 planes around it, whose corners are the faces of the hull of the dual points.
/// Conventions: no point lies farther outside the result than 1e-9 times the extent of the points.
/// Complexity: O(n) and O(most^2).

#include <cstddef>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// Replaces points by the corners.
void reduce_to_hull(std::vector<Vec3>& points, std::size_t most);

}  // namespace alhazen
