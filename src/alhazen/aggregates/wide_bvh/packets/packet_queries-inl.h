/// The queries of the wide BVH aggregate on the leaves, for frustum packets: each triangle and each
/// shape against eight rays.
///
/// Source: packet_filter-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_QUERIES_INL_H_
#endif

#include <array>
#include <bit>
#include <span>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/block_boxes-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_candidates-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/schedule.h"
#include "alhazen/primitives/primitive_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The leaves of a packet. `Derived` has `found(group number, block, lane, place, result, stats)`
/// for triangles, `meet(id, group number, stats)` for shapes, and `left(groups)`, which is called
/// after a leaf with the groups that it changed and returns true to stop. Shapes are tested eight
/// rays at a time too, against the groups that intersect their box.
template <class Derived>
class PacketLeaves {
  public:
    HWY_INLINE PacketLeaves(const WideBvhScene& scene, std::span<const Ray> rays, RayPacket& packet)
        : scene_(scene), packet_(packet), resolution_(scene, packet, GivenRays(rays)) {}

    std::uint32_t work = 0;  ///< see traverse_packet

    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, std::uint32_t groups, Stats stats) {
        changed_ = 0;
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                for (std::uint32_t i = 0; i < ref.count(); ++i) {
                    visit_triangles(ref.offset() + i, groups, stats);
                }
                break;
            case LeafType::Spheres:
                visit_shapes(&scene_.layout->spheres[ref.offset()], ref.count(), groups, stats);
                break;
            case LeafType::Frustums:
                visit_shapes(&scene_.layout->frustums[ref.offset()], ref.count(), groups, stats);
                break;
            case LeafType::Others:
                visit_shapes(&scene_.layout->others[ref.offset()], ref.count(), groups, stats);
                break;
        }
        return changed_ != 0 && derived().left(changed_);
    }

  protected:
    HWY_INLINE Derived& derived() { return static_cast<Derived&>(*this); }

    template <class Stats>
    HWY_INLINE void visit_triangles(std::uint32_t number, std::uint32_t groups, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        ShearedBlock seen(block, packet_);
        work += 4;
        // Byte g: the triangles that group g may hit.
        std::uint64_t pairs = 0;
        std::uint32_t any = 0;
        for (; groups != 0; groups &= groups - 1) {
            const auto g = static_cast<std::size_t>(std::countr_zero(groups));
            const std::uint32_t triangles = seen.seen_by(packet_, g);
            pairs |= std::uint64_t{triangles} << (8 * g);
            any |= triangles;
        }
        if (any == 0) return;
        seen.find_edges(packet_);
        for (; any != 0; any &= any - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(any));
            if (!block.ids[lane].used()) return;
            if (!scene_.sees(block.ids[lane].id())) continue;
            const ShearedTriangle triangle(seen, packet_, lane,
                                           static_cast<TrianglePlace>(number * kBlockWidth + lane));
            std::uint64_t rest = pairs >> lane & 0x0101010101010101u;
            work += static_cast<std::uint32_t>(std::popcount(rest));
            for (; rest != 0; rest &= rest - 1) {
                const auto g = static_cast<std::size_t>(std::countr_zero(rest)) / 8;
                const RayGroup& group = packet_.groups[g];
                stats.primitives(static_cast<std::uint64_t>(std::popcount(group.used)));
                FilteredGroup found;
                if (!filter_group(triangle, group, found)) continue;
                if (derived().found(g, block, lane, triangle.place, found, stats)) {
                    changed_ |= 1u << g;
                }
            }
        }
    }

    /// Tests shapes and instances, the nearest first, each against the groups of rays that may meet
    /// it.
    template <class Block, class Stats>
    HWY_NOINLINE void visit_shapes(const Block* blocks, std::uint32_t count, std::uint32_t among,
                                   Stats stats) {
        for (const Block* end = blocks + count; blocks < end; ++blocks) {
            work += 4;
            const BlockBoxes boxes(*blocks);
            Floats nearest;
            std::uint32_t rest = packet_.intersect_boxes(boxes.rows(), nearest);
            HWY_ALIGN float depth[kBlockWidth];
            store_lanes(nearest, depth);
            while (rest != 0) {
                const std::size_t lane = lane_of_least(rest, depth);
                rest &= ~(1u << lane);
                if (!blocks->ids[lane].used()) continue;
                const BlockBoxes::Bounds b = boxes.bounds(lane);
                std::uint32_t groups =
                    among & packet_.intersect_groups(&boxes.rows()[0][lane], kBlockWidth);
                if (groups != 0) groups &= packet_.intersect_ball(b.center, b.radius);
                work += Derived::kWork.shape * static_cast<std::uint32_t>(std::popcount(groups));
                changed_ |= visit_shape(blocks->ids[lane].id(), groups, stats);
            }
        }
    }

    const WideBvhScene& scene_;
    RayPacket& packet_;
    PacketResolution<RayPacket> resolution_;
    std::uint32_t changed_ = 0;  ///< groups that the current leaf has changed

  private:
    /// Returns the groups that it changed.
    template <class Stats>
    HWY_INLINE std::uint32_t visit_shape(PrimitiveId id, std::uint32_t groups, Stats stats) {
        std::uint32_t changed = 0;
        for (; groups != 0; groups &= groups - 1) {
            const auto g = static_cast<std::size_t>(std::countr_zero(groups));
            if (derived().meet(id, g, stats)) changed |= 1u << g;
        }
        // Hits hide primitives behind them.
        if (changed != 0) (void)derived().left(changed);
        return changed;
    }
};

