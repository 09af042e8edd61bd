#pragma once
/// The smallest distance between two solids, from above and from below.
///
/// Source: the separating slab is that of Gilbert, Johnson and Keerthi, "A Fast Procedure for
/// Computing the Distance between Complex Objects", IEEE J. Robotics Autom. 4(2), 1988. Differs:
/// both bounds are found by searches that need nothing but lines and extents.
/// Conventions: `at_most` is the distance of two points that are given, each on the surface of its
/// solid but for `error`. `at_least` is the width of a slab between the two: nothing of them can be
/// nearer. The slab is that of the convex hulls, so it is as wide as the clearance for convex
/// solids, and may be zero for others (a pin in a hole): then only `at_most` tells. `at_most` could
/// be too large where a small feature is nearer than all that the search began from.
/// Complexity and threads: some ten thousand lines.

#include <cstdint>

#include "alhazen/solids/isolated_solid.h"

namespace alhazen {

struct Clearance {
    /// They share volume: both bounds are zero, and `on_a`, `on_b` are one point of it.
    bool overlap = false;
    double at_least = 0, at_most = 0;
    Vec3 on_a, on_b;   ///< the points that are `at_most` apart
    double error = 0;  ///< bound of how far each is from its surface
    Vec3 slab_normal;  ///< of the slab that `at_least` is the width of; zero where there is none
};

/// Throws Error (Usage) for solids that are not bounded.
[[nodiscard]] Clearance clearance(const IsolatedSolid& a, const IsolatedSolid& b,
                                  std::uint64_t seed = 1);

}  // namespace alhazen
