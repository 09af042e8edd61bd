#pragma once
/// Makes a wide BVH of a binary one, at the least expected cost.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", HPG 2017, section 3 (the dynamic program).
/// Differs: the cost of a leaf is that of its blocks; leaves hold one kind.
/// Complexity and threads: O(n); subtrees in parallel, the result is the same for every number of
/// threads.

#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/build_types.h"
#include "alhazen/base/mappable_vector.h"

namespace alhazen {

/// Stores the primitives of leaves, in blocks of consecutive numbers for each kind.
class LeafSink {
  public:
    virtual ~LeafSink() = default;
    /// Makes room; called once, before the leaves are packed.
    virtual void resize(const std::array<std::size_t, kLeafKinds>& blocks) = 0;
    /// Packs a leaf of at most NodeRef::kMaxBlocks blocks, the first at `offset`; from many
    /// threads. Leaves follow each other in the order of traversal of the tree.
    virtual void pack(std::uint32_t kind, std::size_t offset,
                      std::span<const BuildReference> references) = 0;
};

struct WideBvh {
    MappableVector<WideNode> nodes;
    NodeRef root{};  ///< may be a leaf
    bool empty = true;
    int depth = 0;  ///< levels of inner nodes
};

/// Throws Error(Resource) when there are more nodes or blocks than references can name.
[[nodiscard]] WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                               const LeafKinds& kinds, LeafSink& sink);

}  // namespace alhazen
