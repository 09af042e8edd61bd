#pragma once
/// Improves a binary tree by reinserting subtrees at the positions of least cost.
///
/// Source: Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization",
/// EG 2018; Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies", CGF 32(1), 2013.
/// Differs: positions are searched in parallel in the tree at the start of a pass; then the moves
/// are applied one by one, the most profitable first, except those that touch nodes of an applied
/// move. A search is limited to a number of nodes, which bounds the time for any input.
/// Complexity and threads: O(n) per pass; the result is the same for every number of threads.

#include "alhazen/accel/wide_bvh/build/tree_draft.h"

namespace alhazen {

/// Returns the relative reduction of the sum of the areas of the inner nodes.
double reinsert(DraftBvh& tree);

}  // namespace alhazen
