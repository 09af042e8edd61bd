#pragma once
/// An octree over the bounds of primitives, with integer cell geometry, shared by the four
/// traversals.
///
/// Source: Glassner, "Space Subdivision for Fast Ray Tracing", IEEE CG&A 4(10), 1984.
/// Differs: children are consecutive and found by index, not by hashing their names. A cell is not
/// divided further if the lists of its children would together be more than five times as long as
/// its own, since its primitives fill it; nor if sixteen or more of them lie in the same children,
/// since they overlap. The root is the box of the scene, at least a fourth of its largest side wide
/// along every axis, where Glassner's is a cube.
/// Conventions: an axis of the root is 2^max_depth units long. Octant bit k is set for the upper
/// half along axis k. Primitives are stored in every leaf within `pad` of them.

#include <array>
#include <cstdint>
#include <vector>

#include "alhazen/accel/core/padded_box.h"

namespace alhazen {

class OctreeCells {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    static constexpr int kMostDepth = 16;
    using Units = std::array<std::int32_t, 3>;

    struct Node {
        std::uint32_t first = 0;  ///< index of its eight children, or of its entries
        std::uint32_t count = 0;  ///< number of a leaf's entries
        std::uint32_t parent = kNone;
        Units origin{};           ///< its lowest corner
        std::uint8_t level = 0;   ///< 0: the root
        std::uint8_t octant = 0;  ///< index among its parent's children
        bool leaf = true;
    };

    OctreeCells() = default;
    /// Throws Error(Resource) for more than 2^32 nodes or entries.
    OctreeCells(const BoundsSource& source, int max_depth, int leaf_size);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }
    [[nodiscard]] const Box3& box() const { return space_.box; }
    [[nodiscard]] int max_depth() const { return max_depth_; }
    [[nodiscard]] double pad() const { return space_.pad; }

    /// Edge of a cell, in units.
    [[nodiscard]] std::int32_t span(const Node& node) const {
        return std::int32_t{1} << (max_depth_ - node.level);
    }
    [[nodiscard]] double plane(int axis, std::int32_t unit) const {
        return unit == std::int32_t{1} << max_depth_ ? box().hi[axis]
                                                     : box().lo[axis] + unit * unit_size_[axis];
    }
    /// The unit that contains a coordinate, clamped to [lo, hi].
    [[nodiscard]] std::int32_t unit(int axis, double x, std::int32_t lo, std::int32_t hi) const {
        const double place = (x - box().lo[axis]) * per_unit_size_[axis];
        return place >= hi ? hi : place <= lo ? lo : static_cast<std::int32_t>(place);
    }
    /// The octant of a unit in an inner node.
    [[nodiscard]] std::uint32_t octant_of(const Node& node, const Units& at) const {
        const int bit = max_depth_ - node.level - 1;
        std::uint32_t octant = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            octant |= static_cast<std::uint32_t>(at[k] >> bit & 1) << k;
        }
        return octant;
    }

    /// True if the ray starts so near that rounding errors stay far below `pad`.
    [[nodiscard]] bool covers(const Ray& ray) const { return space_.covers(ray); }
    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + entries_.capacity() * sizeof(std::uint32_t);
    }

  private:
    [[nodiscard]] Box3 cell_box(const Node& node) const;
    void divide(std::uint32_t index, std::vector<std::uint32_t> inside, const BoundsSource& source,
                int leaf_size);
    void make_leaf(std::uint32_t index, const std::vector<std::uint32_t>& inside);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> entries_;
    PaddedBox space_;
    Vec3 unit_size_, per_unit_size_;
    int max_depth_ = 0;
};

}  // namespace alhazen
