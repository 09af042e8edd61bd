/// The queries of the wide BVH aggregate by packets of rays in lanes: closest hits and any hit.
///
/// Source: traverse_lanes-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_QUERIES_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

#include "alhazen/accel/wide_bvh/trace/traverse_lanes-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_candidates-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_hits-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_leaves-inl.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"
#include "alhazen/primitives/unused_shear.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The closest hits.
class ClosestLanes : public LaneLeaves<ClosestLanes> {
  public:
    static constexpr bool kOrdered = true;
    using Results = LaneHits;

    HWY_INLINE ClosestLanes(const WideBvhScene& scene, const PrefetchTable* in_turn,
                            const GivenRays& rays, LaneHits& hits, LanePacket& packet)
        : LaneLeaves(scene, in_turn, rays, packet), hits_(hits) {
        if (HWY_LIKELY(hits.earlier() == 0)) return;
        for (std::size_t group = 0; group < kLaneGroups; ++group) packet.lay_out(group, rays);
        for (std::uint32_t rest = hits.earlier(); rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            packet.s_max[i] = std::min(packet.s_max[i], parameter().above(hits.t(i)));
            packet.rays[i / kRayLanes].t_max[i % kRayLanes] = hits.t(i);
        }
    }

    HWY_INLINE std::uint32_t wanting(float entry) const {
        return bits_of(PacketFloats(entry) <= load_row(packet_.s_max));
    }
    [[nodiscard]] HWY_INLINE bool wants(std::uint32_t) const { return true; }
    template <class Stats>
    HWY_INLINE std::uint32_t found(TrianglePlace place, const FilteredLanes& found, Stats stats) {
        const PacketMask sure = lanes_of_bits<float, kPacketLanes>(found.sure);
        const PacketFloats before = load_row(packet_.s_max);
        const PacketFloats s_max = select_lanes(sure, min_lanes(found.hi, before), before);
        store_lanes(s_max, packet_.s_max);
        add(place, found.candidates, found.lo, s_max, stats);
        return 0;
    }
    template <class Stats>
    HWY_INLINE bool triangles(std::size_t i, std::uint32_t number, const FilteredTriangles& found,
                              float& s_max, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            // Written so that a NaN is not passed over.
            if (!block.ids[lane].used() || found.lo[lane] > s_max) continue;
            if (!scene_.sees(block.ids[lane].id())) continue;
            if ((found.sure >> lane & 1) != 0 && found.hi[lane] < s_max) {
                limit(i, s_max = found.hi[lane]);
            }
            add(static_cast<TrianglePlace>(number * kBlockWidth + lane), 1u << i,
                PacketFloats(found.lo[lane]), load_row(packet_.s_max), stats);
            scene_.expect(block.ids[lane]);
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool sure(std::size_t i, float hi, float& s_max, Stats) {
        if (hi < s_max) limit(i, s_max = hi);
        return false;
    }
    HWY_INLINE bool accept(std::size_t i, PrimitiveId id, const ShapeHit& hit, float& s_max) {
        if (!hits_.wins(i, hit.t, id)) return false;
        hits_.offer(i, id, hit);
        s_max = std::min(s_max, parameter().above(hit.t));
        limit(i, s_max);
        return false;
    }
    template <class Stats>
    HWY_NOINLINE bool shape(std::size_t i, PrimitiveId id, float& s_max, Stats stats) {
        Hit best;
        best.t = hits_.t(i);
        best.primitive = hits_.id(i);
        Ray scratch, ray = rays_.ray(i, scratch);
        if (best.found()) ray.t_max = best.t;
        const double last = ray.t_max;
        scene_.table->closest(id, ray, kUnusedShear, best, stats, scene_.mask);
        if (best.found()) hits_.offer(i, best.primitive, best);
        if (ray.t_max == last) return false;
        s_max = std::min(s_max, parameter().above(ray.t_max));
        limit(i, s_max);
        return false;
    }
    HWY_INLINE void left() { packet_.shrink(); }
    /// Resolves all candidates.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        candidates_.take_all(packet_.s_max, [&](std::uint32_t lanes, const TrianglePlace* places)
                                                HWY_ATTR { decide(lanes, places, stats); });
    }

  private:
    /// What PacketResolution gives the hits to.
    struct Offered {
        LaneHits& best;
        void operator()(std::size_t i, PrimitiveId id, const ShapeHit& hit) const {
            best.offer(i, id, hit);
        }
        template <std::size_t N>
        HWY_INLINE void take(std::size_t n, std::uint32_t lanes, const Lanes<float, N>& ids,
                             const PairVerdicts<N>& verdicts) const {
            best.offer_triangles(n, lanes, ids, verdicts.t, verdicts.u, verdicts.v);
        }
    };

    [[nodiscard]] HWY_INLINE LocalParameter parameter() const {
        return {scene_.layout->frame.scale, 0.0};
    }
    /// As a whole: parts of a row that was stored as a whole, and then read so, are waited for. The
    /// ray may have been limited more by another of its subtrees.
    HWY_INLINE void limit(std::size_t i, float s_max) {
        const PacketFloats before = load_row(packet_.s_max);
        store_lanes(select_lanes(lanes_of_bits<float, kPacketLanes>(1u << i),
                                 min_lanes(PacketFloats(s_max), before), before),
                    packet_.s_max);
    }
    template <class Stats>
    HWY_INLINE void add(TrianglePlace place, std::uint32_t candidates, const PacketFloats& begin,
                        const PacketFloats& s_max, Stats stats) {
        while (HWY_UNLIKELY(!candidates_.add(place, candidates, begin, s_max))) {
            candidates_.take_overflow(packet_.s_max,
                                      [&](std::uint32_t lanes, const TrianglePlace* places)
                                          HWY_ATTR { decide(lanes, places, stats); });
        }
    }
    template <class Stats>
    HWY_INLINE void decide(std::uint32_t lanes, const TrianglePlace* places, Stats stats) {
        resolve(lanes, places, Offered{hits_}, stats);
    }

    LaneHits& hits_;
    LaneCandidates candidates_;
};