/// The closest hits.
class ClosestPacket : public PacketLeaves<ClosestPacket> {
  public:
    static constexpr bool kOrdered = true;
    static constexpr PacketWork kWork = kClosestPacketWork;

    HWY_INLINE ClosestPacket(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<Hit> best, RayPacket& packet)
        : PacketLeaves(scene, rays, packet), results_(best), candidates_(packet) {
        const LocalParameter parameter{scene.layout->frame.scale, 0.0};
        bool any = false;
        for (std::size_t i = 0; i < best.size(); ++i) {
            if (HWY_LIKELY(!best[i].found())) continue;
            packet.limit(i, parameter.above(best[i].t));
            packet.rays[i / kGroupRays].t_max[i % kGroupRays] = best[i].t;
            any = true;
        }
        if (any) packet.shrink_all();
    }

    template <class Stats>
    HWY_INLINE bool found(std::size_t g, const TriangleBlock& block, std::size_t lane,
                          TrianglePlace place, FilteredGroup& found, Stats stats) {
        RayGroup& group = packet_.groups[g];
        // The finer bound takes less time than the exact test of the rays near an edge.
        if ((bits_of(found.candidates) & ~bits_of(found.sure) & group.used) != 0) {
            work += 3;
            if (!refine_group(block, lane, packet_, group, found)) return false;
        }
        const GroupFloats s_max = load_lanes<kGroupRays>(group.s_max);
        store_lanes(select_lanes(found.sure, min_lanes(found.hi, s_max), s_max), group.s_max);
        while (HWY_UNLIKELY(!candidates_.add(g, place, found.candidates, found.lo))) {
            candidates_.take_overflow(
                [&](std::size_t group_number, std::uint32_t lanes, const TrianglePlace* places)
                    HWY_ATTR { resolve(group_number, lanes, places, stats); });
        }
        return true;
    }
    template <class Stats>
    HWY_INLINE bool meet(PrimitiveId id, std::size_t g, Stats stats) {
        const std::uint32_t changed =
            closest_of_lanes(*scene_.table, id, packet_.rays[g], packet_.groups[g].used,
                             results_.subspan(g * kGroupRays), {stats.sink(), scene_.mask});
        if (changed == 0) return false;
        packet_.limit_group(g, scene_.layout->frame.scale);
        return true;
    }
    HWY_INLINE bool left(std::uint32_t changed) {
        packet_.shrink(changed);
        return false;
    }

