#pragma once
/// Any polygon as convex parts of one plane: corners off the plane, edges that cross or lie on each
/// other, and many holes are taken care of, and what was mended is told.
///
/// Conventions: inside by the odd-even rule. A polygon whose edges cross, or one of several loops
/// and many corners, is rounded to a lattice of 2^25 steps across it; others keep their corners.
/// Refused are polygons with a corner farther off their plane than a hundredth of their size, and
/// those that are not convex and have more than 20 000 corners: each would be as many slivers.
/// Complexity: O(n log n), but that of convex_parts.h for polygons of few corners.

#include <string>

#include "alhazen/geometry/facets/convex_parts.h"
#include "alhazen/geometry/facets/facet_pool.h"

namespace alhazen {

struct MendedPolygon {
    std::vector<std::vector<Vec3>> parts;  ///< counter-clockwise around the plane's normal
    std::string mended;                    ///< in words; empty: nothing was
    std::string refused;                   ///< why there are no parts; empty: there are
};

[[nodiscard]] MendedPolygon mended_polygon(std::span<const Vec3> corners,
                                           std::span<const std::uint32_t> loop_ends,
                                           const FacetPlane& plane);

}  // namespace alhazen
