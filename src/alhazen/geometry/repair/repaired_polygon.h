#pragma once
/// Converts any polygon to convex parts in one plane, repairing corners off the plane, loops that
/// cross, overlap or touch themselves and many holes; reports the repairs.
///
/// Conventions: inside by the odd-even rule. A polygon that triangles on its corners do not cover
/// exactly once, or with loops that overlap, or with several loops and many corners, is rounded to
/// a lattice of 2^25 steps across it; others keep their corners.
/// Refused are polygons with a corner farther off their plane than a hundredth of their size, and
/// non-convex ones with more than 20 000 corners, which would become as many slivers.
/// Complexity: O(n log n), except that of convex_parts.h for polygons of few corners.

#include <string>

#include "alhazen/geometry/facets/convex_parts.h"
#include "alhazen/geometry/facets/facet_pool.h"

namespace alhazen {

struct RepairedPolygon {
    std::vector<std::vector<Vec3>> parts;  ///< counter-clockwise around the plane's normal
    bool crosses = false;  ///< triangles or signed areas of the loops may not be the polygon's
    std::string mended;    ///< description of the repairs; empty: none
    std::string refused;   ///< reason for refusal; empty: not refused
};

[[nodiscard]] RepairedPolygon repaired_polygon(std::span<const Vec3> corners,
                                               std::span<const std::uint32_t> loop_ends,
                                               const FacetPlane& plane);

}  // namespace alhazen
