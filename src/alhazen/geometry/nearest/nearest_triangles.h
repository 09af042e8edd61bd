#pragma once
/// The nearest of many triangles to a point, found by a tree of boxes searched by distance.
///
/// Source: Roussopoulos, Kelley and Vincent, "Nearest Neighbor Queries", SIGMOD 1995 (depth first,
/// the nearer box first; boxes farther than the best are skipped).
/// Differs: a binary tree, divided at the medians of the triangles' centres. Small nodes also have
/// a cylinder along their mean normal: near a surface many boxes are as near as the nearest
/// triangle, but few cylinders. Boxes and cylinders hold a margin for the rounding of points on
/// triangles, and their distances one for their own rounding: the result is that of brute force by
/// `nearest_on_triangle`, bit for bit. Of equal distances the triangle of lowest index is returned.
/// Conventions: those of point_on_triangle.h. A non-finite point has no nearest triangle.
/// Complexity and threads: O(n log n) to build on one thread, at most 164 bytes per triangle, with
/// a copy of all triangles; about O(log n) per query. Const functions may be called from several
/// threads.

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

    /// Preconditions: all corners are finite; fewer than 2^32 - 1 triangles. Interruptible
    /// (interruption.h).
    explicit NearestTriangles(const std::vector<Corners>& triangles);

    /// The nearest triangle; none if there are no triangles.
    [[nodiscard]] NearestTriangle nearest(const Vec3& point) const;
    [[nodiscard]] std::size_t size() const { return corners_.size(); }

  private:
    static constexpr std::uint32_t kLeafSize = 4;

    /// A leaf if `count` > 0: triangles [first, first + count). Otherwise the children are the next
    /// node and `first`.
    struct Node {
        Box3 box;
        std::uint32_t first = 0, count = 0;
        /// The cylinder around the centre of the box: unit axis, half height and radius; infinite
        /// if there is none.
        Vec3 axis{0, 0, 1};
        float half_height = std::numeric_limits<float>::infinity();
        float radius = std::numeric_limits<float>::infinity();
    };

    [[nodiscard]] static double least_to_cylinder(const Node& node, const Vec3& point);
    /// `ids`: the triangles of the node.
    static void set_cylinder(Node& node, const std::vector<Corners>& triangles,
                             std::span<const std::uint32_t> ids);
    void build(std::vector<std::uint32_t>& order, const std::vector<Corners>& triangles,
               std::uint32_t begin, std::uint32_t end);

    std::vector<Node> nodes_;         ///< each before its children; the first is the root
    std::vector<Corners> corners_;    ///< in leaf order
    std::vector<std::uint32_t> ids_;  ///< [i] index of the triangle of corners_[i]
};

}  // namespace alhazen
