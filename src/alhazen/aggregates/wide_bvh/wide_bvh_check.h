#pragma once
/// Checks that a tree from a file can be traversed: kernels follow its references unchecked.
///
/// Conventions: checks the conditions of memory safety only. A tree with wrong boxes passes, and
/// gives wrong hits.
/// Complexity: O(nodes + blocks).

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"

namespace alhazen {

/// Null if the frame is valid, every node has one parent that precedes it, nodes are at most
/// `kMaxWideDepth` deep, every reference lies within the arrays and every id within its kind in the
/// table; else a short description of the first violation.
[[nodiscard]] const char* first_violation(const WideBvhLayout& layout, const PrimitiveTable& table);

}  // namespace alhazen
