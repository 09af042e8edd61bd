#pragma once
/// Input and output of the builders of the wide BVH: references to primitives, and binary trees
/// over them.

#include <array>
#include <cstdint>
#include <cstring>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/base/huge_array.h"

namespace alhazen {

/// Number of kinds of primitives, which cannot share a leaf.
inline constexpr std::size_t kLeafKinds = 4;

/// The cost of a leaf of one kind.
struct LeafKind {
    std::uint32_t width_log2 = 0;  ///< log2 of the number of primitives in a block
    float cost = 1;                ///< cost of a block, in units of visits of a wide node

    [[nodiscard]] std::uint32_t width() const { return 1u << width_log2; }
    /// Number of blocks that `count` primitives fill.
    [[nodiscard]] std::uint32_t blocks(std::uint32_t count) const {
        return (count + width() - 1) >> width_log2;
    }
    /// Largest number of primitives that builders need not divide: half a block is not worth its
    /// own box, unless the cost evaluated by `collapse` says otherwise.
    [[nodiscard]] std::uint32_t indivisible() const { return width() > 2 ? width() / 2 : 1; }
};
using LeafKinds = std::array<LeafKind, kLeafKinds>;

/// A primitive to build over, or its part in a cell. Two registers of four floats.
struct alignas(32) BuildReference {
    float lo[3];
    std::uint32_t id;
    float hi[3];
    std::uint32_t kind;

    BuildReference() = default;
    BuildReference(const FloatBox& box, std::uint32_t primitive, std::uint32_t leaf_kind)
        : id(primitive), kind(leaf_kind) {
        set_box(box);
    }
    [[nodiscard]] FloatBox box() const {
        FloatBox box;
        std::memcpy(box.lo, lo, sizeof(lo));
        std::memcpy(box.hi, hi, sizeof(hi));
        return box;
    }
    void set_box(const FloatBox& box) {
        std::memcpy(lo, box.lo, sizeof(lo));
        std::memcpy(hi, box.hi, sizeof(hi));
    }
    /// Twice the center of the box.
    [[nodiscard]] float center2(int axis) const { return lo[axis] + hi[axis]; }
};
static_assert(sizeof(BuildReference) == 32);

struct BinaryNode {
    FloatBox box;
    std::uint32_t begin = 0, end = 0;  ///< range of its references
    std::uint32_t right =
        0;  ///< index of the right child; the left child follows the node; 0: a leaf
    std::uint32_t kind =
        kLeafKinds;  ///< kind of all primitives in the range; kLeafKinds if they differ

    [[nodiscard]] bool is_leaf() const { return right == 0; }
    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

struct BinaryBvh {
    HugeArray<BinaryNode> nodes;    ///< [0] is the root; not every index is used
    std::uint32_t index_count = 0;  ///< bound of all indices
    bool empty = true;
};

}  // namespace alhazen
