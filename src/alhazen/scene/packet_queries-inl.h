/// The queries of the wide BVH aggregate on the leaves, for packets: each triangle against sixteen
/// rays.
///
/// Source: triangle_filter.h, the same formulas and bounds with rays in the lanes.
/// Differs: of a block only those triangles are tested whose projection the pyramid of the rays
/// meets; there is one bound of the coordinates, hence of the error, for all rays of a group.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_SCENE_PACKET_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SCENE_PACKET_QUERIES_INL_H_
#undef ALHAZEN_SCENE_PACKET_QUERIES_INL_H_
#else
#define ALHAZEN_SCENE_PACKET_QUERIES_INL_H_
#endif

#include <bit>
#include <new>

#include "alhazen/accel/wide_bvh/packet-inl.h"
#include "alhazen/scene/leaf_queries-inl.h"
#include "alhazen/scene/packet_decider-inl.h"
#include "alhazen/scene/pending_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The corners of a block of triangles, seen from the point of a packet.
struct SeenBlock {
    Floats x[3], y[3], z[3];

    HWY_INLINE SeenBlock(const TriangleBlock& block, const RayPacket& packet) {
        const Floats px(packet.point[0]), py(packet.point[1]), pz(packet.point[2]);
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            x[i] = load_lanes(block.vertex[i][packet.kx]) - px;
            y[i] = load_lanes(block.vertex[i][packet.ky]) - py;
            z[i] = load_lanes(block.vertex[i][packet.kz]) - pz;
        }
    }

    /// Bits of the triangles that rays of the group may hit; `error` is that of their edge
    /// functions. With a slope anywhere in the group's range, and a ray as far from the point as
    /// any, a sheared coordinate lies between those of the two ends, give and take `slack`.
    HWY_INLINE std::uint32_t meet(const RayPacket& packet, const RayGroup& group,
                                  float* error) const {
        Floats far(0.0f);
        const auto missed = [&](const Floats(&v)[3], std::size_t i) HWY_ATTR {
            const Floats lo(group.slope_lo[i]), hi(group.slope_hi[i]);
            const Floats slack(packet.error + packet.away[i]);
            Floats a[3], b[3];
            HWY_UNROLL(3)
            for (std::size_t c = 0; c < 3; ++c) {
                a[c] = neg_mul_add(lo, z[c], v[c]);
                b[c] = neg_mul_add(hi, z[c], v[c]);
            }
            const Floats least = min_lanes(min_lanes(min_lanes(a[0], a[1]), min_lanes(a[2], b[0])),
                                           min_lanes(b[1], b[2]));
            const Floats most = max_lanes(max_lanes(max_lanes(a[0], a[1]), max_lanes(a[2], b[0])),
                                          max_lanes(b[1], b[2]));
            far = max_lanes(far, max_lanes(-least, most) + slack + slack);
            return (least > slack) | (most < -slack);
        };
        const LaneMask<float> outside = missed(x, 0) | missed(y, 1);
        const float edge_slack = 5.12f * packet.error;
        const float edge_slack_min = 2.12f * packet.error * packet.error;
        store_lanes(mul_add(far, Floats(edge_slack), Floats(edge_slack_min)), error);
        return kAllLanes & ~bits_of(outside);
    }
};

/// Which rays of a group a triangle is hit by, and where.
struct FilteredGroup {
    LaneMask<float, kGroupRays> candidates, sure;
    GroupFloats lo, hi;

    // As that of LaneMask: not defaulted, for the sake of the target.
    HWY_INLINE FilteredGroup() {}
};

