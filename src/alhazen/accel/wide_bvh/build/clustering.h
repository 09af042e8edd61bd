#pragma once
/// Builds a binary bounding volume hierarchy quickly, bottom-up: repeatedly joins the best-fitting
/// neighbors on a space-filling curve.
///
/// Source: Meister and Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
/// Construction", TVCG 24(3), 2018.
/// Differs: starts from the small subtrees given by the curve, not from single primitives; ties go
/// to the partner whose number differs in the lowest bits, so that equal boxes are joined in pairs
/// and every round joins a pair.
/// Complexity and threads: O(n) for usual inputs, parallel; the result is the same for every number
/// of threads.

#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// As build_binary.
[[nodiscard]] BinaryBvh build_by_clustering(std::span<BuildReference> references,
                                            const LeafKinds& kinds);

}  // namespace alhazen
