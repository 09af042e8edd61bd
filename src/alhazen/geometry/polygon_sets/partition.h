#pragma once
/// Rounds the regions that partition another one together, so that they fit without gap or overlap.
///
/// Source: Hobby, "Practical Segment Intersection with Finite Precision Output", Computational
/// Geometry 13, 1999: edges of one arrangement, rounded together, keep their order.
/// Differs: regions that are cut out one after the other and rounded separately overlap, and leave
/// gaps thinner than the lattice. Here the faces between all their edges are determined exactly,
/// each is assigned to one region, and all are rounded together.
/// Conventions: a face in several regions belongs to the first of them, a face in none to the
/// region with which it shares the longest boundary. Faces outside the whole belong to none. The
/// whole is rounded with its parts; an axis-aligned rectangle is unchanged, so that the areas of
/// the parts add up to its area exactly. Complexity: O((n + k) log n) for n vertices and k
/// crossings. Threads: as in set_operations.h.

#include <span>

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

/// Makes a partition of `whole` out of `parts`. Parts may become empty; without parts it does
/// nothing.
void make_partition(const PolygonSet& whole, std::span<PolygonSet> parts);

}  // namespace alhazen
