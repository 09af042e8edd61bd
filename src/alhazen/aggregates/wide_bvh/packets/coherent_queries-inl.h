/// Closest hits of coherent rays, or whether they hit anything, packet by packet.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_COHERENT_QUERIES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_COHERENT_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_COHERENT_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_COHERENT_QUERIES_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <span>

#include "alhazen/accel/wide_bvh/trace/make_packet-inl.h"
#include "alhazen/accel/wide_bvh/trace/traverse_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_prefetch-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The packets of a batch that are tried. After a failure some are not: the more, the more failures
/// in a row, those of earlier batches among them.
class PacketTrials {
  public:
    explicit PacketTrials(PacketFailures* memory) : memory_(memory) {
        if (memory == nullptr) return;
        const std::uint32_t kept = memory->load(std::memory_order_relaxed);
        failures_ = kept % kPlaces;
        skip_ = kept / kPlaces;
    }
    ~PacketTrials() {
        if (memory_ != nullptr)
            memory_->store(skip_ * kPlaces + failures_, std::memory_order_relaxed);
    }
    PacketTrials(const PacketTrials&) = delete;
    PacketTrials& operator=(const PacketTrials&) = delete;

    [[nodiscard]] bool skips() {
        if (skip_ == 0) return false;
        --skip_;
        return true;
    }
    void tried(bool failed) {
        failures_ = failed ? std::min(failures_ + 1, kMaxPacketBackoff) : 0;
        skip_ = (1u << failures_) - 1;
    }

  private:
    static constexpr std::uint32_t kPlaces = 16;
    static_assert(kMaxPacketBackoff < kPlaces);
    PacketFailures* memory_;
    std::uint32_t failures_ = 0, skip_ = 0;
};

/// Whether the stream traces coherent rays in no packet, and not one by one.
inline bool streams_coherent(const WideBvhScene& scene, std::size_t count) {
    return count >= kMinStreamRays && scene.layout->memory_bytes() > kMaxSingleTreeBytes;
}

/// Bits of the rays that are to be traced.
HWY_INLINE std::uint64_t wanted_rays(std::span<const Hit> results) {
    return ~std::uint64_t{0} >> (kPacketRays - results.size());
}
HWY_INLINE std::uint64_t wanted_rays(std::span<const bool> occluded) {
    std::uint64_t wanted = 0;
    for (std::size_t i = 0; i < occluded.size(); ++i) {
        wanted |= std::uint64_t{!occluded[i]} << i;
    }
    return wanted;
}

struct PacketOutcome {
    std::uint64_t alone;  ///< rays that are left
    bool slow;            ///< no faster than rays one by one
};

/// Traces up to 64 rays, those of `wanted`: one packet per main axis and sign, six at most.
template <class Leaves, class Result, class Stats>
HWY_NOINLINE PacketOutcome trace_packets(const WideBvhScene& scene,
                                         const PrefetchTable& prefetch_table,
                                         std::span<const Ray> rays, std::span<Result> results,
                                         std::uint64_t wanted, Stats stats) {
    const WideBvhLayout& layout = *scene.layout;
    std::uint64_t rest = wanted, alone = 0;
    std::uint32_t work = 0;
    while (rest != 0) {
        RayPacket packet;
        std::uint64_t used = rest;
        const bool made = packet.make(layout.frame, rays, used);
        if (used == 0) break;  // none can be used
        rest &= ~used;
        alone |= used;
        const auto count = static_cast<std::uint32_t>(std::popcount(used));
        if (!made || count < kMinPacketRays) continue;
        Leaves leaves(scene, rays, results, packet);
        const bool done = traverse_packet<Leaves::kOrdered>(
            layout.tree.nodes.data(), layout.tree.root, prefetch_table, packet, leaves,
            Leaves::kWork.most * count, stats);
        work += leaves.work;
        if (!done) continue;
        leaves.finish(stats);
        alone &= ~used;
    }
    alone |= rest;
    const auto traced = static_cast<std::uint32_t>(std::popcount(wanted & ~alone));
    return {alone, work > Leaves::kWork.fair * traced || (traced == 0 && wanted != 0)};
}

/// Whether packets in lanes of `rays` rays are as fast as the stream. A ray that goes on alone
/// costs about fourteen visits in lanes; packets that not more than every third ray leaves always
/// pay.
[[nodiscard]] HWY_INLINE bool pays(const LaneWork& work, std::size_t rays) {
    return work.together >= 14 * work.alone || 3 * work.alone <= rays;
}

/// The rays of packets that are tried together.
inline constexpr std::size_t kTriedRays = 256;

