#pragma once
/// Fits a built tree to the same primitives in other places: much faster than building, for meshes
/// that deform. What the tree holds together stays together, so its cost grows with the motion.
///
/// Conventions: the moved table has the primitives of the built one, in the same order. Hits are
/// those of a tree built anew.
/// Complexity and threads: O(n), leaves in parallel; the result is the same for every number of
/// threads.

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {

/// From this growth of the cost on, building anew pays.
inline constexpr double kRebuildGrowth = 1.5;

struct RefitReport {
    double cost = 0;    ///< by the surface area heuristic, now
    double growth = 1;  ///< over that of the tree as it was built
    [[nodiscard]] bool rebuild_pays() const { return growth > kRebuildGrowth; }
};

/// Throws Error(Usage), and leaves the layout as it was, where other primitives can be hit than the
/// tree was built over: then it must be built anew.
void refit(WideBvhLayout& layout, const PrimitiveTable& moved, const BoundedPrimitives& bounded);

}  // namespace alhazen
