#pragma once
/// A tree of boxes over points in the plane that tests whether a triangle contains an active point.
///
/// Source: Bentley, "Multidimensional Binary Search Trees Used for Associative Searching", CACM 18,
/// 1975; boxes are culled by separating axes, Gottschalk, Lin, Manocha, "OBBTree", SIGGRAPH 1996.
/// Differs: a complete tree without links, with tight boxes; every node stores the number of its
/// active points, so that parts without any are skipped.
/// Conventions: a point in or on a triangle is inside, by exact signs; a point equal to one of its
/// corners is not. A triangle without area contains the points of its line.
/// Complexity and threads: build O(n log n), activate O(log n), find O(sqrt n) for evenly spread
/// points and O(n) at worst; tests() counts the tests made. No locking.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

class PointTree {
  public:
    /// A tree over `points[id]` for the given ids, none of them active. Keeps `points` by
    /// reference.
    PointTree(const std::vector<Vec2>& points, std::vector<std::uint32_t> ids);

    /// Activates or deactivates the point with one of the given ids.
    void activate(std::uint32_t id, bool active);

    /// True if the counter-clockwise triangle a, b, c contains an active point.
    [[nodiscard]] bool any_in(Vec2 a, Vec2 b, Vec2 c) const;

    /// Number of boxes and points tested so far.
    [[nodiscard]] std::uint64_t tests() const { return tests_; }

  private:
    struct Node {
        Vec2 lo, hi;
        std::uint32_t active = 0;
    };
    struct Query;
    void build(std::size_t node, std::size_t first_leaf, std::size_t leaves);
    [[nodiscard]] bool any_in_leaf(const Query& query, std::size_t leaf) const;

    const std::vector<Vec2>& points_;
    std::vector<std::uint32_t> ids_;       ///< in leaf order
    std::vector<bool> active_;             ///< [position in ids_]
    std::vector<std::uint32_t> place_of_;  ///< [id] its index in ids_
    std::vector<Node> nodes_;              ///< [1] the root; [2k], [2k + 1] the children of k
    std::size_t leaf_count_ = 1;           ///< a power of two; index of the first leaf
    mutable std::uint64_t tests_ = 0;
};

}  // namespace alhazen
