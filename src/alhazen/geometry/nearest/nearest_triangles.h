#pragma once
/// The triangle that is nearest to a point, out of many: a tree of boxes searched by distance.
///
/// Source: Roussopoulos, Kelley and Vincent, "Nearest Neighbor Queries", SIGMOD 1995 (depth first,
/// the nearer box first, boxes farther than the best are left out).
/// Differs: a binary tree by medians of the triangles' centres. Small nodes have a cylinder, too,
/// along their mean normal: beside a surface many boxes are as near as the nearest triangle, and
/// few cylinders. Both hold a margin for the rounding of points on triangles, and their distances
/// one for their own: the answer is that of brute force by `nearest_on_triangle`, bit for bit. Of
/// equal distances the lowest triangle's is taken.
/// Conventions: those of point_on_triangle.h. A point that is not finite is near to nothing.
/// Complexity and threads: O(n log n) to build on one thread, 164 bytes a triangle at most and
/// a copy of them all is read; about O(log n) a query. Const functions may be called from
/// many threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "alhazen/geometry/box.h"
#include "alhazen/geometry/nearest/point_on_triangle.h"

namespace alhazen {

struct NearestTriangle : PointOnTriangle {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;
    std::uint32_t triangle = kNone;

    NearestTriangle() { squared = std::numeric_limits<double>::infinity(); }
    [[nodiscard]] bool found() const { return triangle != kNone; }
};

class NearestTriangles {
  public:
    using Corners = std::array<Vec3, 3>;

    /// All corners must be finite; less than 2^32 - 1 triangles. Can be interrupted
    /// (interruption.h).
    explicit NearestTriangles(const std::vector<Corners>& triangles);

    /// The nearest one; none where there are no triangles.
    [[nodiscard]] NearestTriangle nearest(const Vec3& point) const;
    [[nodiscard]] std::size_t size() const { return corners_.size(); }

  private:
    static constexpr std::uint32_t kLeafSize = 4;

    /// A leaf where `count` > 0: triangles [first, first + count). Else the children are the next
    /// node and `first`.
    struct Node {
        Box3 box;
        std::uint32_t first = 0, count = 0;
        /// Of the cylinder around the middle of the box: its unit axis, half its height, its
        /// radius; infinite where there is none.
        Vec3 axis{0, 0, 1};
        float half_height = std::numeric_limits<float>::infinity();
        float radius = std::numeric_limits<float>::infinity();
    };

    [[nodiscard]] static double least_to_cylinder(const Node& node, const Vec3& point);
    /// `ids`: of its triangles.
    static void set_cylinder(Node& node, const std::vector<Corners>& triangles,
                             std::span<const std::uint32_t> ids);
    void build(std::vector<std::uint32_t>& order, const std::vector<Corners>& triangles,
               std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;         ///< each before its children; the first is the root
    std::vector<Corners> corners_;    ///< in the order of the leaves
    std::vector<std::uint32_t> ids_;  ///< the same
};

}  // namespace alhazen
