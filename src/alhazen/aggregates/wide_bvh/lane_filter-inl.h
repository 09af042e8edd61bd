/// The filters of triangles and shapes with the rays of a packet in lanes (lane_packet-inl.h): one
/// of them against all rays of a set.
///
/// Source: triangle_filter.h and shape_filters.h, whose bounds they have; errors that depend on the
/// ray are those of the farthest ray of the packet.
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and is
/// never sure.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LANE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LANE_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LANE_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LANE_FILTER_INL_H_
#endif

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/lane_crossing-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"

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
        const Floats least = min_lanes(min_lanes(a, b), c), most = max_lanes(max_lanes(a, b), c);
        const bool up = packet.near_row[k] == k;
        near[k] = up ? least : most;
        far[k] = up ? most : least;
    }
    return packet.intersect_planes(near, far, entry);
}

/// False when no ray of `lanes` hits the triangle for all one knows; then `out` is not set.
HWY_INLINE bool filter_lanes(const TriangleBlock& block, std::size_t lane, const LanePacket& packet,
                             std::uint32_t lanes, FilteredLanes& out) {
    using F = PacketFloats;
    const std::size_t kx = packet.kx, ky = packet.ky, kz = packet.kz;
    const F ox = load_row(packet.origin[kx]), oy = load_row(packet.origin[ky]);
    const F oz = load_row(packet.origin[kz]);
    const F sx = load_row(packet.slope[0]), sy = load_row(packet.slope[1]);
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
    const auto edge = [](const auto& a, const auto& b)
                          HWY_ATTR { return mul_sub(a.x, b.y, a.y * b.x); };
    const F eu = edge(v[1], v[2]), ev = edge(v[2], v[0]), ew = edge(v[0], v[1]);
    const F error = mul_add(far, F(packet.edge_slack), F(packet.edge_slack_min));
    const F least = min_lanes(min_lanes(eu, ev), ew), most = max_lanes(max_lanes(eu, ev), ew);
    if ((lanes & ~bits_of((least < -error) & (most > error))) == 0) return false;

    const F sz = load_row(packet.reciprocal[kz]);
    const F fine = bound_crossing(v, far, eu, ev, ew, sz, F(packet.near_error), out.lo, out.hi);
    // Written so that a NaN is a candidate and not sure.
    out.candidates =
        lanes & ~bits_of(((least < -fine) & (most > fine)) | (out.lo > load_row(packet.s_max)) |
                         (out.hi < load_row(packet.s_min)));
    if (out.candidates == 0) return false;
    out.sure = out.candidates &
               bits_of(((least > fine) | (most < -fine)) & (out.lo >= load_row(packet.sure_min)) &
                       (out.hi <= load_row(packet.sure_max)));
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

/// The i-th of three rows of a block, for all rays, along their axes.
HWY_INLINE AxisRows<PacketFloats> for_rays(const float (&rows)[3][kBlockWidth], std::size_t i,
                                           const LanePacket& packet) {
    return {PacketFloats(rows[packet.kx][i]), PacketFloats(rows[packet.ky][i]),
            PacketFloats(rows[packet.kz][i])};
}
HWY_INLINE AxisRows<PacketFloats> from_center(const float (&center)[3][kBlockWidth], std::size_t i,
                                              const LanePacket& packet) {
    const AxisRows<PacketFloats> c = for_rays(center, i, packet);
    return {load_row(packet.origin[packet.kx]) - c.x, load_row(packet.origin[packet.ky]) - c.y,
            load_row(packet.origin[packet.kz]) - c.z};
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
