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
#include "alhazen/accel/padded_box.h"
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
    [[nodiscard]] const Box3& box() const { return space_.box; }
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
    PaddedBox space_;
    std::uint32_t primitives_ = 0;
    double expected_cost_ = 0;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> entries_;
};

template <class Visitor, class Stats>
void KdTree::traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
    if (nodes_.empty()) return;
    if (!space_.covers(ray)) return visit_all(primitives_, visitor);
    const RaySpan span(space_.box, ray, visitor.t_max());
    if (span.empty()) return;
    const Vec3& inverse = span.inverse;

    Mailbox mailbox;
    ReentrantStack<Segment> stack;
    stack.push({0, span.begin, span.end});
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
            const double room = space_.pad * 0.5;
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
        const std::span entries(entries_.data() + leaf.index, leaf.count);
        if (visit_entries(entries, config_.mailbox, mailbox, visitor, stats)) return;
    }
}
static_assert(Accelerator<KdTree>);

}  // namespace alhazen
