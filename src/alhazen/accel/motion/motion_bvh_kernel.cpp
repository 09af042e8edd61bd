#include "alhazen/accel/motion/motion_bvh.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/accel/motion/motion_bvh_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <bit>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// A ray in registers.
struct RayLanesOf {
    Floats time, inverse[3], near[3], far[3];

    HWY_INLINE explicit RayLanesOf(const MotionBvh::RaySlabs& ray) : time(ray.time) {
        for (std::size_t k = 0; k < 3; ++k) {
            inverse[k] = Floats(ray.inverse[k]);
            near[k] = Floats(ray.near[k]);
            far[k] = Floats(ray.far[k]);
        }
    }
};

/// Planes of one side of the boxes at the time of the ray.
HWY_INLINE Floats plane_at(const MotionBvh::Node& node, std::size_t side, std::size_t axis,
                           const Floats& time) {
    return mul_add(time, load_lanes(node.change[side][axis]), load_lanes(node.open[side][axis]));
}

/// The set of children that the ray meets up to `reach` (bit i for child i); `entries`: distances
/// of entry.
HWY_INLINE std::uint32_t met_children(const MotionBvh::Node& node, const RayLanesOf& ray,
                                      const std::uint32_t* near_side, float t_min, float reach,
                                      float* entries) {
    Floats enter(t_min), exit(reach);
    ALHAZEN_UNROLL
    for (std::size_t k = 0; k < 3; ++k) {
        const Floats near = plane_at(node, near_side[k], k, ray.time);
        const Floats far = plane_at(node, 1 - near_side[k], k, ray.time);
        enter = max_lanes(enter, mul_sub(near, ray.inverse[k], ray.near[k]));
        exit = min_lanes(exit, mul_sub(far, ray.inverse[k], ray.far[k]));
    }
    store_lanes(enter, entries);
    return bits_of(enter <= exit);
}

/// Bound of the levels of the tree: binary ones up to 48, from which sets are halved.
constexpr std::size_t kMostLevels = 80;

/// `Ordered`: near children first; else in stored order, which is cheaper.
template <bool Ordered>
void traverse_motion(const MotionBvh::Node* nodes, const MotionBvh::RaySlabs& ray, float reach,
                     MotionBvh::Visit visit, void* context, TraversalStats* stats) {
    static_assert(MotionBvh::kWidth == kLaneCount);
    struct Reached {
        std::uint32_t node;
        float enter;
    };
    Reached waiting[kMostLevels * (MotionBvh::kWidth - 1) + MotionBvh::kWidth];
    std::size_t count = 0;
    const RayLanesOf lanes(ray);
    alignas(64) float entries[MotionBvh::kWidth];
    for (std::uint32_t current = 0;;) {
        if ((current & MotionBvh::kLeafBit) == 0) {
            const MotionBvh::Node& node = nodes[current];
            if (stats != nullptr) {
                ++stats->node_visits;
                stats->box_tests += MotionBvh::kWidth;
            }
            std::uint32_t met = met_children(node, lanes, ray.near_side, ray.t_min, reach, entries);
            if (met != 0 && (met & (met - 1)) == 0) {
                current = node.child[std::countr_zero(met)];
                continue;
            }
            [[maybe_unused]] const std::size_t before = count;
            for (; met != 0; met &= met - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(met));
                // Sorted so that the nearest is last: insertion into the few entries of this node.
                std::size_t at = count++;
                if constexpr (Ordered) {
                    for (; at > before && waiting[at - 1].enter < entries[i]; --at) {
                        waiting[at] = waiting[at - 1];
                    }
                }
                waiting[at] = {node.child[i], entries[i]};
            }
        } else if (visit(context, current & ~MotionBvh::kLeafBit, reach)) {
            return;
        }
        do {
            if (count == 0) return;
            --count;
        } while (waiting[count].enter > reach);
        current = waiting[count].node;
    }
}

}  // namespace

MotionBvh::Traversals traverse_motion_kernels() {
    return {&traverse_motion<true>, &traverse_motion<false>};
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(traverse_motion_kernels);

MotionBvh::Traversals motion_bvh_traversals() {
    return ALHAZEN_KERNEL(traverse_motion_kernels)();
}

}  // namespace alhazen
#endif
