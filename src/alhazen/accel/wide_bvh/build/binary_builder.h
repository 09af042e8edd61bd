#pragma once
/// Builds a binary bounding volume hierarchy by the surface area heuristic; `collapse` makes it
/// wide.
///
/// Source: Wald, "On Fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007.
/// Differs: sets are divided as in sah_split.h; from level 48 on they are halved, so the depth is
/// bounded for every input.
/// Complexity and threads: O(n log n), parallel; the tree and the order of the references are the
/// same for every number of threads, though not the indices of its nodes.

#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

/// Reorders `references` so that each node has a range of them. Every leaf has one kind and fits
/// into one block.
[[nodiscard]] BinaryBvh build_binary(std::span<BuildReference> references, const LeafKinds& kinds);

}  // namespace alhazen
