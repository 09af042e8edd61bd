#pragma once
/// Builds a binary bounding volume hierarchy by the surface area heuristic: the tree that
/// `collapse` makes wide.
///
/// Source: Wald, "On Fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007.
/// Differs: how sets are divided is in sah_split.h; from level 48 on they are halved, so the depth
/// is bounded whatever the input.
/// Complexity and threads: O(n log n), parallel; the result is the same for every number of
/// threads.

#include <vector>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// Reorders `references` so that each node holds a range of them. Every leaf is of one kind and
/// fits into one block.
[[nodiscard]] BinaryBvh build_binary(std::vector<BuildReference>& references,
                                     const LeafKinds& kinds);

}  // namespace alhazen
