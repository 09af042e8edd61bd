#pragma once
/// Depth-first traversal of a hierarchy of bounds, with the children of a node in stored order or
/// the nearest first.
///
/// Source: Foley, van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., section 15.10.2,
/// HIER_traverse.
/// Differs: uses a stack instead of recursion; a bound that begins behind the nearest hit is
/// skipped when it is popped (Haines, Ray Tracing News).

#include <algorithm>

#include "alhazen/accel/bounds/bound_tree.h"
#include "alhazen/accel/core/reentrant_stack.h"
#include "alhazen/accel/core/traversal_trace.h"

namespace alhazen {

enum class ChildOrder : std::uint8_t { Stored, NearestFirst };

/// A node to visit, and the t at which the ray enters it.
struct ReachedNode {
    std::uint32_t node;
    double t;
};

template <class B, class Visitor, class Stats>
void traverse_depth_first(const BoundTree<B>& tree, ChildOrder order, const Ray& ray,
                          Visitor& visitor, Stats stats) {
    if (tree.nodes.empty()) return;
    const typename B::Probe probe(ray);
    ReentrantStack<ReachedNode> stack;
    const auto root = probe.enter(tree.nodes[0].bound, visitor.t_max(), stats);
    note_bound(stats, 0, root.has_value());
    if (!root) return;
    stack.push({0, *root});
    while (!stack.empty()) {
        const ReachedNode reached = stack.pop();
        if (reached.t > visitor.t_max()) continue;
        const auto& node = tree.nodes[reached.node];
        if (node.is_leaf()) {
            if (visitor.visit(node.first)) return;
            continue;
        }
        stats.nodes(1);
        const std::size_t before = stack.size();
        // In reverse, so that the first child is on top.
        for (std::uint32_t i = node.count; i-- > 0;) {
            const auto t = probe.enter(tree.nodes[node.first + i].bound, visitor.t_max(), stats);
            note_bound(stats, node.first + i, t.has_value());
            if (t) stack.push({node.first + i, *t});
        }
        if (order == ChildOrder::NearestFirst) {
            std::stable_sort(stack.begin() + before, stack.end(),
                             [](const ReachedNode& a, const ReachedNode& b) { return a.t > b.t; });
        }
    }
}

}  // namespace alhazen
