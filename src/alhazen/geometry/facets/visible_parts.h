#pragma once
/// The parts of a polygon that a point sees past the polygons of a tree.
///
/// Source: Atherton, Weiler and Greenberg, "Polygon Shadow Generation", SIGGRAPH 1978: seen from
/// the point, occluders are cut out of the polygon.
/// Differs: no window and no lattice. The polygon is cut in its own plane by the planes through the
/// point and the edges of an occluder, into convex parts; an area is right to the rounding of its
/// corners. Occluders that share an edge give the same plane, so that nothing is seen between them.
/// Conventions: loops are convex. A facet that the point lies in hides nothing, nor does one in the
/// plane of the polygon. Both sides of all facets hide.
/// Complexity: O(visited facets * parts); of hulls, as facet_tree.h. Threads: any number.

#include <span>
#include <vector>

#include "alhazen/geometry/facets/facet_tree.h"

namespace alhazen {

using ConvexLoop = std::vector<Vec3>;

/// Convex parts in the direction of `polygon`, without overlap; none where the point is in its
/// plane. Counts of the walk are added to `counts`.
[[nodiscard]] std::vector<ConvexLoop> visible_parts(const FacetTree& tree, const Vec3& point,
                                                    std::span<const Vec3> polygon,
                                                    FacetWalkCounts* counts = nullptr);

/// Of a planar loop.
[[nodiscard]] double area_of(std::span<const Vec3> loop);

/// What the point sees of the polygon: its area, and the solid angle that this takes.
struct VisibleAmount {
    double area = 0;
    double solid_angle = 0;
};
[[nodiscard]] VisibleAmount visible_amount(const FacetTree& tree, const Vec3& point,
                                           std::span<const Vec3> polygon);

}  // namespace alhazen
