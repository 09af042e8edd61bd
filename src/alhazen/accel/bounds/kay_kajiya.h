#pragma once
/// A hierarchy of slabs with common directions, and a heap that always opens the nearest bound
/// next.
///
/// Source: Kay and Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; the traversal as in Foley,
/// van Dam, Feiner and Hughes, "Computer Graphics", 2nd ed., figure 15.59.
/// Differs: bounds behind the nearest hit so far are not pushed onto the heap (Haines, Ray Tracing
/// News); bounds that contain the ray's start have the key t_min.
/// Complexity: O(n log n) to build; the heap holds at most as many bounds as there are primitives.

#include <algorithm>
#include <variant>

#include "alhazen/accel/bounds/depth_first.h"
#include "alhazen/accel/bounds/hierarchy.h"
#include "alhazen/accel/core/accelerator.h"
#include "alhazen/accel/core/traversal_trace.h"

namespace alhazen {

class KayKajiya {
  public:
    static constexpr const char* kName = "kay_kajiya";
    static constexpr const char* kDescription =
        "slabs of common directions, nearest bound first by a heap";
    struct Config {
        int slabs = 7;  ///< 3, 7 or 13
    };
    [[nodiscard]] static Config configure(SettingsReader& reader) {
        static constexpr const char* kSlabs[] = {"3", "7", "13"};
        static constexpr int kCounts[] = {3, 7, 13};
        return {kCounts[reader.choice("slabs", "directions of slabs", 1, kSlabs)]};
    }

    [[nodiscard]] static KayKajiya build(const BoundsSource& source, const Config& config) {
        KayKajiya made;
        made.tree_ = median_split_tree(source, config.slabs == 3   ? NestingBound::Box
                                               : config.slabs == 7 ? NestingBound::Slabs7
                                                                   : NestingBound::Slabs13);
        return made;
    }

    template <class Visitor, class Stats>
    void traverse(const Ray& ray, Visitor& visitor, Stats stats) const {
        std::visit([&](const auto& tree) { by_heap(tree, ray, visitor, stats); }, tree_);
    }

    [[nodiscard]] const AnyBoundTree& tree() const { return tree_; }
    [[nodiscard]] std::size_t memory_bytes() const { return alhazen::memory_bytes(tree_); }

  private:
    template <class B, class Visitor, class Stats>
    static void by_heap(const BoundTree<B>& tree, const Ray& ray, Visitor& visitor, Stats stats) {
        if (tree.nodes.empty()) return;
        const auto farther = [](const ReachedNode& a, const ReachedNode& b) { return a.t > b.t; };
        const typename B::Probe probe(ray);
        ReentrantStack<ReachedNode> heap;
        const auto push_if_met = [&](std::uint32_t node) {
            const auto t = probe.enter(tree.nodes[node].bound, visitor.t_max(), stats);
            note_bound(stats, node, t.has_value());
            if (!t) return;
            heap.push({node, *t});
            std::push_heap(heap.begin(), heap.end(), farther);
            stats.heap_pushes(1);
        };
        push_if_met(0);
        while (!heap.empty()) {
            std::pop_heap(heap.begin(), heap.end(), farther);
            const ReachedNode reached = heap.pop();
            // All remaining bounds lie behind the nearest hit.
            if (reached.t > visitor.t_max()) return;
            const auto& node = tree.nodes[reached.node];
            if (node.is_leaf()) {
                if (visitor.visit(node.first)) return;
                continue;
            }
            stats.nodes(1);
            for (std::uint32_t i = 0; i < node.count; ++i) push_if_met(node.first + i);
        }
    }

    AnyBoundTree tree_;
};
static_assert(Accelerator<KayKajiya>);

}  // namespace alhazen