/// Traces packets in lanes, and calls `otherwise(i, 1)` for rays that do not fit in, whose results
/// are then those of `sink` (lane_hits-inl.h). `kTries`: calls apart(first, count) for rays that go
/// in no packets, as those before them did not pay.
template <class Leaves, bool kTries, class Sink, class Stats, class Otherwise, class Apart>
HWY_INLINE void run_lanes(const WideBvhScene& scene, const GivenRays& rays, const Sink& sink,
                          Stats stats, Otherwise&& otherwise, [[maybe_unused]] Apart&& apart) {
    const WideBvhLayout& layout = *scene.layout;
    const NodeRef root = layout.tree.root;
    TreeBox box;
    if (!Stats::kCounts && !root.is_leaf()) {
        const FrameSlack& slack = layout.frame.slack;
        box = TreeBox(layout.tree.nodes[root.index()], slack.slab, slack);
    }
    const LaneBatch batch{
        scene, prefetch_table_of<WideNode::kWidth>(layout), {layout.frame, rays}, box};
    PacketTrials trials(kTries ? scene.failures : nullptr);
    for (std::size_t i = 0; i < rays.size();) {
        const std::size_t end = kTries ? std::min(i + kTriedRays, rays.size()) : rays.size();
        if constexpr (kTries) {
            if (trials.skips()) {
                apart(i, end - i);
                i = end;
                continue;
            }
        }
        const std::size_t first = i;
        LaneWork work;
        for (; i < end; i += kPacketLanes) {
            const std::size_t count = std::min(kPacketLanes, rays.size() - i);
            if (rays.size() - i - count >= kPacketLanes) rays.prefetch<kPacketLanes>(i + count);
            typename Leaves::Results results;
            const std::uint32_t wanted = sink.begin(i, count, results);
            std::uint32_t alone =
                trace_lanes<Leaves>(batch, rays.part(i, count), results, wanted, work, stats);
            sink.end(i, count, results);
            for (; alone != 0; alone &= alone - 1) {
                otherwise(i + static_cast<std::size_t>(std::countr_zero(alone)), 1);
            }
        }
        if constexpr (kTries) trials.tried(!pays(work, end - first));
    }
}

/// Traces all of them in packets.
template <class Leaves, class Sink, class Stats, class Otherwise>
HWY_INLINE void run_lanes(const WideBvhScene& scene, const GivenRays& rays, const Sink& sink,
                          Stats stats, Otherwise&& otherwise) {
    run_lanes<Leaves, false>(scene, rays, sink, stats, otherwise, [](std::size_t, std::size_t) {});
}

/// Whether a tree has packets in lanes, for any hit or for closest hits.
template <bool kAnyHit>
HWY_INLINE bool has_lane_packets(const WideBvhScene& scene) {
    constexpr std::size_t kRegisters = kParts<float, 16>;
    if constexpr (!kAnyHit && kRegisters > kMostLaneRegisters) return false;
    // Packets need vertices in the leaves.
    return !scene.layout->is_indexed() &&
           coherent_traversal(*scene.layout, kAnyHit, kRegisters, scene.others_alone) ==
               CoherentTraversal::Lanes;
}

/// Hits of rays in no packet that are cleared together, before their rays are traced, so that they
/// stay in the cache.
inline constexpr std::size_t kClearedTogether = 512;

/// Traces packets, and calls `otherwise(first, count)` for rays in no packet, apart(first, count)
/// for those of any hit that are better off in the stream. Rays and results as in
/// WideBvhKernels::closest_batch and occluded_batch, except that lanes write to `sink`.
template <class Leaves, class InLanes, class Result, class Sink, class Stats, class Otherwise,
          class Apart>
HWY_INLINE void run_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<Result> results, const Sink& sink, Stats stats,
                             Otherwise&& otherwise, Apart&& apart) {
    const WideBvhLayout& layout = *scene.layout;
    constexpr bool kAnyHit = !InLanes::kOrdered;
    if constexpr (kAnyHit || kParts<float, 16> <= kMostLaneRegisters) {
        if (has_lane_packets<kAnyHit>(scene)) {
            // Counts must not depend on which packets pay.
            constexpr bool kTries = kAnyHit && !Stats::kCounts;
            return run_lanes<InLanes, kTries>(scene, GivenRays(rays), sink, stats, otherwise,
                                              apart);
        }
    }
    if (layout.is_indexed() || coherent_traversal(layout, kAnyHit, kParts<float, 16>,
                                                  scene.others_alone) == CoherentTraversal::Alone) {
        for (std::size_t i = 0; i < rays.size(); i += kClearedTogether) {
            const std::size_t count = std::min(kClearedTogether, rays.size() - i);
            clear_unset(sink, i, count);
            otherwise(i, count);
        }
        return;
    }
    const PrefetchTable prefetch_table = prefetch_table_of<WideNode::kWidth>(layout);
    PacketTrials trials(scene.failures);
    for (std::size_t i = 0; i < rays.size(); i += kPacketRays) {
        const std::size_t count = std::min(kPacketRays, rays.size() - i);
        clear_unset(sink, i, count);
        for (const Ray& next :
             rays.subspan(i + count).first(std::min(kPacketRays, rays.size() - i - count))) {
            hwy::Prefetch(&next);
        }
        if (trials.skips()) {
            otherwise(i, count);
            continue;
        }
        const std::span<Result> here = results.subspan(i, count);
        const std::uint64_t wanted = wanted_rays(here);
        const PacketOutcome outcome = trace_packets<Leaves>(
            scene, prefetch_table, rays.subspan(i, count), here, wanted, stats);
        trials.tried(outcome.slow);
        if (outcome.alone == ~std::uint64_t{0} >> (kPacketRays - count)) {
            otherwise(i, count);
            continue;
        }
        for (std::uint64_t alone = outcome.alone; alone != 0; alone &= alone - 1) {
            otherwise(i + static_cast<std::size_t>(std::countr_zero(alone)), 1);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
