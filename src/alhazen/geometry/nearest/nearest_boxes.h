#pragma once
/// The nearest of many objects with bounding boxes, found by a tree of the boxes searched by
/// distance.
///
/// Source: Roussopoulos, Kelley and Vincent, "Nearest Neighbor Queries", SIGMOD 1995.
/// Differs: a binary tree, divided at the medians of the boxes' centres; objects without bounds are
/// examined first. Of equally near objects the lowest index is returned, whatever the tree.
/// Conventions: the boxes contain the objects; query points are finite.
/// Complexity and threads: O(n log n) to build; const functions may be called from several threads.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "alhazen/geometry/box.h"

namespace alhazen {

class NearestBoxes {
  public:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    explicit NearestBoxes(const std::vector<Box3>& boxes) {
        std::vector<std::uint32_t> bounded;
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            (boxes[i].bounded() ? bounded : unbounded_).push_back(i);
        }
        if (!bounded.empty()) build(boxes, bounded, 0, static_cast<std::uint32_t>(bounded.size()));
        order_ = std::move(bounded);
    }

    /// Returns the index of the nearest object that is nearer than `limit` (a squared distance) and
    /// sets `limit` to its squared distance; kNone if there is none. `squared(i)` is the squared
    /// distance of object i, called for some objects only.
    template <class Squared>
    [[nodiscard]] std::uint32_t nearest(const Vec3& point, double& limit, Squared squared) const {
        std::uint32_t best = kNone;
        const auto look_at = [&](std::uint32_t i) {
            const double d = squared(i);
            if (!(d < limit || (d == limit && best != kNone && i < best))) return;
            limit = d;
            best = i;
        };
        for (const std::uint32_t i : unbounded_) look_at(i);
        if (!nodes_.empty()) visit(0, point, limit, look_at);
        return best;
    }

  private:
    static constexpr std::uint32_t kLeafSize = 2;

    /// A leaf if `count` > 0: order_[first, first + count). Otherwise the children are the next
    /// node and `first`.
    struct Node {
        Box3 box;
        std::uint32_t first = 0, count = 0;
    };

    /// A lower bound of the squared distance to the contents of the box, less a margin for
    /// rounding.
    static double least_squared(const Box3& box, const Vec3& p) {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({box.lo[k] - p[k], p[k] - box.hi[k], 0.0});
            sum += d * d;
        }
        constexpr double kLess = 1.0 - 1e-13;
        return kLess * sum;
    }
    template <class LookAt>
    void visit(std::uint32_t index, const Vec3& point, double& limit, LookAt look_at) const {
        const Node& node = nodes_[index];
        if (least_squared(node.box, point) > limit) return;
        if (node.count > 0) {
            for (std::uint32_t i = 0; i < node.count; ++i) look_at(order_[node.first + i]);
            return;
        }
        const bool swap = least_squared(nodes_[node.first].box, point) <
                          least_squared(nodes_[index + 1].box, point);
        visit(swap ? node.first : index + 1, point, limit, look_at);
        visit(swap ? index + 1 : node.first, point, limit, look_at);
    }
    void build(const std::vector<Box3>& boxes, std::vector<std::uint32_t>& order,
               std::uint32_t begin, std::uint32_t end) {
        const std::size_t index = nodes_.size();
        nodes_.emplace_back();
        Box3 box, middles;
        for (std::uint32_t i = begin; i < end; ++i) {
            box.include(boxes[order[i]].lo);
            box.include(boxes[order[i]].hi);
            middles.include(boxes[order[i]].center());
        }
        nodes_[index].box = box;
        if (end - begin <= kLeafSize) {
            nodes_[index].first = begin;
            nodes_[index].count = end - begin;
            return;
        }
        const Vec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::uint32_t half = begin + (end - begin) / 2;
        std::nth_element(order.begin() + begin, order.begin() + half, order.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             return boxes[a].center()[axis] < boxes[b].center()[axis];
                         });
        build(boxes, order, begin, half);
        nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
        build(boxes, order, half, end);
    }

    std::vector<Node> nodes_;  ///< each before its children; the first is the root
    std::vector<std::uint32_t> order_, unbounded_;
};

}  // namespace alhazen
