#pragma once
/// A bounding volume hierarchy over moving objects, with eight children per node.
///
/// Source: Christensen, Fong, Laur and Batali, "Ray Tracing for the Movie 'Cars'", RT 2006, and
/// Glassner, "Spacetime Ray Tracing for Animation", IEEE CG&A 8(2), 1988 (bounds at both ends of
/// the shutter, interpolated at the time of the ray).
/// Differs: each end of a node has the box of its objects at that end; boxes of nonlinear motion
/// are widened at both ends (MovingBox::widen_to). The tree is built by the binary builder of
/// wide_bvh over the boxes at half time, then collapsed. The boxes of a node are interpolated and
/// tested together, in float with a margin for all rounding; hits do not depend on it.
/// Conventions: times from 0 to 1. An object ("thing") is its index among the given boxes.
/// Complexity and threads: O(n log n) to build. Const functions may be called concurrently.

#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/geometry/motion/moving_box.h"
#include "alhazen/geometry/ray.h"

namespace alhazen {

class MotionBvh {
  public:
    static constexpr std::size_t kWidth = 8;
    static constexpr std::uint32_t kLeafBit = 1u << 31;

    struct alignas(64) Node {
        /// [lo, hi][axis][child] at shutter open, and the change until it closes; unused children
        /// have an empty box.
        float open[2][3][kWidth];
        float change[2][3][kWidth];
        std::uint32_t child[kWidth];  ///< a node, or an object's index with kLeafBit
    };
    /// A ray in the frame of the tree, with the largest component of its direction scaled to 1. It
    /// meets the plane at x where `inverse` x - `near` (or `far`), its origin moved by a margin on
    /// either side.
    struct RaySlabs {
        float inverse[3], near[3], far[3];
        std::uint32_t
            near_side[3];  ///< 0: it enters boxes at their lower side; 1: at the upper side
        float time, t_min;
        double
            scale;  ///< factor from distances of the ray to those here; NaN: all boxes are entered

        [[nodiscard]] float reach(double t_max) const {
            const double most = scale * t_max;
            return most < kFar ? round_up(most) : std::numeric_limits<float>::infinity();
        }
        static constexpr double kFar = 1e30;
    };
    /// The order in which objects are visited.
    enum class Order { NearFirst, Any };
    /// `visit(context, thing, reach)` is called for all objects that the ray may hit until it
    /// returns true. `reach`: end of the ray, in distances of the slabs; `visit` may reduce it.
    using Visit = bool (*)(void* context, std::uint32_t thing, float& reach);
    using Traversal = void (*)(const Node* nodes, const RaySlabs&, float reach, Visit,
                               void* context, TraversalStats*);
    struct Traversals {
        Traversal near_first = nullptr, any = nullptr;
    };

    MotionBvh() = default;
    /// Ignores empty boxes.
    explicit MotionBvh(std::span<const MovingBox> boxes);

    /// Calls `visit(thing)` for all objects that the ray may hit at `time` up to `t_max()`, until
    /// it returns true.
    template <Order kOrder, class Reach, class Visitation, class Stats>
    void traverse(const Ray& ray, double time, Reach&& t_max, Visitation&& visit,
                  Stats stats) const;

    [[nodiscard]] std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(Node) + unbounded_.capacity() * sizeof(std::uint32_t);
    }

  private:
    [[nodiscard]] RaySlabs slabs(const Ray& ray, double time) const;

    std::vector<Node> nodes_;
    Traversals traversals_;
    std::vector<std::uint32_t> unbounded_;
    LocalFrame frame_;
};

/// The kernels of the chosen instruction set.
[[nodiscard]] MotionBvh::Traversals motion_bvh_traversals();

template <MotionBvh::Order kOrder, class Reach, class Visitation, class Stats>
void MotionBvh::traverse(const Ray& ray, double time, Reach&& t_max, Visitation&& visit,
                         Stats stats) const {
    for (const std::uint32_t thing : unbounded_) {
        if (visit(thing)) return;
    }
    if (nodes_.empty()) return;
    const RaySlabs slab_ray = slabs(ray, time);
    struct Visitor {
        const RaySlabs& ray;
        std::remove_reference_t<Reach>& t_max;
        std::remove_reference_t<Visitation>& visit;
        double known;  ///< the last value of t_max
    } visitor{slab_ray, t_max, visit, t_max()};
    const Visit call = [](void* context, std::uint32_t thing, float& reach) {
        Visitor& to = *static_cast<Visitor*>(context);
        if (to.visit(thing)) return true;
        const double now = to.t_max();
        if (now != to.known) reach = to.ray.reach(to.known = now);
        return false;
    };
    const Traversal run = kOrder == Order::NearFirst ? traversals_.near_first : traversals_.any;
    run(nodes_.data(), slab_ray, slab_ray.reach(visitor.known), call, &visitor, stats.sink());
}

}  // namespace alhazen
