#pragma once
/// Whether a tree that came from outside can be traversed at all: kernels follow its references
/// without a look at where they lead.
///
/// Conventions: what is checked is what memory safety needs. A tree with wrong boxes passes, and
/// gives wrong hits.
/// Complexity: O(nodes + blocks).

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

namespace alhazen {

/// Null when the frame is one, every node has one parent that comes before it, nodes lie at most
/// `kMaxWideDepth` deep, every reference lies within the arrays and every id within its kind in the
/// table; else what is wrong, in some words.
[[nodiscard]] const char* first_violation(const WideBvhLayout& layout, const PrimitiveTable& table);

}  // namespace alhazen
