/// The filter of triangles for rays in lanes that begin in one point, as eye rays of a pinhole
/// camera do: eight triangles of a block are made ready at once, and culled against all rays.
///
/// Source: packet_filter-inl.h (edge functions linear in the slopes, and their bound), with E of
/// triangle_filter.h as it is near the triangle; Boulos, Wald and Shirley, "Geometric and
/// Arithmetic Culling Methods for Entire Ray Packets", UUCS-06-010, 2006 (the interval of an edge
/// function over the slopes of a packet).
/// The slopes of the rays are the middle one and (a, b) more, |a| <= w_x, |b| <= w_y. With the
/// corners from the origin of the rays at (x, y, z), sheared along the middle slope:
/// - along (a, b) a corner is at x - a z, off by E' <= 1.1 (2.2 e R + 7.3 e (L + Z) + 4 delta), L
///   the largest |x|, |y| and w |z| more: one rounding more than in triangle_filter.h, e w Z. If
///   all are above E' or below -E' for all slopes, no ray hits.
/// - an edge function is c_0 + a c_1 + b c_2; 10 e L^2 for its rounding are less than 1.3 E' L, so
///   5.6 E' L + 2.2 E'^2 hold. Its interval over the slopes is c_0 -+ (w_x |c_1| + w_y |c_2|),
///   which rounds no more; that of the sum of the three is off by less than four times as much. If
///   an edge function is negative for all rays and the sum positive, or the other way round, signs
///   are mixed and no ray hits.
/// - a hit is within 1.6 E' of the depths of the corners. These are its interval, without the
///   division by the sum of the edge functions, where they differ by less than a 64th of the least.
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes and is never sure.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_PINHOLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_PINHOLE_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_PINHOLE_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_PINHOLE_INL_H_
#endif

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/packets/lane_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The triangles of a block as the rays of a set see them.
struct PinholeTriangles {
    /// [1 2, 2 0, 0 1][constant, times a, times b][lane]
    HWY_ALIGN float edge[3][3][kBlockWidth];
    HWY_ALIGN float error[kBlockWidth];                     ///< of an edge function
    HWY_ALIGN float z[3][kBlockWidth];                      ///< of the corners from the origin
    HWY_ALIGN float first[kBlockWidth], last[kBlockWidth];  ///< of z
    HWY_ALIGN float spread[kBlockWidth];  ///< by how much the weights' errors move a place, times
                                          ///< their sum
    HWY_ALIGN float place_error[kBlockWidth];              ///< beside that
    HWY_ALIGN float begin[kBlockWidth], end[kBlockWidth];  ///< of the magnitudes of places
    std::uint32_t met;                                     ///< bits of those that rays may hit
    bool flat;  ///< begin and end of these are close together, and in the range of all rays

