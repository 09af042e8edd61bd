#pragma once
/// A bounding box tree over the components of a blob; finds those that a line or a point may
/// intersect.
///
/// Source: Gottschalk, Lin and Manocha, "OBBTree", SIGGRAPH 1996 (separating axes of a line and a
/// box); split at the median of the longest axis.
/// Differs: the axes are the three cross products with the line; boxes are tested with a margin for
/// the rounding of the origin.
/// Conventions: conservative: results may contain additional components, but none is missing.
/// Threads: const functions may be called concurrently.

#include <cstdint>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

/// Spheres around eight components, in lanes.
struct BlobSpheres {
    static constexpr std::uint32_t kCount = 8, kAll = (1u << kCount) - 1;

    double x[kCount] = {}, y[kCount] = {}, z[kCount] = {}, radius[kCount] = {};
    std::uint32_t used = 0;  ///< bit i for the i-th
};

class BlobTree {
  public:
    /// Up to this number components are tested one by one; beyond it the tree is faster.
    static constexpr std::size_t kFew = 64;

    explicit BlobTree(const std::vector<Box3>& boxes);

    /// Adds a sphere around the next component, with a margin for its rounding.
    void add_sphere(const Vec3& center, double radius);
    /// The spheres, in the order of addition.
    [[nodiscard]] const std::vector<BlobSpheres>& spheres() const { return spheres_; }
    /// Mean over the boxes of half the smallest side.
    [[nodiscard]] double mean_radius() const { return mean_radius_; }

    /// Calls f(component) for all components whose box, grown by `pad`, intersects the line o + t
    /// d.
    template <class F>
    void for_line(const Vec3& o, const Vec3& d, double pad, F f) const {
        visit([&](const Box3& box) { return meets_line(box, o, d, pad); }, f);
    }
    /// Calls f(component) for all components whose box contains a point of `around`, in the order
    /// of `for_point`.
    template <class F>
    void for_box(const Box3& around, F f) const {
        const auto meets = [&](const Box3& box) {
            return box.lo.x <= around.hi.x && around.lo.x <= box.hi.x && box.lo.y <= around.hi.y &&
                   around.lo.y <= box.hi.y && box.lo.z <= around.hi.z && around.lo.z <= box.hi.z;
        };
        visit(meets, f);
    }
    /// Calls f(component) for all components whose box contains the point.
    template <class F>
    void for_point(const Vec3& p, F f) const {
        visit([&](const Box3& box) { return box.contains(p); }, f);
    }

  private:
    static constexpr std::uint32_t kLeafSize = 4;
    struct Node {
        Box3 box;
        std::uint32_t first = 0, count = 0;  ///< range of a leaf in order_; else 0
        std::uint32_t second_child = 0;      ///< for an inner node; its first child follows it
    };

    void build(const std::vector<Box3>& boxes, std::uint32_t first, std::uint32_t end);
    static bool meets_line(const Box3& box, const Vec3& o, const Vec3& d, double pad);

    template <class Test, class F>
    void visit(Test test, F f) const {
        std::uint32_t stack[64];
        int depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const std::uint32_t at = stack[--depth];
            const Node& node = nodes_[at];
            if (!test(node.box)) continue;
            for (std::uint32_t i = 0; i < node.count; ++i) {
                const std::uint32_t component = order_[node.first + i];
                if (node.count == 1 || test(boxes_[component])) f(component);
            }
            if (node.count > 0) continue;
            stack[depth++] = node.second_child;
            stack[depth++] = at + 1;
        }
    }

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Box3> boxes_;
    std::vector<BlobSpheres> spheres_;
    double mean_radius_ = 0;
};

}  // namespace alhazen
