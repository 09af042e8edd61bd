#pragma once
/// The corners of small convex bodies, for drawings.

#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The points with normal . p <= offset.
struct HalfSpaceOfPoints {
    Vec3 normal;
    double offset = 0;
};

/// Every point where three of the planes meet and none of the half-spaces is left by more than
/// rounding. O(n^4): for some dozens of planes. Empty when the body is unbounded or empty.
[[nodiscard]] std::vector<Vec3> plane_corners(std::span<const HalfSpaceOfPoints> sides);

}  // namespace alhazen
