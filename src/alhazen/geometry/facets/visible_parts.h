#pragma once
/// The parts of a polygon that are visible from a point, given the polygons of a tree as occluders.
///
/// Source: Atherton, Weiler and Greenberg, "Polygon Shadow Generation", SIGGRAPH 1978: seen from
/// the point, occluders are cut out of the polygon.
/// Differs: no window and no lattice. The polygon is cut in its own plane, by the planes through
/// the point and the edges of an occluder, into convex parts; an area is accurate to the rounding
/// of its corners. Occluders that share an edge give the same plane, so that no gap between them is
/// visible.
/// Conventions: loops are convex. A facet in whose plane the point lies does not occlude, nor does
/// one in the plane of the polygon. Facets occlude from both sides.
/// Complexity: O(visited facets * parts); hulls as in facet_tree.h. Threads: any number.

#include <span>
#include <vector>

#include "alhazen/geometry/facets/facet_tree.h"

namespace alhazen {

using ConvexLoop = std::vector<Vec3>;

/// The visible parts: convex, with the orientation of `polygon`, without overlap; none if the point
/// lies in its plane. Adds the counts of the traversal to `counts`.
[[nodiscard]] std::vector<ConvexLoop> visible_parts(const FacetTree& tree, const Vec3& point,
                                                    std::span<const Vec3> polygon,
                                                    FacetWalkCounts* counts = nullptr);

/// The area of a planar loop.
[[nodiscard]] double area_of(std::span<const Vec3> loop);

/// The visible area of a polygon, and the solid angle that it subtends.
struct VisibleAmount {
    double area = 0;
    double solid_angle = 0;
};
[[nodiscard]] VisibleAmount visible_amount(const FacetTree& tree, const Vec3& point,
                                           std::span<const Vec3> polygon);

}  // namespace alhazen
