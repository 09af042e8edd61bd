/// The filters of triangles and shapes with the rays of a packet in lanes (lane_packet-inl.h): one
/// of them against all rays of a set.
///
/// Source: triangle_filter.h and shape_filters.h, whose bounds they have; errors that depend on the
/// ray are those of the farthest ray of the packet.
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and is
/// never sure.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_FILTER_INL_H_
#endif

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_crossing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Which rays a triangle is hit by, and where.
struct FilteredLanes {
    std::uint32_t candidates, sure;
    PacketFloats lo, hi;

    // As that of LaneMask: not defaulted, for the sake of the target.
    HWY_INLINE FilteredLanes() {}
};

/// Bits of the triangles of a block whose boxes the frustum of a packet meets.
HWY_INLINE std::uint32_t intersect_triangles(const TriangleBlock& block, const LanePacket& packet) {
    Floats near[3], far[3], entry;
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const Floats a = load_lanes(block.vertex[0][k]), b = load_lanes(block.vertex[1][k]);
        const Floats c = load_lanes(block.vertex[2][k]);
        const Floats least = least_of(a, b, c), most = most_of(a, b, c);
        const bool up = packet.near_row[k] == k;
        near[k] = up ? least : most;
        far[k] = up ? most : least;
    }
    return packet.intersect_planes(near, far, entry);
}

/// The i-th of three rows of a block, for all rays, along their axes.
HWY_INLINE AxisRows<PacketFloats> for_rays(const float (&rows)[3][kBlockWidth], std::size_t i,
                                           const LanePacket& packet) {
    return {PacketFloats(rows[packet.kx][i]), PacketFloats(rows[packet.ky][i]),
            PacketFloats(rows[packet.kz][i])};
}
HWY_INLINE AxisRows<PacketFloats> origin_of(const LanePacket& packet) {
    return {load_row(packet.origin[packet.kx]), load_row(packet.origin[packet.ky]),
            load_row(packet.origin[packet.kz])};
}

/// False when no ray of `lanes` hits the triangle for all one knows; then `out` is not set.
HWY_INLINE bool filter_lanes(const TriangleBlock& block, std::size_t lane, const LanePacket& packet,
                             std::uint32_t lanes, FilteredLanes& out) {
    using F = PacketFloats;
    const AxisRows<F> origin = origin_of(packet);
    const F sx = load_row(packet.slope[0]), sy = load_row(packet.slope[1]);
    ShearedCorners<F> corners;
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        corners.set(i, for_rays(block.vertex[i], lane, packet) - origin, sx, sy);
    }
    TriangleCrossing<F> crossing(corners);
    if ((lanes &
         ~bits_of(crossing.missed_by_far(F(packet.edge_slack), F(packet.edge_slack_min)))) == 0) {
        return false;
    }
    crossing.bound(load_row(packet.reciprocal[packet.kz]), F(packet.near_error));
    out.candidates =
        lanes & ~bits_of(crossing.missed(load_row(packet.s_min), load_row(packet.s_max)));
    if (out.candidates == 0) return false;
    out.sure = out.candidates &
               bits_of(crossing.sure(load_row(packet.sure_min), load_row(packet.sure_max)));
    out.lo = crossing.lo;
    out.hi = crossing.hi;
    return true;
}

/// Bits of the rays of `lanes` whose range overlaps the part of the ray that a filter left.
HWY_INLINE std::uint32_t reaching(const Chord<PacketFloats>& parameters, const LanePacket& packet,
                                  std::uint32_t lanes) {
    using F = PacketFloats;
    const F slack = F(packet.place_error) * abs(load_row(packet.reciprocal[packet.kz]));
    return lanes & ~bits_of((parameters.first > parameters.last) |
                            (parameters.first - slack > load_row(packet.s_max)) |
                            (parameters.last + slack < load_row(packet.s_min)));
}

HWY_INLINE AxisRows<PacketFloats> from_center(const float (&center)[3][kBlockWidth], std::size_t i,
                                              const LanePacket& packet) {
    return origin_of(packet) - for_rays(center, i, packet);
}
HWY_INLINE AxisRows<PacketFloats> slopes_of(const LanePacket& packet) {
    return {load_row(packet.slope[0]), load_row(packet.slope[1]), PacketFloats(1.0f)};
}

