#pragma once
/// Makes a wide BVH of a binary one, at the least expected cost.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", HPG 2017, section 3 (the dynamic program).
/// Differs: the cost of a leaf is that of its blocks; leaves hold one kind.
/// Complexity: O(n) time; serial.

#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/binary_builder.h"
#include "alhazen/base/mappable_vector.h"

namespace alhazen {

/// Stores the primitives of leaves.
class LeafSink {
  public:
    virtual ~LeafSink() = default;
    /// Packs a leaf of at most NodeRef::kMaxBlocks blocks; called in the order of traversal of the
    /// tree.
    virtual NodeRef add_leaf(std::uint32_t kind, std::span<const BuildReference> references) = 0;
};

struct WideBvh {
    MappableVector<WideNode> nodes;
    NodeRef root{};  ///< may be a leaf
    bool empty = true;
    int depth = 0;  ///< levels of inner nodes
};

/// Throws Error(Resource) when there are more nodes than references can name.
[[nodiscard]] WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                               const LeafKinds& kinds, LeafSink& sink);

}  // namespace alhazen
