#pragma once
/// Traversal of a tree whose nodes are divided by planes: nearer cells first, farther cells on a
/// stack.
///
/// Source: Havran, "Heuristic Ray Shooting Algorithms", 2000, section 4 (the traversal with a
/// stack).
/// Differs: visits both sides if the ray runs within the rounding margin of a plane.
/// Conventions: the lower child of a node follows it, the upper one is at `index`.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "alhazen/accel/core/padded_box.h"
#include "alhazen/accel/core/reentrant_stack.h"

namespace alhazen {

/// The distance of a ray from a plane along its normal, and its inverse speed in that direction;
/// infinite if parallel to the plane.
struct FromPlane {
    double distance, inverse;
};

/// A part of a ray, and the node whose cell contains it.
struct RaySegment {
    std::uint32_t node;
    double begin, end;
};

/// `from_plane(node)` gives the ray relative to the node's plane; `test_leaf(number)` returns true
/// to stop.
template <class Node, class FromPlaneOf, class TestLeaf, class Visitor, class Stats>
void walk_through_planes(const std::vector<Node>& nodes, const RaySpan& span, double margin,
                         const FromPlaneOf& from_plane, const TestLeaf& test_leaf,
                         const Visitor& visitor, Stats stats) {
    ReentrantStack<RaySegment> stack;
    stack.push({0, span.begin, span.end});
    while (!stack.empty()) {
        RaySegment at = stack.pop();
        // Continues the loop: for a ray that runs in a plane, nearer segments may lie deeper in the
        // stack.
        if (at.begin > visitor.t_max()) continue;
        for (;;) {
            const Node& node = nodes[at.node];
            stats.nodes(1);
            if (node.is_leaf()) break;
            const FromPlane from = from_plane(node);
            const std::uint32_t lower = at.node + 1, upper = node.index;
            if (std::isinf(from.inverse)) {
                if (from.distance > margin) {
                    at.node = upper;
                } else {
                    if (from.distance >= -margin) stack.push({upper, at.begin, at.end});
                    at.node = lower;
                }
                continue;
            }
            const bool up = from.inverse > 0.0;
            const std::uint32_t first = up ? lower : upper, second = up ? upper : lower;
            const double t = -from.distance * from.inverse;
            const double slack = margin * std::abs(from.inverse);
            if (t - slack > at.end) {
                at.node = first;
            } else if (t + slack < at.begin) {
                at.node = second;
            } else {
                stack.push({second, std::max(at.begin, t - slack), at.end});
                at.node = first;
                at.end = std::min(at.end, t + slack);
            }
        }
        if (test_leaf(at.node)) return;
    }
}

}  // namespace alhazen
