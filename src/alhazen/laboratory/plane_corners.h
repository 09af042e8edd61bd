#pragma once
/// The corners of small convex polyhedra, for drawings.

#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The points with normal . p <= offset.
struct HalfSpaceOfPoints {
    Vec3 normal;
    double offset = 0;
};

/// The points where three planes meet and that lie in all half-spaces up to rounding. O(n^4), for a
/// few dozen planes. Empty if the body is unbounded or empty.
[[nodiscard]] std::vector<Vec3> plane_corners(std::span<const HalfSpaceOfPoints> sides);

}  // namespace alhazen
