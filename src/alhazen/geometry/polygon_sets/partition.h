#pragma once
/// Rounds the regions that divide another all at once, so that they fit without gap and overlap.
///
/// Source: Hobby, "Practical Segment Intersection with Finite Precision Output", Computational
/// Geometry 13, 1999: edges of one arrangement, rounded together, keep their order.
/// Differs: regions that were cut out one after the other, each rounded alone, overlap and leave
/// gaps thinner than the lattice. Here the faces between all their edges are told apart exactly,
/// each is given to one region, and then all are rounded together.
/// Conventions: a face in several regions belongs to the first of them, one in none to the region
/// that it has the longest boundary with. What lies outside of the whole belongs to none. The whole
/// itself is rounded with its parts; a rectangle along the axes stays as it is, so that the areas
/// of the parts add up to its area exactly. Complexity: O((n + k) log n) for n vertices and k
/// crossings. Threads: as set_operations.h.

#include <span>

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

/// Makes a partition of `whole` out of `parts`. Some may end up empty; without any nothing is made.
void make_partition(const PolygonSet& whole, std::span<PolygonSet> parts);

}  // namespace alhazen
