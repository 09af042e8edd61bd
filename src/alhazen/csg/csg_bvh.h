#pragma once
/// A tree of boxes around the leaves of a solid with eight children per node; traversal yields the
/// range of t of a ray in each child's box.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008 (wide nodes for single
/// rays); Kay and Kajiya, SIGGRAPH 1986 (slabs).
/// Differs: built by the binary builder of wide_bvh, then collapsed to eight descendants per node;
/// each leaf has one box. Rays are computed in double, boxes are stored in float; the boxes of a
/// node are tested together, with the same bits on every instruction set.
/// Conventions: ranges contain the true ranges with a margin of `pad` on every side. Unbounded
/// boxes are listed separately.

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/base/huge_pages.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class CsgBvh {
  public:
    static constexpr std::size_t kWidth = 8;
    /// Marks a child that is a leaf; the other bits are the leaf's number, or else a node.
    static constexpr std::uint32_t kLeafBit = 1u << 31;

    struct alignas(64) Node {
        float lo[3][kWidth];
        float hi[3][kWidth];
        std::uint32_t child[kWidth];  ///< unused children have an empty box
    };

    /// A ray in the frame of the tree, with its origin moved by the pad on either side of the
    /// slabs.
    struct RaySlabs {
        double near_origin[3], far_origin[3], inverse[3];
        bool negative[3];
    };

    /// The ranges of the line in the boxes of a node's children. The kernel returns the children
    /// whose boxes the line meets: bit i for child i.
    struct alignas(64) Ranges {
        double enter[kWidth], exit[kWidth];
    };
    using RangesKernel = std::uint32_t (*)(const Node&, const RaySlabs&, Ranges&);

    CsgBvh() = default;
    /// Builds the tree; empty boxes are ignored.
    explicit CsgBvh(std::span<const Box3> boxes);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const std::vector<std::uint32_t>& unbounded() const { return unbounded_; }
    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + unbounded_.capacity() * sizeof(std::uint32_t);
    }

    /// Prepares a ray; `pad` is in units of the boxes.
    [[nodiscard]] RaySlabs slabs(const Ray& ray, double pad) const;
    /// Calls visit(child, enter, exit) for each child of the node (0: the root) whose box the line
    /// meets.
    template <class Visit>
    void children(std::uint32_t node, const RaySlabs& ray, Visit&& visit) const;

  private:
    HugeVector<Node> nodes_;
    RangesKernel ranges_ = nullptr;
    std::vector<std::uint32_t> unbounded_;
    LocalFrame frame_;
};

template <class Visit>
void CsgBvh::children(std::uint32_t index, const RaySlabs& ray, Visit&& visit) const {
    const Node& node = nodes_[index];
    Ranges ranges;
    for (std::uint32_t passed = ranges_(node, ray, ranges); passed != 0; passed &= passed - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(passed));
        visit(node.child[i], ranges.enter[i], ranges.exit[i]);
    }
}

/// The kernel for the chosen instruction set.
[[nodiscard]] CsgBvh::RangesKernel csg_ranges_kernel();

}  // namespace alhazen
