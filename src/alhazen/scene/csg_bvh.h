#pragma once
/// A tree of boxes around the leaves of a solid, four to a node, each child with the range of t in
/// which a ray passes its box.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008 (wide nodes for single
/// rays); Kay and Kajiya, SIGGRAPH 1986 (slabs).
/// Differs: built by the binary builder of wide_bvh, then four grandchildren to a node; each leaf
/// holds one box. What is computed of a ray is double, what is stored of boxes float.
/// Conventions: ranges hold the true ones with `pad` to spare on every side. Boxes that are not
/// finite are listed apart.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/accel/wide_bvh/local_frame.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class CsgBvh {
  public:
    static constexpr std::size_t kWidth = 4;
    /// A child: a node, or a leaf (its number with this bit).
    static constexpr std::uint32_t kLeafBit = 1u << 31;

    struct alignas(64) Node {
        float lo[3][kWidth];
        float hi[3][kWidth];
        std::uint32_t child[kWidth];  ///< those that are not used have an empty box
    };

    /// A ray in the frame of the tree, its origin moved by the pad for either side of the slabs.
    struct RaySlabs {
        double near_origin[3], far_origin[3], inverse[3];
        bool negative[3];
    };

    CsgBvh() = default;
    /// Empty boxes are left out.
    explicit CsgBvh(std::span<const Box3> boxes);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const std::vector<std::uint32_t>& unbounded() const { return unbounded_; }
    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + unbounded_.capacity() * sizeof(std::uint32_t);
    }

    /// `pad` in the units of the boxes.
    [[nodiscard]] RaySlabs slabs(const Ray& ray, double pad) const;
    /// Calls visit(child, enter, exit) for each child of the node (0: the root) that the line
    /// passes.
    template <class Visit>
    void children(std::uint32_t node, const RaySlabs& ray, Visit&& visit) const;

  private:
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> unbounded_;
    LocalFrame frame_;
};

template <class Visit>
void CsgBvh::children(std::uint32_t index, const RaySlabs& ray, Visit&& visit) const {
    const Node& node = nodes_[index];
    double enter[kWidth], exit[kWidth];
    for (std::size_t i = 0; i < kWidth; ++i) {
        enter[i] = -std::numeric_limits<double>::infinity();
        exit[i] = std::numeric_limits<double>::infinity();
    }
    for (int k = 0; k < 3; ++k) {
        const float* near = ray.negative[k] ? node.hi[k] : node.lo[k];
        const float* far = ray.negative[k] ? node.lo[k] : node.hi[k];
        for (std::size_t i = 0; i < kWidth; ++i) {
            const double t0 = (static_cast<double>(near[i]) - ray.near_origin[k]) * ray.inverse[k];
            const double t1 = (static_cast<double>(far[i]) - ray.far_origin[k]) * ray.inverse[k];
            enter[i] = t0 > enter[i] ? t0 : enter[i];
            exit[i] = t1 < exit[i] ? t1 : exit[i];
        }
    }
    for (std::size_t i = 0; i < kWidth; ++i) {
        if (enter[i] <= exit[i]) visit(node.child[i], enter[i], exit[i]);
    }
}

}  // namespace alhazen