/// Which rays hit anything. A ray that does leaves the packet.
class OccludedLanes : public LaneLeaves<OccludedLanes> {
  public:
    static constexpr bool kOrdered = false;
    using Results = LaneOcclusion;

    HWY_INLINE OccludedLanes(const WideBvhScene& scene, const PrefetchTable* in_turn,
                             const GivenRays& rays, LaneOcclusion& results, LanePacket& packet)
        : LaneLeaves(scene, in_turn, rays, packet), results_(results) {}

    [[nodiscard]] HWY_INLINE bool wants(std::uint32_t i) const { return (wanting_ >> i & 1) != 0; }

    HWY_INLINE std::uint32_t wanting(float) const { return wanting_; }
    template <class Stats>
    HWY_INLINE std::uint32_t found(TrianglePlace place, const FilteredLanes& found, Stats stats) {
        stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(found.sure)));
        std::uint32_t hit = found.sure;
        const std::uint32_t unsure = found.candidates & ~found.sure;
        if (unsure != 0) {
            alignas(64) TrianglePlace places[kPacketLanes];
            set_places(place, places);
            resolve(unsure, places, Dropped{hit}, stats);
        }
        wanting_ &= ~hit;
        return hit;
    }
    template <class Stats>
    HWY_INLINE bool triangles(std::size_t i, std::uint32_t number, const FilteredTriangles& found,
                              float&, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const BlockId id = block.ids[static_cast<std::size_t>(std::countr_zero(rest))];
            if (!id.used() || !scene_.sees(id.id())) continue;
            stats.primitive_hits(1);
            return drop(i);
        }
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (!block.ids[lane].used() || !scene_.sees(block.ids[lane].id())) continue;
            alignas(64) TrianglePlace places[kPacketLanes];
            set_places(static_cast<TrianglePlace>(number * kBlockWidth + lane), places);
            std::uint32_t hit = 0;
            resolve(1u << i, places, Dropped{hit}, stats);
            if (hit != 0) return drop(i);
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool sure(std::size_t i, float, float&, Stats stats) {
        stats.primitives(1);
        stats.primitive_hits(1);
        return drop(i);
    }
    HWY_INLINE bool accept(std::size_t i, PrimitiveId, const ShapeHit&, float&) { return drop(i); }
    template <class Stats>
    HWY_NOINLINE bool shape(std::size_t i, PrimitiveId id, float&, Stats stats) {
        Ray scratch;
        const bool hit =
            scene_.table->occluded(id, rays_.ray(i, scratch), kUnusedShear, stats, scene_.mask);
        return hit && drop(i);
    }
    /// Rays that certainly hit a shape.
    HWY_INLINE void drop_all(std::uint32_t lanes) { wanting_ &= ~lanes; }
    /// False if the rays cannot wait for the test of a shape that the filter is not sure of.
    template <class Block>
    HWY_INLINE bool put_off(const Block& block, std::size_t lane, std::uint32_t rays) {
        return waiting_.add(block, lane, rays, 0.0f);
    }
    HWY_INLINE void left() {}
    /// Tests the shapes that wait.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        (void)waiting_.take_all(
            [&](const auto& block, std::uint32_t lane, std::uint32_t rays, float) HWY_ATTR {
                const std::uint32_t rest = rays & wanting_;
                if (rest != 0) (void)this->meet(block, lane, rest, stats);
                return false;
            });
        results_.hit = ~wanting_;
    }

  private:
    struct Dropped {
        std::uint32_t& hit;
        void operator()(std::size_t i, PrimitiveId, const ShapeHit&) const { hit |= 1u << i; }
    };

    HWY_INLINE bool drop(std::size_t i) {
        wanting_ &= ~(1u << i);
        return true;
    }

    LaneOcclusion& results_;
    std::uint32_t wanting_ = ~0u;
    WaitingShapes<32> waiting_;
};

