#pragma once
/// Improves a binary tree by taking subtrees out and putting them back where they cost least.
///
/// Source: Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization",
/// EG 2018; Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume
/// Hierarchies", CGF 32(1), 2013.
/// Differs: places are searched in parallel in the tree as it is at the beginning of a pass; then
/// the moves are made one by one, the most profitable first, those left out that touch nodes of one
/// that was made. A search gives up after some nodes, so that no input is slow.
/// Complexity and threads: O(n) per pass; the result is the same for every number of threads.

#include "alhazen/accel/wide_bvh/build/tree_draft.h"

namespace alhazen {

struct ReinsertionLimits {
    int passes = 12;
    double least_gain = 0.005;  ///< of the sum of the areas of inner nodes: below it no more passes
};

/// Returns by what share the sum of the areas of the inner nodes has become less.
double reinsert(DraftBvh& tree, const ReinsertionLimits& limits = {});

}  // namespace alhazen
