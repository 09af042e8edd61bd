/// The queries of the wide BVH aggregate by packets of rays in lanes: triangles against all rays of
/// a set, all else ray by ray.
///
/// Source: traverse_lanes-inl.h, lane_filter-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LANE_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LANE_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LANE_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LANE_QUERIES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <type_traits>

#include "alhazen/accel/wide_bvh/trace/traverse_lanes-inl.h"
#include "alhazen/aggregates/wide_bvh/lane_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/packet_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The candidates of the rays of a packet. Most rays have one: it is kept in lanes, further ones in
/// a list.
class LaneCandidates {
  public:
    HWY_INLINE LaneCandidates() { store_lanes(PacketFloats(kNone), lo_); }

    /// Adds a triangle for the rays of `candidates`; a kept one beyond the s_max of its ray is
    /// replaced. False when the list is full: then nothing is done.
    [[nodiscard]] HWY_INLINE bool add(TrianglePlace place, std::uint32_t candidates,
                                      const PacketFloats& begin, const PacketRow& s_max) {
        const PacketFloats lo = load_row(lo_), none(kNone);
        // A NaN goes to the list, where it is never replaced.
        const PacketMask keep = lanes_of_bits<float, kPacketLanes>(candidates) & (begin < none) &
                                ((lo > load_row(s_max)) | (lo >= none));
        const std::uint32_t rest = candidates & ~bits_of(keep);
        if (HWY_UNLIKELY(rest != 0)) {
            if (beside_count_ == kMaxBeside) return false;
            Beside& beside = beside_[beside_count_++];
            store_lanes(begin, beside.lo);
            beside.lanes = rest;
            beside.place = place;
        }
        store_lanes(select_lanes(keep, begin, lo), lo_);
        store_lanes(select_lanes(keep, PacketFloats(std::bit_cast<float>(place)), load_row(place_)),
                    place_);
        return true;
    }

    /// Calls `resolve(lanes, places)` for the candidates up to `s_max`, or only those of the list,
    /// and drops them.
    template <class Resolve>
    HWY_INLINE void take_all(const PacketRow& s_max, Resolve&& resolve) {
        const PacketFloats lo = load_row(lo_);
        const std::uint32_t lanes = bits_of((lo < PacketFloats(kNone)) & (lo <= load_row(s_max)));
        if (lanes != 0) {
            alignas(64) TrianglePlace places[kPacketLanes];
            std::memcpy(places, place_, sizeof(places));
            resolve(lanes, places);
        }
        store_lanes(PacketFloats(kNone), lo_);
        take_beside(s_max, resolve);
    }
    template <class Resolve>
    HWY_INLINE void take_beside(const PacketRow& s_max, Resolve&& resolve) {
        for (std::size_t n = 0; n < beside_count_; ++n) {
            const Beside& b = beside_[n];
            // Written so that a NaN is not passed over.
            const std::uint32_t lanes = b.lanes & ~bits_of(load_row(b.lo) > load_row(s_max));
            if (lanes == 0) continue;
            alignas(64) TrianglePlace places[kPacketLanes];
            for (TrianglePlace& place : places) place = b.place;
            resolve(lanes, places);
        }
        beside_count_ = 0;
    }

  private:
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    static constexpr std::size_t kMaxBeside = 16;
    struct alignas(64) Beside {
        PacketRow lo;
        std::uint32_t lanes;
        TrianglePlace place;
    };
    alignas(64) PacketRow lo_;     ///< kNone: none
    alignas(64) PacketRow place_;  ///< bits of a TrianglePlace
    std::size_t beside_count_ = 0;
    Beside beside_[kMaxBeside];
};

/// The leaves of a packet in lanes. `Derived` offers `found(block, lane, place, result, stats)` for
/// triangles and `take(lane, query)` for a ray that has been alone; `Query` is the query of one
/// ray.
template <class Derived, class Query, class Result>
class LaneLeaves {
  public:
    static constexpr bool kOrdered = Query::kOrdered;

    HWY_INLINE LaneLeaves(const WideBvhScene& scene, std::span<const Ray> rays,
                          std::span<Result> results, LanePacket& packet)
        : scene_(scene),
          rays_(rays),
          results_(results),
          packet_(packet),
          resolution_(scene, packet, rays) {}

