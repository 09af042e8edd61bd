#pragma once
/// Builds a binary bounding volume hierarchy quickly, from the leaves up: neighbors on a
/// space-filling curve that fit together best are joined, again and again.
///
/// Source: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
/// Construction", TVCG 24(3), 2018.
/// Differs: it begins with the small subtrees that the curve gives, not with single primitives;
/// ties go to the partner whose number differs in the lowest bits, so that equal boxes are joined
/// in pairs and every round has a pair to join.
/// Complexity and threads: O(n) for usual inputs, parallel; the result is the same for every number
/// of threads.

#include <vector>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// As build_binary.
[[nodiscard]] BinaryBvh build_by_clustering(std::vector<BuildReference>& references,
                                            const LeafKinds& kinds);

}  // namespace alhazen
