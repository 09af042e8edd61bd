/// The triangle filter of frustum packets: the triangles of a block that groups of rays may hit,
/// each tested against eight rays.
///
/// Source: triangle_filter.h, with rays in the lanes. For rays with a common point an edge function
/// is linear in the slopes: Amanatides and Choi, "Ray Tracing Triangular Meshes", Western Computer
/// Graphics Symposium 1997, among others.
/// Differs: slopes are relative to the middle one of the packet, which keeps the rounding error as
/// small as that of one ray; only those triangles of a block are tested whose slopes, seen from the
/// point, overlap those of a group.
/// With e, R, E and L as in triangle_filter.h, S the slope of a ray, m the middle one, w the
/// largest |S - m| and P the point of the packet:
/// - the error of a corner (v - P) - S (v - P)_z is E, plus e w R for S - m, plus the distance at
///   which the ray passes P: E' = 1.1 E + |away|
/// - so the error of an edge function is 4 E' L + 2 E'^2, where L is the largest |x|, |y| of a
///   corner sheared along m, plus w |z|; its three parts and their sum round 9.1 e L^2 where
///   nothing is fused, less than 1.5 E' L: the bound is 5.6 E' L + 2.2 E'^2
/// - the position of the hit has one sum more: 1.1 times the bound there.
/// Where a ray begins near a triangle, the finer bound of triangle_filter.h applies:
/// `refine_group`, the filter of one ray with rays in the lanes.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_FILTER_INL_H_
#endif

#include <algorithm>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_crossing-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The triangles of a block, sheared for the rays of a packet.
struct ShearedBlock {
    /// [edges 1 2, 2 0, 0 1][constant, factor of the relative slope in x, in y][lane]
    HWY_ALIGN float edge[3][3][kBlockWidth];
    HWY_ALIGN float error[kBlockWidth];  ///< of an edge function
    HWY_ALIGN float z[3][kBlockWidth];   ///< relative to the point

    HWY_INLINE ShearedBlock(const TriangleBlock& block, const RayPacket& packet) {
        const AxisRows<Floats> point{Floats(packet.point[0]), Floats(packet.point[1]),
                                     Floats(packet.point[2])};
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) v_[i] = load_axes(block.vertex[i], packet) - point;
        find_slopes(packet);
    }

    /// Bits of the triangles that a ray of a group may hit.
    [[nodiscard]] HWY_INLINE std::uint32_t seen_by(const RayPacket& packet, std::size_t g) const {
        LaneMask<float> missed = (nearest_ > Floats(packet.group_k_max[g])) |
                                 (farthest_ < Floats(packet.group_k_min[g]));
        HWY_UNROLL(2)
        for (std::size_t i = 0; i < 2; ++i) {
            missed = missed | (slope_hi_[i] < Floats(packet.slope_lo[i][g])) |
                     (slope_lo_[i] > Floats(packet.slope_hi[i][g]));
        }
        return kAllLanes & ~bits_of(missed);
    }
    /// Must be called before a ShearedTriangle is constructed.
    HWY_INLINE void find_edges(const RayPacket& packet) {
        ShearedCorners<Floats> p;
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            p.set(i, v_[i], Floats(packet.middle[0]), Floats(packet.middle[1]));
        }
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            store_lanes(v_[i].z, z[i]);
            const LinearEdge<Floats> linear(p, i);
            HWY_UNROLL(3)
            for (std::size_t k = 0; k < 3; ++k) store_lanes(linear.part[k], edge[i][k]);
        }
        const float off = 1.1f * packet.error + std::max(packet.away[0], packet.away[1]);
        const Floats far = mul_add(p.along(), Floats(packet.widest), p.across());
        store_lanes(mul_add(far, Floats(5.6f * off), Floats(2.2f * off * off)), error);
    }

  private:
    /// Sets the ranges of slopes and depths. A ray that hits a triangle entirely in front of the
    /// point, or behind it, has a slope between those of its corners, within the errors of both
    /// over the depth.
    HWY_INLINE void find_slopes(const RayPacket& packet) {
        const Floats tiny(0x1p-60f), infinite(std::numeric_limits<float>::infinity());
        const Floats lowest = least_of(v_[0].z, v_[1].z, v_[2].z);
        const Floats highest = most_of(v_[0].z, v_[1].z, v_[2].z);
        // The slopes of other triangles are unbounded.
        const LaneMask<float> aside = (lowest > tiny) | (highest < -tiny);
        Floats q[3];
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) q[i] = Floats(1.0f) / v_[i].z;
        const Floats off = Floats(2.0f) * most_of(abs(q[0]), abs(q[1]), abs(q[2]));
        HWY_UNROLL(2)
        for (std::size_t k = 0; k < 2; ++k) {
            const Floats AxisRows<Floats>::*along =
                k == 0 ? &AxisRows<Floats>::x : &AxisRows<Floats>::y;
            const Floats slack = off * Floats(packet.error + packet.away[k]);
            const Floats a = v_[0].*along * q[0], b = v_[1].*along * q[1], c = v_[2].*along * q[2];
            slope_lo_[k] = select_lanes(aside, least_of(a, b, c) - slack, -infinite);
            slope_hi_[k] = select_lanes(aside, most_of(a, b, c) + slack, infinite);
        }
        nearest_ = packet.sign() > 0 ? lowest : -highest;
        farthest_ = packet.sign() > 0 ? highest : -lowest;
    }

    AxisRows<Floats> v_[3];  ///< [corner] relative to the point
    Floats slope_lo_[2], slope_hi_[2], nearest_, farthest_;
};