    HWY_INLINE PinholeTriangles(const TriangleBlock& block, const LanePacket& packet) {
        const LanePacket::Pinhole& pinhole = packet.pinhole;
        const Floats wide[2] = {Floats(pinhole.wide[0]), Floats(pinhole.wide[1])};
        const AxisRows<Floats> origin{Floats(pinhole.origin[0]), Floats(pinhole.origin[1]),
                                      Floats(pinhole.origin[2])};
        ShearedCorners<Floats> sheared;
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            sheared.set(i, load_axes(block.vertex[i], packet) - origin, Floats(pinhole.middle[0]),
                        Floats(pinhole.middle[1]));
        }
        const auto& p = sheared.corner;
        const Floats lowest = least_of(p[0].z, p[1].z, p[2].z);
        const Floats highest = most_of(p[0].z, p[1].z, p[2].z);
        const Floats deep = max_lanes(highest, -lowest);
        Floats across(0.0f), off;
        LaneMask<float> missed;
        {
            Floats left[2], right[2];
            HWY_UNROLL(2)
            for (std::size_t k = 0; k < 2; ++k) {
                Floats lo[3], hi[3];
                HWY_UNROLL(3)
                for (std::size_t i = 0; i < 3; ++i) {
                    const Floats room = wide[k] * abs(p[i].z), at = k == 0 ? p[i].x : p[i].y;
                    lo[i] = at - room;
                    hi[i] = at + room;
                }
                left[k] = least_of(lo[0], lo[1], lo[2]);
                right[k] = most_of(hi[0], hi[1], hi[2]);
                across = max_lanes(across, max_lanes(right[k], -left[k]));
            }
            off = Floats(1.1f) *
                  mul_add(across + deep, Floats(7.3f * 0x1p-24f), Floats(packet.near_error));
            const Floats most_off(pinhole.most_off);
            missed = (max_lanes(left[0], left[1]) > most_off) |
                     (min_lanes(right[0], right[1]) < -most_off);
        }
        const Floats slack = off * mul_add(across, Floats(5.6f), off * Floats(2.2f));
        const Floats aside = off * Floats(1.6f);
        store_lanes(slack, error);
        const bool up = packet.near_row[packet.kz] == packet.kz;
        const Floats beside(1.6f * pinhole.most_off);
        const Floats near = up ? lowest : -highest, back = up ? highest : -lowest;
        const Floats front = near - beside;
        const Floats begins = near - aside, ends = back + aside;
        store_lanes(begins, begin);
        store_lanes(ends, end);
        const std::uint32_t plain =
            bits_of(((back - near) * Floats(64.0f) <= near) &
                    (begins * Floats(pinhole.least_step) >= Floats(pinhole.sure_min)) &
                    (ends * Floats(pinhole.most_step) <= Floats(pinhole.sure_max)));
        missed = missed | (back < -beside) |
                 (front * Floats(pinhole.least_step) > Floats(packet.deepest()));
        missed = missed | find_edges(sheared, wide, slack);
        met = kAllLanes & ~bits_of(missed);
        flat = (met & ~plain) == 0;
        if (flat) return;
        for (std::size_t i = 0; i < 3; ++i) store_lanes(p[i].z, z[i]);
        store_lanes(aside, place_error);
        store_lanes(lowest, first);
        store_lanes(highest, last);
        store_lanes(Floats(25.0f) * slack * (highest - lowest), spread);
    }

  private:
    /// The triangles that no ray hits, by their edges.
    HWY_INLINE LaneMask<float> find_edges(const ShearedCorners<Floats>& sheared,
                                          const Floats (&wide)[2], const Floats& slack) {
        Floats sum[3], lowest, highest;
        HWY_UNROLL(3)
        for (std::size_t e = 0; e < 3; ++e) {
            const LinearEdge<Floats> linear(sheared, e);
            const auto& c = linear.part;
            HWY_UNROLL(3)
            for (std::size_t k = 0; k < 3; ++k) {
                store_lanes(c[k], edge[e][k]);
                sum[k] = e == 0 ? c[k] : sum[k] + c[k];
            }
            const Floats room = mul_add(wide[0], abs(c[1]), wide[1] * abs(c[2]));
            const Floats lo = c[0] - room, hi = c[0] + room;
            lowest = e == 0 ? hi : min_lanes(lowest, hi);
            highest = e == 0 ? lo : max_lanes(highest, lo);
        }
        const Floats room = mul_add(wide[0], abs(sum[1]), wide[1] * abs(sum[2]));
        const Floats four = Floats(4.0f) * slack;
        return ((lowest < -slack) & (sum[0] - room > four)) |
               ((highest > slack) & (sum[0] + room < -four));
    }
};

/// As `filter_lanes` of a block.
HWY_INLINE bool filter_lanes(const PinholeTriangles& seen, std::size_t lane,
                             const LanePacket& packet, std::uint32_t lanes, FilteredLanes& out) {
    using F = PacketFloats;
    const F a = load_row(packet.pinhole.aside[0]), b = load_row(packet.pinhole.aside[1]);
    const auto edge = [&](std::size_t e) HWY_ATTR {
        return mul_add(b, F(seen.edge[e][2][lane]),
                       mul_add(a, F(seen.edge[e][1][lane]), F(seen.edge[e][0][lane])));
    };
    const EdgeFunctions<F> edges(edge(0), edge(1), edge(2));
    const F error(seen.error[lane]);
    const std::uint32_t passed = lanes & ~bits_of(edges.mixed(error));
    if (passed == 0) return false;
    const F sz = load_row(packet.reciprocal[packet.kz]);
    // Written so that a NaN is a candidate and not sure.
    if (seen.flat) {
        out.lo = abs(sz) * F(seen.begin[lane]);
        out.hi = abs(sz) * F(seen.end[lane]);
        out.candidates = passed & ~bits_of(out.lo > load_row(packet.s_max));
        if (out.candidates == 0) return false;
        out.sure = out.candidates & bits_of(edges.alike(error));
        return true;
    }
    const F inverse = F(1.0f) / edges.sum();
    const F place =
        edges.weighted(F(seen.z[0][lane]), F(seen.z[1][lane]), F(seen.z[2][lane])) * inverse;
    const F s = min_lanes(max_lanes(place, F(seen.first[lane])), F(seen.last[lane])) * sz;
    const F slack =
        abs(sz) * mul_add(F(seen.spread[lane]), abs(inverse), F(seen.place_error[lane]));
    out.lo = s - slack;
    out.hi = s + slack;
    out.candidates =
        passed & ~bits_of((out.lo > load_row(packet.s_max)) | (out.hi < load_row(packet.s_min)));
    if (out.candidates == 0) return false;
    out.sure = out.candidates & bits_of(edges.alike(error) & (out.lo >= load_row(packet.sure_min)) &
                                        (out.hi <= load_row(packet.sure_max)));
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
