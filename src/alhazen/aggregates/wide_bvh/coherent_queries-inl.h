/// Closest hits of coherent rays, packet by packet.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_COHERENT_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_COHERENT_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_COHERENT_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_COHERENT_QUERIES_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <span>

#include "alhazen/accel/wide_bvh/trace/make_packet-inl.h"
#include "alhazen/accel/wide_bvh/trace/traverse_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/packet_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Traces packets, and calls `otherwise(first, count)` for rays in no packet. Rays and results as
/// in WideBvhKernels::closest_batch.
template <class Stats, class Otherwise>
HWY_INLINE void run_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<Hit> results, Stats stats, Otherwise&& otherwise) {
    const WideBvhLayout& layout = *scene.layout;
    // Packets need vertices in the leaves.
    if (layout.is_indexed()) return otherwise(0, rays.size());
    const PrefetchTable prefetch_table(
        layout.tree.nodes.data(),
        {layout.triangles.data(), layout.spheres.data(), layout.frustums.data(),
         layout.others.data()},
        {sizeof(TriangleBlock), sizeof(SphereBlock), sizeof(FrustumBlock), sizeof(BoxBlock)});
    // After a failure some packets are skipped: the more, the more failures in a row.
    std::size_t failures = 0, skip = 0;
    for (std::size_t i = 0; i < rays.size(); i += kPacketRays) {
        const std::size_t count = std::min(kPacketRays, rays.size() - i);
        for (const Ray& next :
             rays.subspan(i + count).first(std::min(kPacketRays, rays.size() - i - count))) {
            hwy::Prefetch(&next);
        }
        if (skip > 0) {
            --skip;
            otherwise(i, count);
            continue;
        }
        // One packet per main axis and sign: six at most.
        std::uint64_t rest = ~std::uint64_t{0} >> (kPacketRays - count), alone = 0;
        while (rest != 0) {
            RayPacket packet;
            std::uint64_t used = rest;
            const bool made = packet.make(layout.frame, rays.subspan(i, count), used);
            if (used == 0) break;  // none can be used
            rest &= ~used;
            alone |= used;
            if (!made || std::popcount(used) < kMinPacketRays) continue;
            ClosestPacket leaves(scene, rays.subspan(i, count), results.subspan(i, count), packet);
            if (!traverse_packet(layout.tree.nodes.data(), layout.tree.root, prefetch_table, packet,
                                 leaves, kMaxPacketWork, stats)) {
                continue;
            }
            leaves.finish(stats);
            alone &= ~used;
        }
        alone |= rest;
        if (alone == ~std::uint64_t{0} >> (kPacketRays - count)) {
            failures = std::min<std::size_t>(failures + 1, kMaxPacketBackoff);
            skip = (std::size_t{1} << failures) - 1;
            otherwise(i, count);
            continue;
        }
        failures = 0;
        for (; alone != 0; alone &= alone - 1) {
            otherwise(i + static_cast<std::size_t>(std::countr_zero(alone)), 1);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
