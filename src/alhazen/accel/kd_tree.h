#pragma once
/// A k-d tree by the surface area heuristic: every node divides its box by a plane across an axis,
/// and primitives on both sides go into both, clipped to them.
///
/// Source: Kaplan, "Space-Tracing: a Constant Time Ray-Tracer", SIGGRAPH 1985 course notes (the
/// structure); MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The
/// Visual Computer 6, 1990 (the cost); Wald and Havran, "On Building Fast kd-Trees for Ray Tracing,
/// and on Doing that in O(N log N)", RT 2006 (the builder); Havran, "Heuristic Ray Shooting
/// Algorithms", 2000, section 4 (the traversal with a stack). Differs: every box is widened a
/// little, so that rounding cannot lead a ray past a cell; rays from so far away that it could are
/// tested against everything. Complexity: O(n log n) to build; `build=n2` finds the same tree, bit
/// for bit, in O(n^2).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "alhazen/accel/accelerator.h"
#include "alhazen/accel/accelerator_settings.h"
#include "alhazen/accel/mailbox.h"
#include "alhazen/accel/reentrant_stack.h"
#include "alhazen/accel/traversal_trace.h"

namespace alhazen {

class KdTree {
  public:
    static constexpr const char* kName = "kd_tree";
    static constexpr const char* kDescription =
        "planes across the axes by the surface area heuristic";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        double traversal_cost = 15;  ///< of a step to a child
        double test_cost = 20;       ///< of a primitive
        double empty_factor = 0.8;   ///< of the cost of a split that cuts off empty space
        int max_depth = 0;           ///< 0: 8 + 1.3 log2 n
        bool quadratic =
            false;  ///< count anew for every candidate: the oracle of the other builder
        bool mailbox = true;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    [[nodiscard]] static KdTree build(const BoundsSource& source, const Config& config);

    /// A leaf has `axis` 3 and the primitives entries[index .. index + count); an inner node its
    /// lower child right after it and the upper one at `index`.
    struct Node {
        double plane = 0;
        std::uint32_t index = 0;
        std::uint32_t count = 0;
        std::uint8_t axis = 3;

        [[nodiscard]] bool is_leaf() const { return axis == 3; }
        friend bool operator==(const Node&, const Node&) = default;
    };
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<std::uint32_t>& entries() const { return entries_; }
    /// The root's, a little wider than what is in it.
    [[nodiscard]] const Box3& box() const { return box_; }
    /// The expected cost of a ray that meets the root's box, by the heuristic.
    [[nodiscard]] double expected_cost() const { return expected_cost_; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + entries_.capacity() * sizeof(std::uint32_t);
    }

  private:
    friend class KdTreeBuilder;
    struct Segment {
        std::uint32_t node;
        double begin, end;
    };

    Config config_;
    Box3 box_;
    double pad_ = 0;
    std::uint32_t primitives_ = 0;
    double expected_cost_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> entries_;
};

template <class Visitor, class Stats>
void KdTree::traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
    if (nodes_.empty()) return;
    if (max_component(abs(ray.origin)) > 0x1p44 * pad_) {
        for (std::uint32_t i = 0; i < primitives_; ++i) {
            if (visitor.visit(i)) return;
        }
        return;
    }
    double begin = ray.t_min, end = visitor.t_max();
    Vec3 inverse;
    for (int k = 0; k < 3; ++k) {
        inverse[k] = 1.0 / ray.direction[k];
        // Also for components so small that only infinity tells how far they lead.
        if (std::isinf(inverse[k])) {
            if (ray.origin[k] < box_.lo[k] || ray.origin[k] > box_.hi[k]) return;
            continue;
        }
        const double a = (box_.lo[k] - ray.origin[k]) * inverse[k];
        const double b = (box_.hi[k] - ray.origin[k]) * inverse[k];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    if (begin > end) return;

    Mailbox mailbox;
    ReentrantStack<Segment> stack;
    stack.push({0, begin, end});
    while (!stack.empty()) {
        Segment at = stack.pop();
        // Not the end: where the ray runs in a plane, nearer segments may lie deeper in the stack.
        if (at.begin > visitor.t_max()) continue;
        for (;;) {
            const Node& node = nodes_[at.node];
            stats.nodes(1);
            if (node.is_leaf()) break;
            const int axis = node.axis;
            const double from = ray.origin[axis] - node.plane;
            // Both sides where the ray runs within the room for rounding of the plane.
            const double room = pad_ * 0.5;
            const std::uint32_t lower = at.node + 1, upper = node.index;
            if (std::isinf(inverse[axis])) {
                if (from > room) {
                    at.node = upper;
                } else {
                    if (from >= -room) stack.push({upper, at.begin, at.end});
                    at.node = lower;
                }
                continue;
            }
            const bool up = ray.direction[axis] > 0.0;
            const std::uint32_t first = up ? lower : upper, second = up ? upper : lower;
            const double t = -from * inverse[axis];
            const double slack = room * std::abs(inverse[axis]);
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
        const Node& leaf = nodes_[at.node];
        note_cell(stats, at.node);
        if (leaf.count == 0) stats.empty_cells(1);
        for (std::uint32_t e = leaf.index; e < leaf.index + leaf.count; ++e) {
            if (config_.mailbox && !mailbox.is_new(entries_[e])) {
                stats.mailbox_saved(1);
                continue;
            }
            if (visitor.visit(entries_[e])) return;
        }
    }
}
static_assert(Accelerator<KdTree>);

}  // namespace alhazen
