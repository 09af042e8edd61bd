#pragma once
/// Corners of small convex bodies, and outlines of their projections, for drawings.
///
/// Source: A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions",
/// Information Processing Letters 9, 1979 (`convex_outline`).

#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The points with normal . p <= offset.
struct HalfSpaceOfPoints {
    Vec3 normal;
    double offset = 0;
};

/// Every intersection point of three planes that leaves no half-space by more than rounding.
/// O(n^4): for some dozens of planes. Empty when the body is unbounded or empty.
[[nodiscard]] std::vector<Vec3> convex_corners(std::span<const HalfSpaceOfPoints> sides);

/// The hull of points of the plane, counter-clockwise; fewer than three for collinear points.
[[nodiscard]] std::vector<Vec2> convex_outline(std::vector<Vec2> points);

}  // namespace alhazen