HWY_INLINE SureRange<PacketFloats> sure_range(const LanePacket& packet) {
    using F = PacketFloats;
    const F sz = load_row(packet.reciprocal[packet.kz]);
    return {F(packet.place_error) * abs(sz), load_row(packet.sure_min), load_row(packet.sure_max)};
}

/// Bits of the rays of `lanes` that may hit a shape: shape_candidates with rays in the lanes. If
/// `kSure`, sets `sure` to those that certainly do.
template <bool kSure>
HWY_INLINE std::uint32_t filter_lanes(const SphereBlock& block, std::size_t i,
                                      const LanePacket& packet, std::uint32_t lanes,
                                      std::uint32_t& sure) {
    using F = PacketFloats;
    const float slack = kRoundSlack * packet.edge_slack;
    const RoundLine<F> line(from_center(block.center, i, packet), slopes_of(packet),
                            load_row(packet.reciprocal[packet.kz]));
    std::uint32_t missed;
    const Chord<F> chord = line.chord(F(block.radius[i] + slack), missed);
    lanes &= ~missed;
    sure = 0;
    if (lanes == 0) return 0;
    lanes = reaching(chord, packet, lanes);
    if (!kSure || lanes == 0) return lanes;
    F hi;
    sure = lanes &
           bits_of(line.sure(chord, F(block.radius[i] - 2.0f * slack), sure_range(packet), hi));
    return lanes;
}
template <bool kSure>
HWY_INLINE std::uint32_t filter_lanes(const FrustumBlock& block, std::size_t i,
                                      const LanePacket& packet, std::uint32_t lanes,
                                      std::uint32_t& sure) {
    using F = PacketFloats;
    const float slack = kRoundSlack * packet.edge_slack;
    const F unit = load_row(packet.reciprocal[packet.kz]);
    const CylinderLine<F> line(from_center(block.center, i, packet), slopes_of(packet),
                               for_rays(block.axis, i, packet), unit);
    std::uint32_t missed;
    const Chord<F> side = line.round.chord(F(block.radius[i] + slack), missed);
    lanes &= ~missed;
    sure = 0;
    if (lanes == 0) return 0;
    const SlabLine<F> slab = line_in_slab(line.along, line.climb, unit);
    const Chord<F> chord = common_part(side, chord_in_slab(slab, F(block.half_height[i] + slack)));
    lanes = reaching(chord, packet, lanes);
    if (!kSure || lanes == 0 || (block.certain >> i & 1) == 0) return lanes;
    F hi;
    sure = lanes & bits_of(line.sure(side, slab, F(block.half_height[i]), F(block.radius[i]),
                                     F(slack), sure_range(packet), hi));
    return lanes;
}
template <bool kSure>
HWY_INLINE std::uint32_t filter_lanes(const BoxBlock& block, std::size_t i,
                                      const LanePacket& packet, std::uint32_t lanes,
                                      std::uint32_t& sure) {
    using F = PacketFloats;
    const float slack = kSlabSlack * packet.edge_slack;
    const AxisRows<F> direction[3] = {for_rays(block.direction[0], i, packet),
                                      for_rays(block.direction[1], i, packet),
                                      for_rays(block.direction[2], i, packet)};
    const F half[3] = {F(block.half[0][i] + slack), F(block.half[1][i] + slack),
                       F(block.half[2][i] + slack)};
    const BoxLine<F> line(from_center(block.center, i, packet), slopes_of(packet), direction);
    const Chord<F> chord = line.chord(half, F(block.inset[i]));
    const F unit = load_row(packet.reciprocal[packet.kz]);
    const F a = chord.first * unit, b = chord.last * unit;
    lanes &= ~bits_of(chord.first > chord.last);
    const Chord<F> parameters{min_lanes(a, b), max_lanes(a, b)};
    lanes = reaching(parameters, packet, lanes);
    sure = 0;
    if (lanes == 0 || !(block.inset[i] < BoxBlock::kNotFlat)) return lanes;
    const F off = line.off_axis(), spread = line.spread(half[2]), inset(block.inset[i]);
    lanes &= ~bits_of(outside_ball(off, spread, F(block.radius[i] + 2.0f * slack), inset));
    if (!kSure || lanes == 0 || !(block.inset[i] < BoxBlock::kNoInset)) return lanes;
    F hi;
    sure = lanes & bits_of(line.sure(half, inset, F(slack), off, spread, parameters,
                                     sure_range(packet), hi));
    return lanes;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
