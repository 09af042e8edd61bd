#pragma once
/// A hierarchy of bounds with any number of children per node, shared by the classic hierarchies.
///
/// Source: Rubin and Whitted, "A 3-Dimensional Representation for Fast Rendering of Complex
/// Scenes", SIGGRAPH 1980 (the hierarchy); Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH
/// 1986, section 3 (division at the median, along x, y and z in turn).
/// Conventions: node 0 is the root; the children of a node are consecutive; every leaf is one
/// primitive with its own bound.

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "alhazen/accel/bounds/bounds.h"
#include "alhazen/base/interruption.h"

namespace alhazen {

template <class B>
struct BoundTree {
    struct Node {
        B bound;
        std::uint32_t first = 0;  ///< its first child, or its primitive
        std::uint32_t count = 0;  ///< number of children; 0: a leaf

        [[nodiscard]] bool is_leaf() const { return count == 0; }
    };
    std::vector<Node> nodes;

    [[nodiscard]] std::size_t memory_bytes() const { return nodes.capacity() * sizeof(Node); }

    /// A tree of two children per node, each with half of the primitives. O(n log n).
    [[nodiscard]] static BoundTree median_split(const BoundsSource& source);
};

namespace bound_tree_detail {

template <class B>
class MedianSplit {
  public:
    explicit MedianSplit(const BoundsSource& source) : order_(source.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        for (std::size_t i = 0; i < source.size(); ++i) {
            bounds_.push_back(B::of(source, i));
            centers_.push_back(source.box(i).center());
        }
        tree_.nodes.reserve(2 * source.size());
    }

    BoundTree<B> run() {
        if (order_.empty()) return {};
        tree_.nodes.emplace_back();
        build(0, 0, order_.size(), 0);
        return std::move(tree_);
    }

  private:
    void build(std::size_t node, std::size_t begin, std::size_t end, int axis) {
        interruption_point();
        if (end - begin == 1) {
            tree_.nodes[node] = {bounds_[order_[begin]], order_[begin], 0};
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) {
            return order_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const double ca = centers_[a][axis], cb = centers_[b][axis];
            return ca != cb ? ca < cb : a < b;
        });
        const std::size_t first = tree_.nodes.size();
        tree_.nodes.resize(first + 2);
        build(first, begin, middle, (axis + 1) % 3);
        build(first + 1, middle, end, (axis + 1) % 3);
        B bound = tree_.nodes[first].bound;
        bound.include(tree_.nodes[first + 1].bound);
        tree_.nodes[node] = {bound, static_cast<std::uint32_t>(first), 2};
    }

    std::vector<std::uint32_t> order_;
    std::vector<B> bounds_;
    std::vector<Vec3> centers_;
    BoundTree<B> tree_;
};

}  // namespace bound_tree_detail

template <class B>
BoundTree<B> BoundTree<B>::median_split(const BoundsSource& source) {
    return bound_tree_detail::MedianSplit<B>(source).run();
}

}  // namespace alhazen
