#pragma once
/// Makes a wide BVH of a binary one, at the least expected cost.
///
/// Source: Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on GPUs Through
/// Compressed Wide BVHs", HPG 2017, section 3 (the dynamic program).
/// Differs: the cost of a leaf is that of its blocks; leaves hold one kind. Children lie in the
/// order in which a query for any hit best visits them: by the chance that a random line which
/// meets the child's box ends there, over the cost to find out. With the area S of the surfaces
/// inside a box of the area A it meets 2 S / A of them on average (Crofton), so the chance is taken
/// for 1 - exp(-2 S / A). (Ize and Hansen, "RTSAH Traversal Order for Occlusion Rays", Computer
/// Graphics Forum 30(2), 2011, order two children by costs; this needs no work per ray.) Complexity
/// and threads: O(n); subtrees in parallel, the result is the same for every number of threads.

#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/base/mappable_vector.h"

namespace alhazen {

/// Stores the primitives of leaves, in blocks of consecutive numbers for each kind.
class LeafSink {
  public:
    virtual ~LeafSink() = default;
    /// Makes room; called once, before the leaves are packed.
    virtual void resize(const std::array<std::size_t, kLeafKinds>& blocks) = 0;
    /// Packs a leaf of at most NodeRef::kMaxBlocks blocks, the first at `offset`; from many
    /// threads. Leaves follow each other in the order of traversal of the tree. Returns the area of
    /// the surfaces at which a query for any hit ends.
    virtual float pack(std::uint32_t kind, std::size_t offset,
                       std::span<const BuildReference> references) = 0;
};

struct WideBvh {
    /// One of them has nodes, by `width`.
    MappableVector<WideNode> nodes;
    MappableVector<WideNodeOf<4>> nodes_of_4;
    MappableVector<WideNodeOf<16>> nodes_of_16;
    NodeRef root{};  ///< may be a leaf
    bool empty = true;
    int depth = 0;  ///< levels of inner nodes
    std::uint32_t width = 8;
};

/// The nodes of a tree of that width.
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

/// `width` is one of kNodeWidths. Throws Error(Resource) when there are more nodes or blocks than
/// references can name.
[[nodiscard]] WideBvh collapse(const BinaryBvh& binary, std::span<const BuildReference> references,
                               const LeafKinds& kinds, LeafSink& sink, std::uint32_t width = 8);

}  // namespace alhazen
