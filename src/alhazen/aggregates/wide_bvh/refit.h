#pragma once
/// Refits a built tree to moved primitives, for meshes that deform: much faster than building. The
/// structure of the tree is kept, so the cost of its traversal grows with the motion.
///
/// Conventions: the moved table has the primitives of the built one, in the same order. Hits are
/// those of a newly built tree.
/// Complexity and threads: O(n), leaves in parallel; the result is the same for every number of
/// threads.

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/bounded_primitives.h"

namespace alhazen {

/// Growth of the cost from which on a new build pays.
inline constexpr double kRebuildGrowth = 1.5;

struct RefitReport {
    double cost = 0;    ///< of the refitted tree by the surface area heuristic
    double growth = 1;  ///< relative to the tree as built
    [[nodiscard]] bool rebuild_pays() const { return growth > kRebuildGrowth; }
};

/// Throws Error(Usage), and leaves the layout unchanged, if other primitives have bounds than those
/// the tree was built over; the tree must then be built anew.
void refit(WideBvhLayout& layout, const PrimitiveTable& moved, const BoundedPrimitives& bounded);

}  // namespace alhazen