    /// Resolves all candidates.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        candidates_.take_all([&](std::size_t g, std::uint32_t lanes, const TrianglePlace* places)
                                 HWY_ATTR { resolve(g, lanes, places, stats); });
    }

  private:
    template <class Stats>
    HWY_INLINE void resolve(std::size_t g, std::uint32_t lanes, const TrianglePlace* places,
                            Stats stats) {
        resolution_.resolve(g, lanes, places, OfferedHits{results_}, stats);
    }

    std::span<Hit> results_;
    PacketCandidates candidates_;
};

/// The occlusion of rays. An occluded ray becomes unused.
class OccludedPacket : public PacketLeaves<OccludedPacket> {
  public:
    static constexpr bool kOrdered = false;
    static constexpr PacketWork kWork = kOccludedPacketWork;

    HWY_INLINE OccludedPacket(const WideBvhScene& scene, std::span<const Ray> rays,
                              std::span<bool> occluded, RayPacket& packet)
        : PacketLeaves(scene, rays, packet), results_(occluded) {}

    template <class Stats>
    HWY_INLINE bool found(std::size_t g, const TriangleBlock& block, std::size_t lane,
                          TrianglePlace place, FilteredGroup& filtered, Stats stats) {
        const RayGroup& group = packet_.groups[g];
        std::uint32_t sure = bits_of(filtered.sure) & group.used;
        std::uint32_t rest = bits_of(filtered.candidates) & group.used & ~sure;
        if (rest != 0) {
            FilteredGroup fine;
            work += 3;
            if (refine_group(block, lane, packet_, group, fine)) {
                sure |= bits_of(fine.sure) & rest;
                rest &= bits_of(fine.candidates) & ~sure;
            } else {
                rest = 0;
            }
        }
        stats.primitive_hits(static_cast<std::uint64_t>(std::popcount(sure)));
        for (std::uint32_t hit = sure; hit != 0; hit &= hit - 1) {
            drop(g * kGroupRays + static_cast<std::size_t>(std::countr_zero(hit)));
        }
        if (HWY_UNLIKELY(rest != 0)) {
            TrianglePlace places[kGroupRays];
            for (TrianglePlace& p : places) p = place;
            resolution_.resolve(g, rest, places, Dropped{*this}, stats);
        }
        return (sure | rest) != 0;
    }
    template <class Stats>
    HWY_INLINE bool meet(PrimitiveId id, std::size_t g, Stats stats) {
        RayGroup& group = packet_.groups[g];
        if (group.used == 0) return false;
        std::array<Hit, kGroupRays> hits;
        (void)closest_of_lanes(*scene_.table, id, packet_.rays[g], group.used, hits,
                               {stats.sink(), scene_.mask});
        bool any = false;
        for (std::size_t i = 0; i < kGroupRays; ++i) {
            if (!hits[i].found()) continue;
            drop(g * kGroupRays + i);
            any = true;
        }
        return any;
    }
    /// True if no ray is left.
    HWY_INLINE bool left(std::uint32_t changed) {
        for (; changed != 0; changed &= changed - 1) {
            const auto g = static_cast<std::size_t>(std::countr_zero(changed));
            if (packet_.groups[g].used == 0) packet_.finish(1u << g);
        }
        return packet_.reaching(-std::numeric_limits<float>::max()) == 0;
    }
    template <class Stats>
    HWY_INLINE void finish(Stats) {}

  private:
    struct Dropped {
        OccludedPacket& packet;
        void operator()(std::size_t i, PrimitiveId, const ShapeHit&) const { packet.drop(i); }
    };
    HWY_INLINE void drop(std::size_t ray) {
        results_[ray] = true;
        packet_.groups[ray / kGroupRays].used &= ~(1u << ray % kGroupRays);
    }

    std::span<bool> results_;
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
