/// The leaves of a packet of rays in lanes: each triangle or shape (lane_shapes-inl.h) against all
/// rays of a set, and rays that go on alone in a subtree.
///
/// Source: traverse_lanes-inl.h, lane_filter-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_LEAVES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_LEAVES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_LEAVES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <limits>
#include <new>

#include "alhazen/accel/wide_bvh/trace/traverse-inl.h"
#include "alhazen/accel/wide_bvh/trace/traverse_lanes-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/lone_ray-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_pinhole-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_shapes-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_resolution-inl.h"
#include "alhazen/shapes/core/first_hit.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The leaves of a packet in lanes. `Derived` offers
/// - `found(place, result, stats)`: a triangle and the rays that it may be hit by; returns those
///   that need no more
/// - `triangles`, `shape`, `sure`: for one ray, as in lone_ray-inl.h
/// - `accept(lane, id, hit, s_max)`: a ray hits a shape; true if it needs no more
/// - `left()`: a leaf has limited rays
template <class Derived>
class LaneLeaves : public LaneShapes<Derived> {
    using Base = LaneShapes<Derived>;

  public:
    /// `in_turn`: null if rays that go on alone do not wait for memory.
    HWY_INLINE LaneLeaves(const WideBvhScene& scene, const PrefetchTable* in_turn,
                          const GivenRays& rays, LanePacket& packet)
        : Base(scene, rays, packet), in_turn_(in_turn), resolution_(scene, packet, rays) {}

