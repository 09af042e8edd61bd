#pragma once
/// Lower and upper bounds of the smallest distance between two solids.
///
/// Source: the separating slab is that of Gilbert, Johnson and Keerthi, "A Fast Procedure for
/// Computing the Distance between Complex Objects", IEEE J. Robotics Autom. 4(2), 1988.
/// Differs: both bounds come from searches that use only lines and extents.
/// Conventions: `at_most` is the distance of two points, each on the surface of its solid within
/// `error`. `at_least` is the width of a slab that separates the convex hulls of the solids, by
/// their extents: the clearance itself for convex solids whose extents are tight, less where they
/// are those of a box around the solid (CSG, algebraic surfaces, blobs, superellipsoids, curved
/// profiles), and possibly zero for solids that are not convex (a pin in a hole), for which only
/// `at_most` is informative. `at_most` may be too large if a small feature is nearer than every
/// starting point of the search.
/// Complexity: about ten thousand lines.

#include <cstdint>

#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

struct Clearance {
    /// The solids share volume: both bounds are zero, and `on_a` and `on_b` are one shared point.
    bool overlap = false;
    double at_least = 0, at_most = 0;
    Vec3 on_a, on_b;   ///< points at distance `at_most`
    double error = 0;  ///< bound of each point's distance from its surface
};

/// The clearance of `a` and `b`. Throws Error (Usage) for unbounded solids.
[[nodiscard]] Clearance clearance(const IsolatedSolid& a, const IsolatedSolid& b,
                                  std::uint64_t seed = 1);

}  // namespace alhazen