    template <class Stats>
    HWY_INLINE void visit(NodeRef ref, std::uint32_t lanes, Stats stats) {
        if (static_cast<LeafType>(ref.kind()) != LeafType::Triangles) {
            return go_alone(ref, lanes, stats);
        }
        bool changed = false;
        for (std::uint32_t i = 0; i < ref.count() && lanes != 0; ++i) {
            changed |= visit_triangles(ref.offset() + i, lanes, stats);
        }
        if (changed) derived().left();
    }
    template <class Stats>
    HWY_NOINLINE void go_alone(NodeRef ref, std::uint32_t lanes, Stats stats) {
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(lanes));
            if ((been_alone_ >> i & 1) == 0) {
                new (&places_[i]) Query(scene_, rays_[i], results_[i]);
                been_alone_ |= 1u << i;
            }
            Query& query = query_of(i);
            derived().limit(i, query);
            const bool stopped = traverse<kOrdered>(scene_.layout->tree.nodes.data(), ref,
                                                    query.slabs, query, stats);
            derived().take(i, query, stopped);
        }
        derived().left();
    }

  protected:
    HWY_INLINE Derived& derived() { return static_cast<Derived&>(*this); }

    /// Rays that need no more leave `lanes`.
    template <class Stats>
    HWY_INLINE bool visit_triangles(std::uint32_t number, std::uint32_t& lanes, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        bool changed = false;
        for (std::uint32_t met = meet_triangles(block, packet_); met != 0; met &= met - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(met));
            if (!block.ids[lane].used()) break;
            if (!scene_.sees(block.ids[lane].id())) continue;
            stats.primitives(static_cast<std::uint64_t>(std::popcount(lanes)));
            FilteredLanes found;
            if (!filter_lanes(block, lane, packet_, lanes, found)) continue;
            lanes &= ~derived().found(static_cast<TrianglePlace>(number * kBlockWidth + lane),
                                      found, stats);
            changed = true;
            if (lanes == 0) break;
        }
        return changed;
    }
    /// Exact resolution: see PacketResolution.
    template <class Hits, class Stats>
    HWY_INLINE void resolve(std::uint32_t lanes, const TrianglePlace* places, Hits&& hits,
                            Stats stats) {
        for (std::size_t half = 0; half < kPacketHalves; ++half) {
            const std::uint32_t here = lanes >> (half * kRayLanes) & kAllLanes;
            if (here != 0) resolution_.resolve(half, here, places + half * kRayLanes, hits, stats);
        }
    }

    const WideBvhScene& scene_;
    std::span<const Ray> rays_;
    std::span<Result> results_;
    LanePacket& packet_;
    std::uint32_t been_alone_ = 0;  ///< rays that have a query
    HWY_INLINE Query& query_of(std::size_t i) {
        return *std::launder(reinterpret_cast<Query*>(&places_[i]));
    }

  private:
    static_assert(std::is_trivially_destructible_v<Query>);
    struct alignas(Query) Place {
        std::byte bytes[sizeof(Query)];
    };
    Place places_[kPacketLanes];
    PacketResolution<LanePacket> resolution_;
};

/// The closest hits.
class ClosestLanes : public LaneLeaves<ClosestLanes, ClosestQuery<FilteredTriangleTest>, Hit> {
  public:
    using Query = ClosestQuery<FilteredTriangleTest>;

    HWY_INLINE ClosestLanes(const WideBvhScene& scene, std::span<const Ray> rays,
                            std::span<Hit> best, LanePacket& packet)
        : LaneLeaves(scene, rays, best, packet) {
        const LocalParameter parameter{scene.layout->frame.scale, 0.0};
        for (std::size_t i = 0; i < best.size(); ++i) {
            if (HWY_LIKELY(!best[i].found())) continue;
            packet.s_max[i] = std::min(packet.s_max[i], parameter.above(best[i].t));
            packet.rays[i / kRayLanes].t_max[i % kRayLanes] = best[i].t;
        }
    }