    template <class Stats>
    HWY_INLINE void visit(NodeRef ref, std::uint32_t lanes, Stats stats) {
        const WideBvhLayout& layout = *scene_.layout;
        const std::uint32_t count = ref.count();
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                break;
            case LeafType::Spheres:
                return Base::visit_shapes(&layout.spheres[ref.offset()], count, lanes, stats);
            case LeafType::Frustums:
                return Base::visit_shapes(&layout.frustums[ref.offset()], count, lanes, stats);
            case LeafType::Others:
                return Base::visit_shapes(&layout.others[ref.offset()], count, lanes, stats);
        }
        bool changed = false;
        for (std::uint32_t i = 0; i < count && lanes != 0; ++i) {
            changed |= visit_triangles(ref.offset() + i, lanes, stats);
        }
        if (changed) derived().left();
    }
    /// Takes rays through a subtree one by one; in turn, and later, if they would wait for memory.
    template <class Stats>
    HWY_NOINLINE void go_alone(NodeRef ref, std::uint32_t lanes, Stats stats) {
        for (; lanes != 0; lanes &= lanes - 1) {
            const auto i = static_cast<std::uint32_t>(std::countr_zero(lanes));
            if (in_turn_ != nullptr) {
                if (HWY_UNLIKELY(alone_count_ == kMostAlone)) trace_alone(stats);
                alone_[alone_count_++] = {ref, i};
                continue;
            }
            LoneRay<Derived> ray(scene_, packet_, i, derived());
            if (ref.is_leaf()) {
                if (!ray.visit(ref, stats)) ray.finish(stats);
                continue;
            }
            if (!traverse<Derived::kOrdered>(scene_.layout->tree.nodes.data(), ref, ray.slabs,
                                             Follows::Nothing, ray, stats)) {
                ray.finish(stats);
            }
        }
        if (in_turn_ == nullptr) derived().left();
    }
    /// The first crossing of a ray with a sphere.
    template <class Stats>
    HWY_INLINE bool sphere(std::size_t i, PrimitiveId id, const Sphere& sphere, float& s_max,
                           Stats stats) {
        SphereCrossings met;
        Ray scratch;
        const Verdict verdict = resolve_sphere(ray_of(i, scratch), sphere, met);
        if (HWY_UNLIKELY(verdict == Verdict::Unsure)) return derived().shape(i, id, s_max, stats);
        stats.primitives(1);
        if (verdict == Verdict::Missed) return false;
        stats.primitive_hits(1);
        return derived().accept(i, id, {met.t[0], 0, 0, 0}, s_max);
    }
    /// That with a shape of a known kind without a placement.
    template <class S, class Stats>
    HWY_NOINLINE bool first_of(std::size_t i, PrimitiveId id, const S& shape, float& s_max,
                               Stats stats) {
        stats.primitives(1);
        Ray scratch;
        ShapeHit hit;
        if (!find_first_hit(shape, ray_of(i, scratch), hit)) return false;
        stats.primitive_hits(1);
        return derived().accept(i, id, hit, s_max);
    }
    [[nodiscard]] HWY_INLINE bool any_alone() const { return alone_count_ != 0; }
    /// Traces the rays that are to go on alone: those in leaves, which have been fetched meanwhile,
    /// then those in nodes, several in turn as the stream does. A ray may be in turn in several
    /// subtrees.
    template <class Stats>
    HWY_NOINLINE void trace_alone(Stats stats) {
        std::size_t in_nodes = 0;
        for (std::size_t n = 0; n < alone_count_; ++n) {
            const AloneIn in = alone_[n];
            if (!in.ref.is_leaf()) {
                alone_[in_nodes++] = in;
            } else if (derived().wants(in.lane)) {
                LoneRay<Derived> ray(scene_, packet_, in.lane, derived());
                if (!ray.visit(in.ref, stats)) ray.finish(stats);
            }
        }
        alone_count_ = in_nodes;
        StreamSlot<Alone, WideNode::kWidth> slots[kStreamSlots];
        StreamSlot<Alone, WideNode::kWidth>* active[kStreamSlots];
        std::size_t next = 0, count = 0;
        const auto start = [&](StreamSlot<Alone, WideNode::kWidth>& slot) HWY_ATTR {
            while (next < alone_count_) {
                const AloneIn& in = alone_[next++];
                if (!derived().wants(in.lane)) continue;
                new (slot.place) Alone(scene_, packet_, in.lane, derived());
                slot.stack.clear();
                slot.stack.entry[1] = -std::numeric_limits<float>::infinity();
                slot.stack.child[1] = in.ref.bits();
                slot.height = 2;
                return true;
            }
            return false;
        };
        while (count < kStreamSlots && start(slots[count])) {
            active[count] = &slots[count];
            ++count;
        }
        const WideNode* const nodes = scene_.layout->tree.nodes.data();
        while (count > 0) {
            for (std::size_t i = 0; i < count; ++i) {
                if (advance(*active[i], nodes, *in_turn_, stats)) continue;
                Alone& alone = active[i]->query();
                if (derived().wants(static_cast<std::uint32_t>(alone.lane))) alone.finish(stats);
                if (!start(*active[i])) active[i--] = active[--count];
            }
        }
        alone_count_ = 0;
        derived().left();
    }

  protected:
    using Base::derived, Base::packet_, Base::ray_of, Base::rays_, Base::scene_;

    /// Rays that need no more leave `lanes`.
    template <class Stats>
    HWY_INLINE bool visit_triangles(std::uint32_t number, std::uint32_t& lanes, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        if constexpr (Derived::kOrdered) {
            if (packet_.pinhole.used) {
                if (HWY_UNLIKELY(!packet_.pinhole.made)) packet_.make_pinhole();
                const PinholeTriangles seen(block, packet_);
                return visit_met(number, seen.met, seen, lanes, stats);
            }
        }
        return visit_met(number, intersect_triangles(block, packet_), block, lanes, stats);
    }
    /// Those of `met`, bits of the block; `Triangles` is what `filter_lanes` takes.
    template <class Triangles, class Stats>
    HWY_INLINE bool visit_met(std::uint32_t number, std::uint32_t met, const Triangles& triangles,
                              std::uint32_t& lanes, Stats stats) {
        const TriangleBlock& block = scene_.layout->triangles[number];
        if constexpr (Derived::kOrdered) {
            // Each against eight triangles takes less than each triangle against all rays.
            if (std::popcount(lanes) < std::popcount(met)) {
                for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
                    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
                    (void)LoneRay<Derived>(scene_, packet_, i, derived())
                        .visit_block(number, stats);
                }
                return true;
            }
        }
        bool changed = false;
        for (; met != 0; met &= met - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(met));
            if (!block.ids[lane].used()) break;
            if (!scene_.sees(block.ids[lane].id())) continue;
            stats.primitives(static_cast<std::uint64_t>(std::popcount(lanes)));
            FilteredLanes found;
            if (!filter_lanes(triangles, lane, packet_, lanes, found)) continue;
            lanes &= ~derived().found(static_cast<TrianglePlace>(number * kBlockWidth + lane),
                                      found, stats);
            if constexpr (Derived::kOrdered) scene_.expect(block.ids[lane]);
            changed = true;
            if (lanes == 0) break;
        }
        return changed;
    }
    /// Exact resolution: see PacketResolution.
    template <class Hits, class Stats>
    HWY_INLINE void resolve(std::uint32_t lanes, const TrianglePlace* places, Hits&& hits,
                            Stats stats) {
        constexpr std::size_t kTogether = PacketResolution<LanePacket>::kRays;
        for (std::size_t n = 0; n < kPacketLanes / kTogether; ++n) {
            const std::uint32_t here = lanes >> (n * kTogether) & ((1u << kTogether) - 1);
            if (here == 0) continue;
            for (std::size_t g = 0; g < LanePacket::kResolvedGroups; ++g) {
                packet_.lay_out(n * LanePacket::kResolvedGroups + g, rays_);
            }
            resolution_.resolve(n, here, places + n * kTogether, hits, stats);
        }
    }

  private:
    /// A ray that is to go on alone in a subtree, and the query that does.
    struct AloneIn {
        NodeRef ref;
        std::uint32_t lane;
    };
    struct Alone : LoneRay<Derived> {
        static constexpr bool kOrdered = Derived::kOrdered;
        HWY_INLINE Alone(const WideBvhScene& scene, const LanePacket& packet, std::size_t lane,
                         Derived& leaves)
            : LoneRay<Derived>(scene, packet, lane, leaves) {}
    };
    static constexpr std::size_t kMostAlone = 32;

    const PrefetchTable* in_turn_;
    PacketResolution<LanePacket> resolution_;
    std::size_t alone_count_ = 0;
    AloneIn alone_[kMostAlone];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
