#pragma once
/// Converts a binary BVH to a wide one of the least expected cost.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
/// Wide BVHs", HPG 2017, section 3 (the dynamic program).
/// Differs: the cost of a leaf is that of its blocks; leaves have one kind. Children are stored in
/// the best order for any-hit queries: by the probability that a random line which intersects the
/// child's box ends there, over the cost of the test. With surfaces of area S inside a box of area
/// A, the line intersects them 2 S / A times on average (Crofton), so the probability is taken as 1
/// - exp(-2 S / A). (Ize and Hansen, "RTSAH Traversal Order for Occlusion Rays", Computer Graphics
/// Forum 30(2), 2011, order two children by costs; this needs no work per ray.)
/// Complexity and threads: O(n); subtrees in parallel, the result is the same for every number of
/// threads.

#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/base/mappable_vector.h"

namespace alhazen {

/// Stores the primitives of leaves, in consecutively numbered blocks of each kind.
class LeafSink {
  public:
    virtual ~LeafSink() = default;
    /// Allocates the blocks; called once, before the leaves are packed.
    virtual void resize(const std::array<std::size_t, kLeafKinds>& blocks) = 0;
    /// Packs a leaf of at most NodeRef::kMaxBlocks blocks, the first at `offset`. Must be
    /// thread-safe. Leaves are in the order of traversal of the tree. Returns the area of the
    /// surfaces at which an any-hit query ends.
    virtual float pack(std::uint32_t kind, std::size_t offset,
                       std::span<const BuildReference> references) = 0;
};

struct WideBvh {
    /// Only the nodes of `width` are used.
    MappableVector<WideNode> nodes;
    MappableVector<WideNodeOf<4>> nodes_of_4;
    MappableVector<WideNodeOf<16>> nodes_of_16;
    NodeRef root{};  ///< may be a leaf
    bool empty = true;
    int depth = 0;  ///< levels of inner nodes
    std::uint32_t width = 8;
};

/// The nodes of a tree of width `Width`.
template <std::size_t Width, class Tree>
[[nodiscard]] auto& nodes_of(Tree& tree) {
    if constexpr (Width == 4) {
        return tree.nodes_of_4;
    } else if constexpr (Width == 16) {
        return tree.nodes_of_16;
    } else {
        return tree.nodes;
    }
}
/// Calls `f` with the nodes of a tree.
template <class Tree, class F>
decltype(auto) with_nodes(Tree& tree, F&& f) {
    if (tree.width == 4) return f(tree.nodes_of_4);
    if (tree.width == 16) return f(tree.nodes_of_16);
    return f(tree.nodes);
}

/// `width` is one of kNodeWidths. Throws Error(Resource) if there are more nodes or blocks than
/// references can address.
[[nodiscard]] WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                               const LeafKinds& kinds, LeafSink& sink, std::uint32_t width = 8);

}  // namespace alhazen
