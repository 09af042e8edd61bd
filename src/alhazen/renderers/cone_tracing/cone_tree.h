#pragma once
/// A binary tree of boxes for cones: the boxes that a cone may meet, nearest first.
///
/// The trees of `accel` are for rays: their kernels test many boxes against one line and compute no
/// distance for boxes that the line misses. A cone requires its own test (cone_map.h) and all
/// touched boxes in order.
///
/// Source: Wald, "On Fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007 (bins).
/// Complexity: O(n log n) to build; the tree depends on the boxes alone.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

class ConeTree {
  public:
    struct Node {
        Vec3 center, half;
        std::uint32_t first = 0;  ///< index of its first item in `order`, or of its first child
        std::uint32_t count = 0;  ///< items of a leaf; 0: an inner node
    };

    ConeTree() = default;
    /// Bounded boxes.
    explicit ConeTree(std::span<const Box3> boxes);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const Node& node(std::uint32_t i) const { return nodes_[i]; }
    [[nodiscard]] std::uint32_t item(std::uint32_t i) const { return order_[i]; }

  private:
    static constexpr std::uint32_t kLeafItems = 3;

    [[nodiscard]] std::uint32_t divide(std::span<const Box3> boxes, std::uint32_t first,
                                       std::uint32_t end);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace alhazen