    HWY_INLINE std::uint32_t wanting(float entry) const {
        return bits_of(PacketFloats(entry) <= load_row(packet_.s_max));
    }
    template <class Stats>
    HWY_INLINE std::uint32_t found(TrianglePlace place, const FilteredLanes& found, Stats stats) {
        const PacketMask sure = lanes_of_bits<float, kPacketLanes>(found.sure);
        const PacketFloats s_max = load_row(packet_.s_max);
        store_lanes(select_lanes(sure, min_lanes(found.hi, s_max), s_max), packet_.s_max);
        while (HWY_UNLIKELY(!candidates_.add(place, found.candidates, found.lo, packet_.s_max))) {
            candidates_.take_beside(packet_.s_max,
                                    [&](std::uint32_t lanes, const TrianglePlace* places)
                                        HWY_ATTR { decide(lanes, places, stats); });
        }
        return 0;
    }
    HWY_INLINE void left() { packet_.shrink(); }
    HWY_INLINE void limit(std::size_t i, Query& query) const {
        query.s_max = std::min(query.s_max, packet_.s_max[i]);
    }
    HWY_INLINE void take(std::size_t i, const Query& query, bool) {
        packet_.s_max[i] = std::min(packet_.s_max[i], query.s_max);
    }
    /// Resolves all candidates.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        candidates_.take_all(packet_.s_max, [&](std::uint32_t lanes, const TrianglePlace* places)
                                                HWY_ATTR { decide(lanes, places, stats); });
        for (; been_alone_ != 0; been_alone_ &= been_alone_ - 1) {
            query_of(static_cast<std::size_t>(std::countr_zero(been_alone_))).finish(stats);
        }
    }

  private:
    template <class Stats>
    HWY_INLINE void decide(std::uint32_t lanes, const TrianglePlace* places, Stats stats) {
        resolve(lanes, places, OfferedHits{results_}, stats);
    }

    LaneCandidates candidates_;
};

/// Which rays hit anything. A ray that does leaves the packet.
class OccludedLanes : public LaneLeaves<OccludedLanes, OccludedQuery<FilteredTriangleTest>, bool> {
  public:
    using Query = OccludedQuery<FilteredTriangleTest>;

    HWY_INLINE OccludedLanes(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<bool> occluded, LanePacket& packet)
        : LaneLeaves(scene, rays, occluded, packet) {}

    HWY_INLINE std::uint32_t wanting(float) const { return wanting_; }
    template <class Stats>
    HWY_INLINE std::uint32_t found(TrianglePlace place, const FilteredLanes& found, Stats stats) {
        stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(found.sure)));
        std::uint32_t hit = found.sure;
        for (std::uint32_t rest = hit; rest != 0; rest &= rest - 1) {
            results_[static_cast<std::size_t>(std::countr_zero(rest))] = true;
        }
        const std::uint32_t unsure = found.candidates & ~found.sure;
        if (unsure != 0) {
            alignas(64) TrianglePlace places[kPacketLanes];
            for (TrianglePlace& p : places) p = place;
            resolve(unsure, places, Dropped{results_, hit}, stats);
        }
        wanting_ &= ~hit;
        return hit;
    }
    HWY_INLINE void left() {}
    HWY_INLINE void limit(std::size_t, Query&) const {}
    HWY_INLINE void take(std::size_t i, const Query&, bool stopped) {
        if (stopped) wanting_ &= ~(1u << i);
    }
    template <class Stats>
    HWY_INLINE void finish(Stats) {}

  private:
    struct Dropped {
        std::span<bool> results;
        std::uint32_t& hit;
        void operator()(std::size_t i, PrimitiveId, const ShapeHit&) const {
            results[i] = true;
            hit |= 1u << i;
        }
    };

    std::uint32_t wanting_ = ~0u;
};

/// Traces up to sixteen rays, those of `wanted`; bits of those that are left to be traced alone.
template <class Leaves, class Result, class Stats>
HWY_NOINLINE std::uint32_t trace_lanes(const WideBvhScene& scene,
                                       const PrefetchTable& prefetch_table,
                                       std::span<const Ray> rays, std::span<Result> results,
                                       std::uint32_t wanted, Stats stats) {
    const WideBvhLayout& layout = *scene.layout;
    LanePacket packet;
    std::uint32_t rest = packet.load(layout.frame, rays, wanted);
    const std::uint32_t alone = wanted & ~rest;
    if (rest == 0) return alone;
    Leaves leaves(scene, rays, results, packet);
    while (rest != 0) {
        const std::uint32_t set = packet.choose_set(rest);
        rest &= ~set;
        traverse_lanes(layout.tree.nodes.data(), layout.tree.root, prefetch_table, packet, set,
                       kMinPacketLanes, leaves, stats);
        leaves.finish(stats);  // while the main axis is that of the set
    }
    return alone;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