/// As `filter_triangles`; false when no ray hits the triangle for all one knows.
HWY_INLINE bool filter_group(const TriangleBlock& block, std::size_t lane, float edge_error,
                             const RayPacket& packet, const RayGroup& group, FilteredGroup& out) {
    using F = GroupFloats;
    const auto row = [](const GroupRow& r) HWY_ATTR { return load_lanes<kGroupRays>(r); };
    struct {
        F x, y, z;
    } v[3];
    const F sx = row(group.slope[0]), sy = row(group.slope[1]);
    const F ox = row(group.origin[packet.kx]), oy = row(group.origin[packet.ky]);
    const F oz = row(group.origin[packet.kz]);
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
        v[i].z = F(block.vertex[i][packet.kz][lane]) - oz;
        v[i].x = neg_mul_add(sx, v[i].z, F(block.vertex[i][packet.kx][lane]) - ox);
        v[i].y = neg_mul_add(sy, v[i].z, F(block.vertex[i][packet.ky][lane]) - oy);
    }
    const auto edge = [](const auto& a, const auto& b)
                          HWY_ATTR { return mul_sub(a.x, b.y, a.y * b.x); };
    const F eu = edge(v[1], v[2]), ev = edge(v[2], v[0]), ew = edge(v[0], v[1]);
    const F error(edge_error), minus_error(-edge_error);
    const F least = min_lanes(min_lanes(eu, ev), ew);
    const F most = max_lanes(max_lanes(eu, ev), ew);
    const std::uint32_t missed = bits_of((least < minus_error) & (most > error));
    if ((group.used & ~missed) == 0) return false;
    const F sz = row(group.reciprocal);
    const F sa = v[0].z * sz, sb = v[1].z * sz, sc = v[2].z * sz;
    const F inverse = F(1.0f) / (eu + ev + ew);
    const F first = min_lanes(min_lanes(sa, sb), sc);
    const F last = max_lanes(max_lanes(sa, sb), sc);
    const F place = mul_add(eu, sa, mul_add(ev, sb, ew * sc)) * inverse;
    const F s = min_lanes(max_lanes(place, first), last);
    const F slack =
        mul_add(F(25.0f) * error * (last - first), abs(inverse), F(packet.s_error) * abs(sz));
    out.lo = s - slack;
    out.hi = s + slack;
    // Written so that a NaN is a candidate and not sure.
    const auto outside = ((least < minus_error) & (most > error)) | (out.lo > row(group.s_max)) |
                         (out.hi < row(group.s_min));
    const auto inside = ((least > error) | (most < minus_error)) & (out.lo >= row(group.sure_min)) &
                        (out.hi <= row(group.sure_max));
    for (std::size_t i = 0; i < kParts<float, kGroupRays>; ++i) {
        out.candidates.part[i] = hn::Not(outside.part[i]);
        out.sure.part[i] = hn::AndNot(outside.part[i], inside.part[i]);
    }
    return (bits_of(out.candidates) & group.used) != 0;
}

