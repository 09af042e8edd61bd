#pragma once
/// A tree of boxes around things that move while the shutter is open, with eight children per node.
///
/// Source: Christensen, Fong, Laur and Batali, "Ray Tracing for the Movie 'Cars'", RT 2006, and
/// Glassner, "Spacetime Ray Tracing for Animation", IEEE CG&A 8(2), 1988 (bounds at both ends of
/// the shutter, interpolated at the time of the ray).
/// Differs: each end of a node has the box of its things at that end; what does not move linearly
/// is widened at both ends (MovingBox::widen_to). The tree is built by the binary builder of
/// wide_bvh over the boxes at half time, then collapsed. Rays are computed in double, boxes are
/// stored in float; the boxes of a node are interpolated and tested together.
/// Conventions: times from 0 to 1. A thing is its number among the boxes given.
/// Complexity and threads: O(n log n) to build. Const functions may be called from many threads.

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/accel/core/reentrant_stack.h"
#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/geometry/motion/moving_box.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class MotionBvh {
  public:
    static constexpr std::size_t kWidth = 8;

    struct alignas(64) Node {
        /// [open, close][axis][child]; unused children have an empty box.
        float lo[2][3][kWidth];
        float hi[2][3][kWidth];
        std::uint32_t child[kWidth];  ///< a node, or a thing with kLeafBit
    };
    /// A ray in the frame of the tree, its origin moved by a margin on either side of the slabs.
    struct RaySlabs {
        double near_origin[3], far_origin[3], inverse[3];
        bool negative[3];
        double time;
    };
    struct alignas(64) Entries {
        double enter[kWidth];
    };
    /// Which children the ray meets between `t_min` and `t_max`: bit i for child i.
    using Kernel = std::uint32_t (*)(const Node&, const RaySlabs&, double t_min, double t_max,
                                     Entries&);

    MotionBvh() = default;
    /// Ignores empty boxes.
    explicit MotionBvh(std::span<const MovingBox> boxes);

    /// Calls `visit(thing)` for all that the ray may hit at `time` up to `t_max()`, near ones first,
    /// until it returns true.
    template <class Reach, class Visit, class Stats>
    void traverse(const Ray& ray, double time, Reach&& t_max, Visit&& visit, Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + unbounded_.capacity() * sizeof(std::uint32_t);
    }

  private:
    static constexpr std::uint32_t kLeafBit = 1u << 31;
    [[nodiscard]] RaySlabs slabs(const Ray& ray, double time) const;

    std::vector<Node> nodes_;
    Kernel kernel_ = nullptr;
    std::vector<std::uint32_t> unbounded_;
    LocalFrame frame_;
};

/// The kernel for the chosen instruction set.
[[nodiscard]] MotionBvh::Kernel motion_bvh_kernel();

template <class Reach, class Visit, class Stats>
void MotionBvh::traverse(const Ray& ray, double time, Reach&& t_max, Visit&& visit,
                         Stats stats) const {
    for (const std::uint32_t thing : unbounded_) {
        if (visit(thing)) return;
    }
    if (nodes_.empty()) return;
    struct Reached {
        std::uint32_t node;
        double enter;
    };
    const RaySlabs slab_ray = slabs(ray, time);
    ReentrantStack<Reached> stack;
    stack.push({0, ray.t_min});
    Entries entries;
    while (!stack.empty()) {
        const Reached reached = stack.pop();
        if (reached.enter > t_max()) continue;
        if ((reached.node & kLeafBit) != 0) {
            if (visit(reached.node & ~kLeafBit)) return;
            continue;
        }
        const Node& node = nodes_[reached.node];
        stats.nodes(1);
        stats.boxes(kWidth);
        const std::size_t before = stack.size();
        std::uint32_t met = kernel_(node, slab_ray, ray.t_min, t_max(), entries);
        for (; met != 0; met &= met - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(met));
            stack.push({node.child[i], entries.enter[i]});
            // The nearest on top: insertion into the few that this node has added.
            for (auto at = stack.end() - 1;
                 at != stack.begin() + before && (at - 1)->enter < at->enter; --at) {
                std::swap(*at, *(at - 1));
            }
        }
    }
}

}  // namespace alhazen
