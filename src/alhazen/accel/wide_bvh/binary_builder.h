#pragma once
/// Builds a binary bounding volume hierarchy by the surface area heuristic: the tree that
/// `collapse` makes wide.
///
/// Source: MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The Visual
/// Computer 6, 1990 (the cost); Wald, "On Fast Construction of SAH-based Bounding Volume
/// Hierarchies", RT 2007 (binning).
/// Differs: primitives are counted in blocks of the lanes that test them together, by kind; small
/// ranges are swept exactly; from level 48 on ranges are halved, so the depth is bounded whatever
/// the input.
/// Complexity and threads: O(n log n), parallel; the result is the same for every number of
/// threads.

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "alhazen/accel/wide_bvh/wide_node.h"

namespace alhazen {

/// Kinds of primitive that cannot share a leaf.
inline constexpr std::size_t kLeafKinds = 3;

/// What a leaf of one kind costs to test.
struct LeafKind {
    std::uint32_t width_log2 = 0;  ///< of the number of primitives in a block
    float cost = 1;                ///< of a block, in visits of a wide node

    [[nodiscard]] std::uint32_t width() const { return 1u << width_log2; }
    /// Blocks that `count` primitives fill.
    [[nodiscard]] std::uint32_t blocks(std::uint32_t count) const {
        return (count + width() - 1) >> width_log2;
    }
};
using LeafKinds = std::array<LeafKind, kLeafKinds>;

/// A primitive to build over.
struct BuildReference {
    FloatBox box;
    std::uint32_t id = 0;
    std::uint32_t kind = 0;

    /// Twice the center of the box.
    [[nodiscard]] float center2(int axis) const { return box.lo[axis] + box.hi[axis]; }
};

struct BinaryNode {
    FloatBox box;
    std::uint32_t begin = 0, end = 0;  ///< its range of the references
    std::uint32_t right = 0;  ///< index of the right child; the left one follows; 0: a leaf
    std::uint32_t kind =
        kLeafKinds;  ///< of all primitives in the range; kLeafKinds where they differ

    [[nodiscard]] bool is_leaf() const { return right == 0; }
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

struct BinaryBvh {
    std::unique_ptr<BinaryNode[]> nodes;  ///< [0] is the root; not every index is used
    bool empty = true;
};

/// Reorders `references` so that each node holds a range of them. Every leaf is of one kind and
/// fits into one block.
[[nodiscard]] BinaryBvh build_binary(std::vector<BuildReference>& references,
                                     const LeafKinds& kinds);

}  // namespace alhazen
