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

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKET_FILTER_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/lane_crossing-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"

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
        const std::uint32_t axes[3] = {packet.kx, packet.ky, packet.kz};
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                v_[i][k] = load_lanes(block.vertex[i][axes[k]]) - Floats(packet.point[k]);
            }
        }
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
        struct {
            Floats x, y, z;
        } p[3];
        Floats far(0.0f), deep(0.0f);
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            p[i].z = v_[i][2];
            store_lanes(p[i].z, z[i]);
            p[i].x = neg_mul_add(Floats(packet.middle[0]), v_[i][2], v_[i][0]);
            p[i].y = neg_mul_add(Floats(packet.middle[1]), v_[i][2], v_[i][1]);
            far = max_lanes(far, max_lanes(abs(p[i].x), abs(p[i].y)));
            deep = max_lanes(deep, abs(p[i].z));
        }
        // Sheared along the middle slope m a corner is at (x, y), and at (x - a z, y - b z) along
        // the slope m + (a, b); the terms in a b of its edge functions cancel.
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

  private:
    /// Sets the ranges of slopes and depths. A ray that hits a triangle entirely in front of the
    /// point, or behind it, has a slope between those of its corners, within the errors of both
    /// over the depth.
    HWY_INLINE void find_slopes(const RayPacket& packet) {
        const auto least = [](const Floats& a, const Floats& b, const Floats& c)
                               HWY_ATTR { return min_lanes(min_lanes(a, b), c); };
        const auto most = [](const Floats& a, const Floats& b, const Floats& c)
                              HWY_ATTR { return max_lanes(max_lanes(a, b), c); };
        const Floats tiny(0x1p-60f), infinite(std::numeric_limits<float>::infinity());
        const Floats lowest = least(v_[0][2], v_[1][2], v_[2][2]);
        const Floats highest = most(v_[0][2], v_[1][2], v_[2][2]);
        // The slopes of other triangles are unbounded.
        const LaneMask<float> aside = (lowest > tiny) | (highest < -tiny);
        Floats q[3];
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) q[i] = Floats(1.0f) / v_[i][2];
        const Floats off = Floats(2.0f) * most(abs(q[0]), abs(q[1]), abs(q[2]));
        HWY_UNROLL(2)
        for (std::size_t k = 0; k < 2; ++k) {
            const Floats slack = off * Floats(packet.error + packet.away[k]);
            const Floats a = v_[0][k] * q[0], b = v_[1][k] * q[1], c = v_[2][k] * q[2];
            slope_lo_[k] = select_lanes(aside, least(a, b, c) - slack, -infinite);
            slope_hi_[k] = select_lanes(aside, most(a, b, c) + slack, infinite);
        }
        nearest_ = packet.sign() > 0 ? lowest : -highest;
        farthest_ = packet.sign() > 0 ? highest : -lowest;
    }

    Floats v_[3][3];  ///< [corner][axis] relative to the point
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
        first = min_lanes(min_lanes(z[0], z[1]), z[2]);
        last = max_lanes(max_lanes(z[0], z[1]), z[2]);
        spread = Floats(25.0f) * error * (last - first);
    }
};

/// The rays of a group that a triangle may hit, and their parameters.
struct FilteredGroup {
    LaneMask<float, kGroupRays> candidates, sure;
    GroupFloats lo, hi;

    // Not defaulted, as for LaneMask.
    HWY_INLINE FilteredGroup() {}
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
    // Written so that NaN is a candidate and not sure.
    const auto outside = missed | (out.lo > row(group.s_max)) | (out.hi < row(group.s_min));
    const auto inside = ((least > error) | (most < minus_error)) & (out.lo >= row(group.sure_min)) &
                        (out.hi <= row(group.sure_max));
    for (std::size_t i = 0; i < kParts<float, kGroupRays>; ++i) {
        out.candidates.part[i] = hn::Not(outside.part[i]);
        out.sure.part[i] = hn::AndNot(outside.part[i], inside.part[i]);
    }
    return (bits_of(out.candidates) & group.used) != 0;
}

/// As `filter_group`, by the bound of triangle_filter.h that is finer where a ray begins. `lane`:
/// of the block.
HWY_NOINLINE inline bool refine_group(const TriangleBlock& block, std::size_t lane,
                                      const RayPacket& packet, const RayGroup& group,
                                      FilteredGroup& out) {
    using F = GroupFloats;
    const auto row = [](const GroupRow& r) HWY_ATTR { return load_lanes<kGroupRays>(r); };
    const std::size_t kx = packet.kx, ky = packet.ky, kz = packet.kz;
    const F ox = row(group.origin[kx]), oy = row(group.origin[ky]), oz = row(group.origin[kz]);
    const F sx = row(group.slope[0]), sy = row(group.slope[1]), sz = row(group.reciprocal);
    struct {
        F x, y, z;
    } v[3];
    F far(0.0f);
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        v[i].z = F(block.vertex[i][kz][lane]) - oz;
        v[i].x = neg_mul_add(sx, v[i].z, F(block.vertex[i][kx][lane]) - ox);
        v[i].y = neg_mul_add(sy, v[i].z, F(block.vertex[i][ky][lane]) - oy);
        far = max_lanes(far, max_lanes(abs(v[i].x), abs(v[i].y)));
    }
    const F eu = edge_of(v[1], v[2]), ev = edge_of(v[2], v[0]), ew = edge_of(v[0], v[1]);
    const F least = min_lanes(min_lanes(eu, ev), ew), most = max_lanes(max_lanes(eu, ev), ew);
    const F fine = bound_crossing(v, far, eu, ev, ew, sz, F(packet.near_error), out.lo, out.hi);
    const auto outside = ((least < -fine) & (most > fine)) | (out.lo > row(group.s_max)) |
                         (out.hi < row(group.s_min));
    const auto inside = ((least > fine) | (most < -fine)) & (out.lo >= row(group.sure_min)) &
                        (out.hi <= row(group.sure_max));
    for (std::size_t i = 0; i < kParts<float, kGroupRays>; ++i) {
        out.candidates.part[i] = hn::Not(outside.part[i]);
        out.sure.part[i] = hn::AndNot(outside.part[i], inside.part[i]);
    }
    return (bits_of(out.candidates) & group.used) != 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