/// What is asked of the leaves. `Derived` offers `found(group number, place, result, stats)`;
/// `Query` is the query of a single ray, made for the rays that need it.
template <class Derived, class Query, class Result>
class PacketLeaves {
  public:
    HWY_INLINE PacketLeaves(const WideBvhScene& scene, std::span<const Ray> rays,
                            std::span<Result> results, RayPacket& packet)
        : scene_(scene),
          rays_(rays),
          results_(results),
          packet_(packet),
          pending_(packet),
          decider_(scene, packet, rays) {}

    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, float nearest, Stats stats) {
        Derived& self = static_cast<Derived&>(*this);
        if (static_cast<LeafType>(ref.kind()) != LeafType::Triangles) {
            return visit_one_by_one(ref, nearest, stats);
        }
        std::uint32_t changed = 0;
        for (std::uint32_t i = 0; i < ref.count(); ++i) {
            const TriangleBlock& block = scene_.layout->triangles[ref.offset() + i];
            const SeenBlock seen(block, packet_);
            HWY_ALIGN float error[kPacketGroups][kBlockWidth];
            // Eight bits for each group: one loop over all is predicted better than one for each.
            std::uint32_t rest = 0;
            for (std::size_t g = 0; g < packet_.group_count; ++g) {
                const RayGroup& group = packet_.groups[g];
                const std::uint32_t reached = nearest > group.k_max ? 0u : kAllLanes;
                rest |= (seen.meet(packet_, group, error[g]) & reached) << (kBlockWidth * g);
            }
            for (; rest != 0; rest &= rest - 1) {
                const auto bit = static_cast<std::size_t>(std::countr_zero(rest));
                const std::size_t g = bit / kBlockWidth, lane = bit % kBlockWidth;
                const RayGroup& group = packet_.groups[g];
                if (!block.ids[lane].used() || !scene_.sees(block.ids[lane].id())) continue;
                stats.primitives(static_cast<std::uint64_t>(std::popcount(group.used)));
                FilteredGroup found;
                if (!filter_group(block, lane, error[g][lane], packet_, group, found)) continue;
                self.found(g, static_cast<TrianglePlace>((ref.offset() + i) * kBlockWidth + lane),
                           found, stats);
                changed |= 1u << g;
            }
        }
        if (changed == 0) return false;
        for (; changed != 0; changed &= changed - 1) {
            packet_.shrink(packet_.groups[std::countr_zero(changed)]);
        }
        return false;
    }

  protected:
    /// The query of a ray on its own, made when it is needed first.
    HWY_INLINE Query& query(std::size_t i) {
        if ((made_ >> i & 1) == 0) {
            new (&queries_[i].place) Query(scene_, rays_[i], results_[i]);
            made_ |= std::uint64_t{1} << i;
        }
        return *std::launder(reinterpret_cast<Query*>(&queries_[i].place));
    }

    template <class Stats>
    HWY_NOINLINE bool visit_one_by_one(NodeRef ref, float nearest, Stats stats) {
        for (std::size_t g = 0; g < packet_.group_count; ++g) {
            RayGroup& group = packet_.groups[g];
            if (nearest > group.k_max) continue;
            for (std::uint32_t rest = group.used; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                Query& one = query(g * kGroupRays + lane);
                one.s_max = std::min(one.s_max, group.s_max[lane]);
                (void)one.visit(ref, stats);  // a query for the nearest hit never stops
                group.s_max[lane] = one.s_max;
            }
            packet_.shrink(group);
        }
        return false;
    }

    const WideBvhScene& scene_;
    std::span<const Ray> rays_;
    std::span<Result> results_;
    RayPacket& packet_;
    PendingTriangles pending_;
    PacketDecider decider_;
    std::uint64_t made_ = 0;  ///< queries of rays on their own

  private:
    struct Place {
        alignas(64) std::byte place[sizeof(Query)];
    };
    Place queries_[kPacketRays];
};

/// Takes what PacketDecider has found.
struct Offered {
    std::span<Hit> best;
    void operator()(std::size_t i, PrimitiveId id, const ShapeHit& hit) const {
        Ray ray;
        offer(hit, id, ray, best[i]);
    }
};
/// The nearest hits.
class ClosestPacket : public PacketLeaves<ClosestPacket, ClosestQuery, Hit> {
  public:
    HWY_INLINE ClosestPacket(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<Hit> best, RayPacket& packet)
        : PacketLeaves(scene, rays, best, packet) {
        const LocalParameter parameter{scene.layout->frame.scale, 0.0};
        bool any = false;
        for (std::size_t i = 0; i < best.size(); ++i) {
            if (HWY_LIKELY(!best[i].found())) continue;
            packet.limit(i, parameter.above(best[i].t));
            any = true;
        }
        if (any) packet.shrink_all();
    }

    template <class Stats>
    HWY_INLINE void found(std::size_t g, TrianglePlace place, const FilteredGroup& found,
                          Stats stats) {
        RayGroup& group = packet_.groups[g];
        const GroupFloats s_max = load_lanes<kGroupRays>(group.s_max);
        store_lanes(select_lanes(found.sure, min_lanes(found.hi, s_max), s_max), group.s_max);
        while (HWY_UNLIKELY(!pending_.add(g, place, found.candidates, found.lo))) {
            pending_.take_beside([&](std::size_t ray, TrianglePlace other)
                                     HWY_ATTR { decide(ray, other, stats); });
        }
    }

    /// Decides all that is kept.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        pending_.take_all([&](std::size_t ray, TrianglePlace place)
                              HWY_ATTR { decide(ray, place, stats); });
        decider_.decide(Offered{results_}, stats);
        for (std::uint64_t rest = made_; rest != 0; rest &= rest - 1) {
            query(static_cast<std::size_t>(std::countr_zero(rest))).finish(stats);
        }
    }

  private:
    template <class Stats>
    HWY_INLINE void decide(std::size_t ray, TrianglePlace place, Stats stats) {
        decider_.add(ray, place, Offered{results_}, stats);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
