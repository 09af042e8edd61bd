/// The queries of the wide BVH aggregate on the leaves, for packets: each triangle and each shape
/// against eight rays.
///
/// Source: triangle_filter.h, with rays in the lanes; that of rays with a common point an edge
/// function is linear in the slopes: Amanatides and Choi, "Ray Tracing Triangular Meshes", Western
/// Computer Graphics Symposium 1997, among others.
/// Differs: slopes are taken from the middle one of the packet, which keeps the rounding as small
/// as that of one ray; of a block only those triangles are tested whose slopes, seen from the
/// point, meet those of a group.
/// With e, R, E and L as there, S the slope of a ray, m the middle one, w the largest |S - m| and P
/// the point of the packet:
/// - a corner (v - P) - S (v - P)_z is off by E as there, by e w R for S - m, and by as much as the
///   ray passes P by: E' = 1.1 E + |away|
/// - so an edge function is off by 4 E' L + 2 E'^2, where L is the largest |x|, |y| of a corner
///   sheared along m and w |z| more; its three parts and their sum round 9.1 e L^2 where nothing is
///   fused, less than 1.5 E' L: 5.6 E' L + 2.2 E'^2 are taken
/// - the place of the hit has one sum more: 1.1 times the bound there.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_QUERIES_INL_H_
#endif

#include <bit>
#include <new>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/block_boxes-inl.h"
#include "alhazen/aggregates/wide_bvh/packet_resolution-inl.h"
#include "alhazen/primitives/primitive_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The triangles of a block as the rays of a packet see them.
struct SeenBlock {
    /// [1 2, 2 0, 0 1][constant, times the slopes beside the middle in x, in y][lane]
    HWY_ALIGN float edge[3][3][kBlockWidth];
    HWY_ALIGN float error[kBlockWidth];                                  ///< of an edge function
    HWY_ALIGN float z[3][kBlockWidth];                                   ///< from the point
    HWY_ALIGN float slope_lo[2][kBlockWidth], slope_hi[2][kBlockWidth];  ///< [x, y]
    HWY_ALIGN float nearest[kBlockWidth];                                ///< how deep they begin
    std::uint32_t anywhere;  ///< bits of those of which the slopes say nothing