/// What the packets of a batch have in common.
struct LaneBatch {
    const WideBvhScene& scene;
    PrefetchTable prefetch_table;
    LaneFrame frame;
    TreeBox box;  ///< rays that leave it are not traced; of rays that are counted, none
};

/// Traces up to kPacketLanes rays, those of `wanted`; bits of those that are left to be traced
/// alone.
template <class Leaves, class Stats>
HWY_NOINLINE std::uint32_t trace_lanes(const LaneBatch& batch, const GivenRays& rays,
                                       typename Leaves::Results& results, std::uint32_t wanted,
                                       LaneWork& work, Stats stats) {
    const WideBvh& tree = batch.scene.layout->tree;
    LanePacket packet;
    // Shadow rays end in one point, if in any.
    std::uint32_t rest = packet.load(batch.frame, batch.box, rays, wanted, Leaves::kOrdered);
    const std::uint32_t alone = wanted & ~rest;
    if (rest == 0) return alone;
    Leaves leaves(batch.scene, batch.scene.waits ? &batch.prefetch_table : nullptr, rays, results,
                  packet);
    const bool waits = batch.scene.waits;
    const int least = Leaves::kOrdered && !waits ? kMinClosestLanes : kMinPacketLanes;
    while (rest != 0) {
        const std::uint32_t set = packet.choose_set(rest);
        rest &= ~set;
        traverse_lanes(tree.nodes.data(), tree.root, batch.prefetch_table, packet, set, least,
                       leaves, work, stats);
        // While the axes are those of the set.
        if (leaves.any_alone()) leaves.trace_alone(stats);
        leaves.finish(stats);
    }
    return alone;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