/// A triangle of a block, repeated in every lane.
struct ShearedTriangle {
    Floats edge[3][3], error, z[3];
    Floats first, last;  ///< of z
    Floats spread;       ///< error of a position by those of the weights, times their sum
    Floats place_error;  ///< the remaining error of a position
    TrianglePlace place;

    HWY_INLINE ShearedTriangle(const ShearedBlock& block, const RayPacket& packet, std::size_t lane,
                               TrianglePlace at)
        : error(block.error[lane]), place_error(packet.s_error), place(at) {
        HWY_UNROLL(3)
        for (std::size_t e = 0; e < 3; ++e) {
            for (std::size_t k = 0; k < 3; ++k) edge[e][k] = Floats(block.edge[e][k][lane]);
            z[e] = Floats(block.z[e][lane]);
        }
        first = least_of(z[0], z[1], z[2]);
        last = most_of(z[0], z[1], z[2]);
        spread = Floats(25.0f) * error * (last - first);
    }
};

/// The rays of a group that a triangle may hit, and their parameters.
struct FilteredGroup {
    LaneMask<float, kGroupRays> candidates, sure;
    GroupFloats lo, hi;

    // Not defaulted, as for LaneMask.
    HWY_INLINE FilteredGroup() {}

    /// Whether any of the rays `used` is a candidate.
    HWY_INLINE bool set(const LaneMask<float, kGroupRays>& outside,
                        const LaneMask<float, kGroupRays>& inside, std::uint32_t used) {
        candidates = !outside;
        for (std::size_t i = 0; i < kParts<float, kGroupRays>; ++i) {
            sure.part[i] = hn::AndNot(outside.part[i], inside.part[i]);
        }
        return (bits_of(candidates) & used) != 0;
    }
};

/// As `filter_triangles`; false if certainly no ray hits the triangle.
HWY_INLINE bool filter_group(const ShearedTriangle& seen, const RayGroup& group,
                             FilteredGroup& out) {
    using F = GroupFloats;
    const auto row = [](const GroupRow& r) HWY_ATTR { return load_lanes<kGroupRays>(r); };
    const F a = row(group.aside[0]), b = row(group.aside[1]);
    const auto edge = [&](std::size_t e) HWY_ATTR {
        return mul_add(b, seen.edge[e][2], mul_add(a, seen.edge[e][1], seen.edge[e][0]));
    };
    const EdgeFunctions<F> edges(edge(0), edge(1), edge(2));
    const auto missed = edges.mixed(seen.error);
    if ((group.used & ~bits_of(missed)) == 0) return false;
    const F inverse = F(1.0f) / edges.sum();
    const F place = edges.weighted(seen.z[0], seen.z[1], seen.z[2]) * inverse;
    const F reciprocal = row(group.reciprocal);
    const F s =
        (min_lanes(max_lanes(place, seen.first), seen.last) + row(group.shift)) * reciprocal;
    const F slack = abs(reciprocal) * mul_add(seen.spread, abs(inverse), seen.place_error);
    out.lo = s - slack;
    out.hi = s + slack;
    // Written so that NaN is a candidate and not sure.
    const auto outside = missed | (out.lo > row(group.s_max)) | (out.hi < row(group.s_min));
    const auto inside =
        edges.alike(seen.error) & (out.lo >= row(group.sure_min)) & (out.hi <= row(group.sure_max));
    return out.set(outside, inside, group.used);
}

/// As `filter_group`, by the bound of triangle_filter.h that is finer where a ray begins. `lane`:
/// of the block.
HWY_NOINLINE inline bool refine_group(const TriangleBlock& block, std::size_t lane,
                                      const RayPacket& packet, const RayGroup& group,
                                      FilteredGroup& out) {
    using F = GroupFloats;
    const auto row = [](const GroupRow& r) HWY_ATTR { return load_lanes<kGroupRays>(r); };
    const std::size_t kx = packet.kx, ky = packet.ky, kz = packet.kz;
    const AxisRows<F> origin{row(group.origin[kx]), row(group.origin[ky]), row(group.origin[kz])};
    const F sx = row(group.slope[0]), sy = row(group.slope[1]);
    ShearedCorners<F> corners;
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& v = block.vertex[i];
        const AxisRows<F> corner{F(v[kx][lane]), F(v[ky][lane]), F(v[kz][lane])};
        corners.set(i, corner - origin, sx, sy);
    }
    TriangleCrossing<F> crossing(corners);
    crossing.bound(row(group.reciprocal), F(packet.near_error));
    out.lo = crossing.lo;
    out.hi = crossing.hi;
    const auto outside = crossing.missed(row(group.s_min), row(group.s_max));
    const auto inside = crossing.sure(row(group.sure_min), row(group.sure_max));
    return out.set(outside, inside, group.used);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