    HWY_INLINE SeenBlock(const TriangleBlock& block, const RayPacket& packet) {
        const std::uint32_t axes[3] = {packet.kx, packet.ky, packet.kz};
        Floats v[3][3];  // [corner][axis]
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                v[i][k] = load_lanes(block.vertex[i][axes[k]]) - Floats(packet.point[k]);
            }
            store_lanes(v[i][2], z[i]);
        }
        find_slopes(v, packet);
        find_edges(v, packet);
    }

    /// Bits of the groups of which a ray may hit the triangle.
    [[nodiscard]] HWY_INLINE std::uint32_t groups(const RayPacket& packet, std::size_t lane) const {
        const auto beyond = load_lanes(packet.group_k_max) < Floats(nearest[lane]);
        LaneMask<float> missed = beyond;
        HWY_UNROLL(2)
        for (std::size_t i = 0; i < 2; ++i) {
            missed = missed | (load_lanes(packet.slope_lo[i]) > Floats(slope_hi[i][lane])) |
                     (load_lanes(packet.slope_hi[i]) < Floats(slope_lo[i][lane]));
        }
        const std::uint32_t all = (1u << packet.group_count) - 1;
        return all & ~bits_of((anywhere >> lane & 1) != 0 ? beyond : missed);
    }

  private:
    /// A ray that hits a triangle in front of the point, or behind it, has a slope between those of
    /// its corners, give and take what the ray and they are off over the depth.
    HWY_INLINE void find_slopes(const Floats (&v)[3][3], const RayPacket& packet) {
        const auto least = [](const Floats& a, const Floats& b, const Floats& c)
                               HWY_ATTR { return min_lanes(min_lanes(a, b), c); };
        const auto most = [](const Floats& a, const Floats& b, const Floats& c)
                              HWY_ATTR { return max_lanes(max_lanes(a, b), c); };
        const Floats tiny(0x1p-60f);
        anywhere = kAllLanes & ~bits_of((least(v[0][2], v[1][2], v[2][2]) > tiny) |
                                        (most(v[0][2], v[1][2], v[2][2]) < -tiny));
        Floats q[3];
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) q[i] = Floats(1.0f) / v[i][2];
        const Floats off = Floats(2.0f) * most(abs(q[0]), abs(q[1]), abs(q[2]));
        HWY_UNROLL(2)
        for (std::size_t k = 0; k < 2; ++k) {
            const Floats slack = off * Floats(packet.error + packet.away[k]);
            const Floats a = v[0][k] * q[0], b = v[1][k] * q[1], c = v[2][k] * q[2];
            store_lanes(least(a, b, c) - slack, slope_lo[k]);
            store_lanes(most(a, b, c) + slack, slope_hi[k]);
        }
        const Floats sign(packet.sign());
        store_lanes(least(v[0][2] * sign, v[1][2] * sign, v[2][2] * sign), nearest);
    }
    /// Sheared along the middle slope m a corner is at (x, y) and at (x - a z, y - b z) along the
    /// slope m + (a, b); of its edge functions the terms in a b cancel.
    HWY_INLINE void find_edges(const Floats (&v)[3][3], const RayPacket& packet) {
        struct {
            Floats x, y, z;
        } p[3];
        Floats far(0.0f), deep(0.0f);
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            p[i].z = v[i][2];
            p[i].x = neg_mul_add(Floats(packet.middle[0]), v[i][2], v[i][0]);
            p[i].y = neg_mul_add(Floats(packet.middle[1]), v[i][2], v[i][1]);
            far = max_lanes(far, max_lanes(abs(p[i].x), abs(p[i].y)));
            deep = max_lanes(deep, abs(p[i].z));
        }
        HWY_UNROLL(3)
        for (std::size_t e = 0; e < 3; ++e) {
            const auto &a = p[(e + 1) % 3], &b = p[(e + 2) % 3];
            store_lanes(mul_sub(a.x, b.y, a.y * b.x), edge[e][0]);
            store_lanes(mul_sub(a.y, b.z, a.z * b.y), edge[e][1]);
            store_lanes(mul_sub(a.z, b.x, a.x * b.z), edge[e][2]);
        }
        const float off = 1.1f * packet.error + std::max(packet.away[0], packet.away[1]);
        far = mul_add(deep, Floats(packet.widest), far);
        store_lanes(mul_add(far, Floats(5.6f * off), Floats(2.2f * off * off)), error);
    }
};

/// A triangle of a block in every lane.
struct SeenTriangle {
    Floats edge[3][3], error, z[3];
    Floats first, last;  ///< of z
    Floats spread;       ///< by how much the weights' errors move a place, times their sum
    Floats place_error;  ///< beside that
    TrianglePlace place;

