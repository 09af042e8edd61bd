#pragma once
/// A k-d tree by the surface area heuristic: every node divides its box by an axis-aligned plane;
/// primitives on both sides are stored in both, clipped.
///
/// Source: Kaplan, "Space-Tracing: a Constant Time Ray-Tracer", SIGGRAPH 1985 course notes (the
/// structure); MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", The
/// Visual Computer 6, 1990 (the cost); Wald and Havran, "On Building Fast kd-Trees for Ray Tracing,
/// and on Doing that in O(N log N)", RT 2006 (the builder); Havran, "Heuristic Ray Shooting
/// Algorithms", 2000, section 4 (the traversal with a stack).
/// Differs: every box is slightly widened, so that rounding cannot make a ray miss a cell; rays
/// from so far away that it could are tested against all primitives.
/// Complexity: O(n log n) to build; `build=n2` finds the same tree, bit for bit, in O(n^2).

#include <cstdint>
#include <vector>

#include "alhazen/accel/cells/mailbox.h"
#include "alhazen/accel/cells/plane_walk.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/accelerator_settings.h"
#include "alhazen/accel/core/padded_box.h"
#include "alhazen/accel/core/traversal_trace.h"

namespace alhazen {

class KdTree {
  public:
    static constexpr const char* kName = "kd_tree";
    static constexpr const char* kDescription = "axis-aligned planes by the surface area heuristic";
    static constexpr bool kVisitsRepeatedly = true;
    struct Config {
        double traversal_cost = 15;  ///< cost of a step to a child
        double test_cost = 20;       ///< cost of a primitive
        double empty_factor = 0.8;   ///< cost factor of a split that cuts off empty space
        int max_depth = 0;           ///< 0: 8 + 1.3 log2 n
        bool quadratic = false;      ///< recount for every candidate: the reference builder
        bool mailbox = true;
    };
    [[nodiscard]] static Config configure(SettingsReader& reader);

    [[nodiscard]] static KdTree build(const BoundsSource& source, const Config& config);

    /// A leaf has `axis` 3 and the primitives entries[index .. index + count); an inner node is
    /// followed by its lower child, with the upper one at `index`.
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
    /// The root's box, slightly wider than its contents.
    [[nodiscard]] const Box3& box() const { return space_.box; }
    /// The expected cost, by the heuristic, of a ray that intersects the root's box.
    [[nodiscard]] double expected_cost() const { return expected_cost_; }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + entries_.capacity() * sizeof(std::uint32_t);
    }

  private:
    friend class KdTreeBuilder;
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
    Mailbox mailbox;
    const auto from_plane = [&](const Node& node) {
        return FromPlane{ray.origin[node.axis] - node.plane, span.inverse[node.axis]};
    };
    const auto test_leaf = [&](std::uint32_t number) {
        const Node& leaf = nodes_[number];
        note_cell(stats, number);
        const std::span entries(entries_.data() + leaf.index, leaf.count);
        return visit_entries(entries, config_.mailbox, mailbox, visitor, stats);
    };
    walk_through_planes(nodes_, span, 0.5 * space_.pad, from_plane, test_leaf, visitor, stats);
}
static_assert(Accelerator<KdTree>);

}  // namespace alhazen
