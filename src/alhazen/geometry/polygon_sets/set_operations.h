#pragma once
/// Intersection, difference, union of polygon sets.
///
/// Source: the regions of Weiler and Atherton, "Hidden Surface Removal Using Polygon Area Sorting",
/// SIGGRAPH 1977; the sweep of Bentley and Ottmann, "Algorithms for Reporting and Counting
/// Geometric Intersections", IEEE Transactions on Computers C-28, 1979; the rounding of Hobby,
/// "Practical Segment Intersection with Finite Precision Output", Computational Geometry 13, 1999.
/// Differs: overlapping edges are one edge of the sweep as far as they overlap, so that there are
/// no special cases. If all crossings are lattice points, nothing is rounded.
/// Conventions: results are canonical (polygon_set.h). All operations on the same two operands
/// round alike: cut(a, b).inside and intersection(a, b) are equal, and the two parts of a cut fit
/// without gap or overlap: their areas add up exactly, before rounding to the area of a, after
/// rounding to that of a with its edges rounded.
/// Complexity: O((n + k) log n) for n vertices and k crossings. Threads: each call runs on the
/// calling thread, which keeps the memory for its next call.

#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

[[nodiscard]] PolygonSet intersection(const PolygonSet& a, const PolygonSet& b);
/// a without b.
[[nodiscard]] PolygonSet difference(const PolygonSet& a, const PolygonSet& b);
[[nodiscard]] PolygonSet union_of(const PolygonSet& a, const PolygonSet& b);
[[nodiscard]] PolygonSet symmetric_difference(const PolygonSet& a, const PolygonSet& b);

/// The two parts into which b divides a.
struct PolygonCut {
    PolygonSet inside;   ///< a and b
    PolygonSet outside;  ///< a without b
};

/// Computes both parts in one sweep.
[[nodiscard]] PolygonCut cut(const PolygonSet& a, const PolygonSet& b);
/// Computes both parts into existing memory.
void cut(const PolygonSet& a, const PolygonSet& b, PolygonCut& parts);

}  // namespace alhazen