    HWY_INLINE SeenTriangle(const SeenBlock& block, const RayPacket& packet, std::size_t lane,
                            TrianglePlace at)
        : error(block.error[lane]), place_error(packet.s_error), place(at) {
        HWY_UNROLL(3)
        for (std::size_t e = 0; e < 3; ++e) {
            for (std::size_t k = 0; k < 3; ++k) edge[e][k] = Floats(block.edge[e][k][lane]);
            z[e] = Floats(block.z[e][lane]);
        }
        first = min_lanes(min_lanes(z[0], z[1]), z[2]);
        last = max_lanes(max_lanes(z[0], z[1]), z[2]);
        spread = Floats(25.0f) * error * (last - first);
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
HWY_INLINE bool filter_group(const SeenTriangle& seen, const RayGroup& group, FilteredGroup& out) {
    using F = GroupFloats;
    const auto row = [](const GroupRow& r) HWY_ATTR { return load_lanes<kGroupRays>(r); };
    const F a = row(group.aside[0]), b = row(group.aside[1]);
    const auto edge = [&](std::size_t e) HWY_ATTR {
        return mul_add(b, seen.edge[e][2], mul_add(a, seen.edge[e][1], seen.edge[e][0]));
    };
    const F eu = edge(0), ev = edge(1), ew = edge(2);
    const F &error = seen.error, minus_error = -error;
    const F least = min_lanes(min_lanes(eu, ev), ew);
    const F most = max_lanes(max_lanes(eu, ev), ew);
    const auto missed = (least < minus_error) & (most > error);
    if ((group.used & ~bits_of(missed)) == 0) return false;
    const F inverse = F(1.0f) / (eu + ev + ew);
    const F place = mul_add(eu, seen.z[0], mul_add(ev, seen.z[1], ew * seen.z[2])) * inverse;
    const F reciprocal = row(group.reciprocal);
    const F s =
        (min_lanes(max_lanes(place, seen.first), seen.last) + row(group.shift)) * reciprocal;
    const F slack = abs(reciprocal) * mul_add(seen.spread, abs(inverse), seen.place_error);
    out.lo = s - slack;
    out.hi = s + slack;
    // Written so that a NaN is a candidate and not sure.
    const auto outside = missed | (out.lo > row(group.s_max)) | (out.hi < row(group.s_min));
    const auto inside = ((least > error) | (most < minus_error)) & (out.lo >= row(group.sure_min)) &
                        (out.hi <= row(group.sure_max));
    for (std::size_t i = 0; i < kParts<float, kGroupRays>; ++i) {
        out.candidates.part[i] = hn::Not(outside.part[i]);
        out.sure.part[i] = hn::AndNot(outside.part[i], inside.part[i]);
    }
    return (bits_of(out.candidates) & group.used) != 0;
}

/// The leaves of a packet. `Derived` offers `found(group number, place, result, stats)` for
/// triangles. Shapes are tested eight rays at a time too, by the groups that intersect their box.
template <class Derived>
class PacketLeaves {
  public:
    HWY_INLINE PacketLeaves(const WideBvhScene& scene, std::span<const Ray> rays,
                            std::span<Hit> results, RayPacket& packet)
        : scene_(scene),
          rays_(rays),
          results_(results),
          packet_(packet),
          candidates_(packet),
          resolution_(scene, packet, rays) {}

    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, float /*nearest*/, Stats stats) {
        Derived& self = static_cast<Derived&>(*this);
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                break;
            case LeafType::Spheres:
                visit_shapes(&scene_.layout->spheres[ref.offset()], ref.count(), stats);
                return false;
            case LeafType::Frustums:
                visit_shapes(&scene_.layout->frustums[ref.offset()], ref.count(), stats);
                return false;
            case LeafType::Others:
                visit_shapes(&scene_.layout->others[ref.offset()], ref.count(), stats);
                return false;
        }
        std::uint32_t changed = 0;
        for (std::uint32_t i = 0; i < ref.count(); ++i) {
            const TriangleBlock& block = scene_.layout->triangles[ref.offset() + i];
            const SeenBlock seen(block, packet_);
            for (std::size_t lane = 0; lane < kBlockWidth && block.ids[lane].used(); ++lane) {
                std::uint32_t rest = seen.groups(packet_, lane);
                if (rest == 0 || !scene_.sees(block.ids[lane].id())) continue;
                const SeenTriangle triangle(
                    seen, packet_, lane,
                    static_cast<TrianglePlace>((ref.offset() + i) * kBlockWidth + lane));
                for (; rest != 0; rest &= rest - 1) {
                    const auto g = static_cast<std::size_t>(std::countr_zero(rest));
                    const RayGroup& group = packet_.groups[g];
                    stats.primitives(static_cast<std::uint64_t>(std::popcount(group.used)));
                    FilteredGroup found;
                    if (!filter_group(triangle, group, found)) continue;
                    self.found(g, triangle.place, found, stats);
                    changed |= 1u << g;
                }
            }
        }
        if (changed != 0) packet_.shrink(changed);
        return false;
    }

