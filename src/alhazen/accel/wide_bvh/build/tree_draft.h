#pragma once
/// A mutable binary tree with its nodes in any order, for methods that build bottom-up or move
/// subtrees.
///
/// Complexity and threads: O(n); `linearize` is partly parallel, with the same result for every
/// number of threads.

#include <span>
#include <vector>

#include "alhazen/accel/wide_bvh/build/build_types.h"

namespace alhazen {

struct DraftNode {
    FloatBox box;
    std::uint32_t left = 0, right = 0;  ///< nodes; both 0: a leaf
    std::uint32_t begin = 0, end = 0;   ///< range of a leaf's references, of one kind

    [[nodiscard]] bool is_leaf() const { return right == 0; }
};

struct DraftBvh {
    std::vector<DraftNode> nodes;  ///< empty for an empty tree
    std::uint32_t root = 0;
};
/// A DraftBvh with nodes stored elsewhere.
struct DraftView {
    std::span<const DraftNode> nodes;
    std::uint32_t root = 0;
};

/// The same tree; a subtree best kept in one block is a leaf. The root is node 0.
[[nodiscard]] DraftBvh draft_of(const BinaryBvh& tree, const LeafKinds& kinds);

/// Estimates the cost of a tree that is made wide, for comparison with others over the same
/// primitives: leaves have the cost of their blocks, inner nodes half a visit, for a wide node is
/// in the place of several. 0 for an empty tree.
[[nodiscard]] double draft_cost(const DraftBvh& draft, std::span<const BuildReference> references,
                                const LeafKinds& kinds);

/// Writes the tree with the references in leaf order. Subtrees that begin at level kMaxSahLevel and
/// are too deep are rebalanced, so the depth is bounded.
[[nodiscard]] BinaryBvh linearize(const DraftBvh& draft, std::vector<BuildReference>& references);
/// The same, from `references` to `ordered`, which has capacity for all references of the leaves.
[[nodiscard]] BinaryBvh linearize(const DraftView& draft,
                                  std::span<const BuildReference> references,
                                  std::span<BuildReference> ordered);

}  // namespace alhazen