  protected:
    /// Shapes and instances, the nearest first, each by the groups of rays that may meet it.
    template <class Block, class Stats>
    HWY_NOINLINE void visit_shapes(const Block* blocks, std::uint32_t count, Stats stats) {
        for (const Block* end = blocks + count; blocks < end; ++blocks) {
            const BlockBoxes boxes(*blocks);
            Floats nearest;
            std::uint32_t rest = packet_.meet_boxes(boxes.rows(), nearest);
            HWY_ALIGN float depth[kBlockWidth];
            store_lanes(nearest, depth);
            while (rest != 0) {
                auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                for (std::uint32_t others = rest & (rest - 1); others != 0; others &= others - 1) {
                    const auto other = static_cast<std::size_t>(std::countr_zero(others));
                    if (depth[other] < depth[lane]) lane = other;
                }
                rest &= ~(1u << lane);
                if (!blocks->ids[lane].used()) continue;
                const BlockBoxes::Bounds b = boxes.bounds(lane);
                std::uint32_t groups = packet_.meet_groups(b.lo, b.hi);
                if (groups != 0) groups &= packet_.meet_ball(b.center, b.radius);
                visit_shape(blocks->ids[lane].id(), groups, stats);
            }
        }
    }

    const WideBvhScene& scene_;
    std::span<const Ray> rays_;
    std::span<Hit> results_;
    RayPacket& packet_;
    PacketCandidates candidates_;
    PacketResolution resolution_;

  private:
    template <class Stats>
    HWY_INLINE void visit_shape(PrimitiveId id, std::uint32_t groups, Stats stats) {
        std::uint32_t shrunk = 0;
        for (; groups != 0; groups &= groups - 1) {
            const auto g = static_cast<std::size_t>(std::countr_zero(groups));
            const std::uint32_t changed =
                closest_of_lanes(*scene_.table, id, packet_.rays[g], packet_.groups[g].used,
                                 results_.subspan(g * kGroupRays), {stats.sink(), scene_.mask});
            if (changed == 0) continue;
            packet_.limit_group(g, scene_.layout->frame.scale);
            shrunk |= 1u << g;
        }
        if (shrunk != 0) packet_.shrink(shrunk);
    }
};

/// Offers the hits of PacketResolution.
struct Offered {
    std::span<Hit> best;
    void operator()(std::size_t i, PrimitiveId id, const ShapeHit& hit) const {
        Ray ray;
        offer_hit(hit, id, ray, best[i]);
    }
};
/// The closest hits.
class ClosestPacket : public PacketLeaves<ClosestPacket> {
  public:
    HWY_INLINE ClosestPacket(const WideBvhScene& scene, std::span<const Ray> rays,
                             std::span<Hit> best, RayPacket& packet)
        : PacketLeaves(scene, rays, best, packet) {
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
    HWY_INLINE void found(std::size_t g, TrianglePlace place, const FilteredGroup& found,
                          Stats stats) {
        RayGroup& group = packet_.groups[g];
        const GroupFloats s_max = load_lanes<kGroupRays>(group.s_max);
        store_lanes(select_lanes(found.sure, min_lanes(found.hi, s_max), s_max), group.s_max);
        while (HWY_UNLIKELY(!candidates_.add(g, place, found.candidates, found.lo))) {
            candidates_.take_beside([&](std::size_t ray, TrianglePlace other)
                                        HWY_ATTR { resolve(ray, other, stats); });
        }
    }

    /// Resolves all candidates.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        candidates_.take_all([&](std::size_t ray, TrianglePlace place)
                                 HWY_ATTR { resolve(ray, place, stats); });
        resolution_.resolve(Offered{results_}, stats);
    }

  private:
    template <class Stats>
    HWY_INLINE void resolve(std::size_t ray, TrianglePlace place, Stats stats) {
        resolution_.add(ray, place, Offered{results_}, stats);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
