/// A packet of coherent rays in lanes, and the frustum around those that go one way: what
/// traverse_lanes-inl.h takes through the tree.
///
/// Source: Wald, Slusallek, Benthin and Wagner, "Interactive Rendering with Coherent Ray Tracing",
/// Computer Graphics Forum 20(3), 2001 (rays in lanes); Boulos, Wald and Shirley, "Geometric and
/// Arithmetic Culling Methods for Entire Ray Packets", University of Utah, UUCS-06-010, 2006 (the
/// interval of all rays before the rays).
/// Differs: both tests have the slack of `SlabRay`, so that no box is lost in which the test in
/// double of a ray finds a hit.
/// The rays of a set go the same way along every axis and fastest along one. Along an axis that
/// they go up let o be an origin, r a reciprocal of a direction and b the slack of SlabRay in
/// space, 6.5 e R + delta. No ray enters before (p - b - o) r at the least r and the largest o,
/// unless that is negative, nor leaves after (p + b - o) r at the largest r and the least o, unless
/// that is negative, and then it leaves before it begins. Both are products and sums of SlabRay's
/// form: its 6.01 e R hold for a box whose planes are rounded as well, as those of a block's
/// triangles are.
/// Conventions: included once per target (see simd/lanes-inl.h). Sets of rays are bits.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_LANE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_LANE_PACKET_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_LANE_PACKET_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_LANE_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/given_rays-inl.h"
#include "alhazen/accel/wide_bvh/trace/slab_ray.h"
#include "alhazen/accel/wide_bvh/trace/tree_box-inl.h"
#include "alhazen/simd/lane_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Rays of a packet: two registers where one holds sixteen, else more than that would lose.
inline constexpr std::size_t kPacketLanes = hn::MaxLanes(LaneTag<float, 16>()) == 16 ? 32 : 16;
/// Of eight rays.
inline constexpr std::size_t kLaneGroups = kPacketLanes / kRayLanes;
using PacketFloats = Lanes<float, kPacketLanes>;
using PacketMask = LaneMask<float, kPacketLanes>;
using PacketRow = float[kPacketLanes];

HWY_INLINE PacketFloats load_row(const PacketRow& row) {
    return load_lanes<kPacketLanes>(row);
}
#if HWY_CAP_GE512 && HWY_ARCH_X86
/// As for any lanes (simd/lanes-inl.h), but both masks are joined before they leave their
/// registers.
HWY_INLINE std::uint32_t bits_of(const PacketMask& a) {
    static_assert(kPacketLanes == 32);
    return _cvtmask32_u32(_mm512_kunpackw(a.part[1].raw, a.part[0].raw));
}
#endif
HWY_INLINE float least_of(const PacketFloats& a) {
    const LaneTag<float, kPacketLanes> d;
    auto least = a.part[0];
    for (std::size_t i = 1; i < kParts<float, kPacketLanes>; ++i) least = hn::Min(least, a.part[i]);
    return hn::GetLane(hn::MinOfLanes(d, least));
}
HWY_INLINE float most_of(const PacketFloats& a) {
    return -least_of(-a);
}

struct alignas(64) LanePacket {
    /// Groups of eight that are resolved together: two registers of double with AVX-512.
    static constexpr std::size_t kResolvedGroups = kPacketLanes == 32 ? 2 : 1;

    PacketRow origin[3], direction[3];                                     ///< in the local frame
    PacketRow reciprocal[3], near_offset[3], far_offset[3], s_min, s_max;  ///< as in SlabRay
    PacketRow sure_min, sure_max;                  ///< as in TriangleFilterRay
    PacketRow slope[2];                            ///< TriangleFilterRay::sx, sy of the set
    RayLanes rays[kLaneGroups];                    ///< as given: see lay_out
    std::uint32_t kx, ky, kz;                      ///< of the set, as in RayShear
    std::size_t near_row[3];                       ///< of the set: of WideNodeOf::planes
    float near_error, edge_slack, edge_slack_min;  ///< as in TriangleFilterRay, of any ray
    float place_error;  ///< TriangleFilterRay::s_slack of a reciprocal of 1

    /// Rays of a set that begin in one point. Axes and slopes as in TriangleFilterRay.
    struct alignas(64) Pinhole {
        PacketRow aside[2];  ///< slopes beside the middle one
        bool used;           ///< whether the set is one of them
        bool made;           ///< else nothing more is set: see make_pinhole
        float origin[3];
        float middle[2], wide[2];     ///< a slope is the middle one and up to `wide` more or less
        float least_step, most_step;  ///< magnitudes of reciprocals along the main axis
        float sure_min, sure_max;     ///< of all rays; if they differ, a range that holds nothing
        float most_off;               ///< what a sheared coordinate is off at most
    };
    Pinhole pinhole;

    /// Takes up to kPacketLanes rays; those of `wanted` that can be traced in lanes. Those that
    /// are found to miss `box` are no longer wanted. `may_share`: they are likely to begin in one
    /// point, with one range.
    [[nodiscard]] std::uint32_t load(const LaneFrame& lane_frame, const TreeBox& box,
                                     const GivenRays& given, std::uint32_t& wanted, bool may_share);
    /// Chooses those of the rays that go the way of the first, and makes their frustum.
    [[nodiscard]] std::uint32_t choose_set(std::uint32_t among);

    /// Fills `rays[group]`, once; `given` as for `load`.
    HWY_INLINE void lay_out(std::size_t group, const GivenRays& given) {
        if (!laid_out_[group]) take_group(group, given);
    }

    /// Sets the rest of `pinhole`, which only triangles need. Precondition: it is used.
    void make_pinhole();

    /// After rays have been limited.
    HWY_INLINE void shrink() {
        set_s_max_ = most_of(select_lanes(lanes_of_bits<float, kPacketLanes>(set_), load_row(s_max),
                                          PacketFloats(-std::numeric_limits<float>::infinity())));
    }
    /// The largest s_max of the set.
    [[nodiscard]] HWY_INLINE float deepest() const { return set_s_max_; }
    /// Bits of eight boxes [lower x, y, z, upper x, y, z][box] that the frustum meets, and where.
    HWY_INLINE std::uint32_t intersect_boxes(const float (&planes)[6][kLaneCount],
                                             Floats& entry) const {
        Floats near[3], far[3];
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            near[k] = load_lanes(planes[near_row[k]]);
            far[k] = load_lanes(planes[far_row(k)]);
        }
        return intersect_planes(near, far, entry);
    }
    HWY_INLINE std::uint32_t intersect_planes(const Floats (&near)[3], const Floats (&far)[3],
                                              Floats& entry) const {
        Floats in[3], out[3];
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            in[k] = mul_add(near[k], Floats(set_near_[k]), Floats(set_near_offset_[k]));
            out[k] = mul_add(far[k], Floats(set_far_[k]), Floats(set_far_offset_[k]));
        }
        entry =
            larger_by_bits(larger_by_bits(in[0], in[1]), larger_by_bits(in[2], Floats(set_s_min_)));
        const Floats exit = smaller_by_bits(smaller_by_bits(out[0], out[1]),
                                            smaller_by_bits(out[2], Floats(set_s_max_)));
        return bits_of(entry <= exit);
    }
    [[nodiscard]] HWY_INLINE std::size_t far_row(std::size_t k) const {
        return 2 * k + 3 - near_row[k];
    }

  private:
    static constexpr std::size_t kLoadedRays = 16;  ///< at a time
    static constexpr std::size_t kLoads = kPacketLanes / kLoadedRays;

    using LoadedFloats = Lanes<float, kLoadedRays>;

    HWY_INLINE std::uint32_t load_apart(const LaneFrame& lane_frame, const TreeBox& box,
                                        const GivenRays& given, std::uint32_t& wanted);
    HWY_INLINE std::uint32_t load_from_one_start(const LaneFrame& lane_frame, const TreeBox& box,
                                                 const GivenRays& given, std::uint32_t& wanted);
    HWY_INLINE LaneMask<float, kLoadedRays> store_start(const LoadedFloats* o,
                                                        const LoadedFloats& t_min,
                                                        const LoadedFloats& t_max, std::size_t at);
    HWY_INLINE void set_errors(const FrameSlack& slack, float distance);
    template <std::size_t N>
    HWY_INLINE void store_slab(std::size_t k, const Lanes<float, N>& o, const Lanes<float, N>& r,
                               std::size_t at);
    void take_group(std::size_t group, const GivenRays& given);
    void make_frustum(std::uint32_t set, std::size_t first);

    std::uint32_t set_ = 0;
    bool one_start_ = false;      ///< all rays have `start_`
    alignas(16) float start_[4];  ///< origin and s_min
    float slack_ = 0;             ///< of a box, in space
    bool laid_out_[kLaneGroups] = {};
    alignas(16) float set_near_[4], set_near_offset_[4], set_far_[4], set_far_offset_[4];
    float set_s_min_ = 0, set_s_max_ = 0;
};

/// The slab tests of the rays of a packet, in registers.
struct LaneSlabs {
    PacketFloats reciprocal[3], near_offset[3], far_offset[3], s_min, s_max;

    HWY_INLINE explicit LaneSlabs(const LanePacket& packet)
        : s_min(load_row(packet.s_min)), s_max(load_row(packet.s_max)) {
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            reciprocal[k] = load_row(packet.reciprocal[k]);
            near_offset[k] = load_row(packet.near_offset[k]);
            far_offset[k] = load_row(packet.far_offset[k]);
        }
    }
    /// Bits of the rays of the packet's set that meet the box of a child.
    HWY_INLINE std::uint32_t meet(const WideNode& node, std::size_t slot,
                                  const LanePacket& packet) const {
        PacketFloats in[3], out[3];
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            in[k] = mul_add(PacketFloats(node.planes[packet.near_row[k]][slot]), reciprocal[k],
                            near_offset[k]);
            out[k] = mul_add(PacketFloats(node.planes[packet.far_row(k)][slot]), reciprocal[k],
                             far_offset[k]);
        }
        const PacketFloats entry =
            larger_by_bits(larger_by_bits(in[0], in[1]), larger_by_bits(in[2], s_min));
        const PacketFloats exit =
            smaller_by_bits(smaller_by_bits(out[0], out[1]), smaller_by_bits(out[2], s_max));
        return bits_of(entry <= exit);
    }
};

/// Fills sixteen lanes of the rows of origins, three of them given, and ends; the rays that can be
/// traced.
HWY_INLINE LaneMask<float, LanePacket::kLoadedRays> LanePacket::store_start(
    const LoadedFloats* o, const LoadedFloats& t_min, const LoadedFloats& t_max, std::size_t at) {
    using F = LoadedFloats;
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) store_lanes(o[k], origin[k] + at);
    // As local_ray_nearby.
    const F begin = min_lanes(t_min, F(1e37f)), end = min_lanes(t_max, F(1e37f));
    const F less(1.0f - 0x1p-22f), more(1.0f + 0x1p-22f), tiny(0x1p-100f);
    store_lanes(max_lanes(mul_sub(begin, less, tiny), F(0.0f)), s_min + at);
    store_lanes(mul_add(begin, more, tiny), sure_min + at);
    store_lanes(mul_sub(end, less, tiny), sure_max + at);
    store_lanes(mul_add(end, more, tiny), s_max + at);
    // A NaN is near nothing, and beyond everything by its bits. Rounding keeps the order of the
    // ends; those that are equal then are left to others, as is a beginning of -0, which may have
    // been less.
    const F far = larger_by_bits(larger_by_bits(abs(o[0]), abs(o[1])), abs(o[2]));
    return (t_min < t_max) & (copysign(F(1.0f), t_min) > F(0.0f)) & (far <= F(8.0f));
}
/// Which directions are neither too short nor too long.
HWY_INLINE LaneMask<float, 16> of_usable_length(const LaneFrame& lane_frame,
                                                const Lanes<float, 16>* d) {
    using F = Lanes<float, 16>;
    const F most = larger_by_bits(larger_by_bits(abs(d[0]), abs(d[1])), abs(d[2]));
    return (most <= F(0x1p40f)) & (most >= F(lane_frame.frame.slack.least_length));
}

HWY_INLINE void LanePacket::set_errors(const FrameSlack& slack, float distance) {
    slack_ = slack.slab.at(distance);
    const float reach = slack.reach.at(distance), delta = slack.delta.at(distance);
    const float unit = 0x1p-24f, error = 13.2f * unit * reach + 4.0f * delta;
    near_error = 2.2f * unit * reach + 4.0f * delta;
    place_error = 14.2f * unit * reach + 4.0f * delta;
    edge_slack = 5.12f * error;
    edge_slack_min = 2.12f * error * error;
}

/// As make_slab_ray.
template <std::size_t N>
HWY_INLINE Lanes<float, N> reciprocal_of(const Lanes<float, N>& d) {
    using F = Lanes<float, N>;
    return F(1.0f) / copysign(larger_by_bits(abs(d), F(0x1p-100f)), d);
}
template <std::size_t N>
HWY_INLINE void LanePacket::store_slab(std::size_t k, const Lanes<float, N>& o,
                                       const Lanes<float, N>& r, std::size_t at) {
    using F = Lanes<float, N>;
    const F c = -(o * r), aside = F(slack_) * abs(r);
    store_lanes(r, reciprocal[k] + at);
    store_lanes(c - aside, near_offset[k] + at);
    store_lanes(c + aside, far_offset[k] + at);
}

inline void LanePacket::take_group(std::size_t group, const GivenRays& given) {
    laid_out_[group] = true;
#if HWY_CAP_GE512
    if (one_start_ && given.columns() == nullptr) {
        return take_lanes_of_start(
            std::span<const Ray, kRayLanes>(given.array() + group * kRayLanes, kRayLanes),
            rays[group]);
    }
#endif
    // A group without rays repeats the last ray.
    const std::size_t first = std::min(group * kRayLanes, given.size() - 1);
    take_lanes(given.part(first, std::min(kRayLanes, given.size() - first)), rays[group]);
}

HWY_INLINE std::uint32_t LanePacket::load_apart(const LaneFrame& lane_frame, const TreeBox& box,
                                                const GivenRays& given, std::uint32_t& wanted) {
    LoadedFloats rows[kLoads][8];
    HWY_UNROLL(2)
    for (std::size_t n = 0; n < kLoads; ++n) {
        const std::size_t at = n * kLoadedRays;
        if (HWY_UNLIKELY(given.size() < at + kLoadedRays)) {
            Ray repeated[kLoadedRays];
            for (std::size_t i = 0; i < kLoadedRays; ++i) {
                Ray scratch;
                repeated[i] = given.ray(std::min(at + i, given.size() - 1), scratch);
            }
            load_local(lane_frame, repeated, rows[n]);
        } else if (given.columns() != nullptr) {
            load_local(lane_frame, *given.columns(), given.first() + at, rows[n]);
        } else {
            load_local(lane_frame,
                       std::span<const Ray, kLoadedRays>(given.array() + at, kLoadedRays), rows[n]);
        }
        wanted &= ~(box.left_by(rows[n], rows[n] + 3, rows[n][6]) << at);
    }
    if (wanted == 0) return 0;
    std::uint32_t usable = 0;
    HWY_UNROLL(2)
    for (std::size_t n = 0; n < kLoads; ++n) {
        const std::size_t at = n * kLoadedRays;
        const LoadedFloats* const d = rows[n] + 3;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) store_lanes(d[k], direction[k] + at);
        const auto begins = store_start(rows[n], rows[n][6], rows[n][7], at);
        usable |= bits_of(begins & of_usable_length(lane_frame, d)) << at;
    }
    usable &= wanted;
    if (usable == 0) return 0;
    PacketFloats most(0.0f);
    for (const PacketRow& row : origin) most = max_lanes(most, abs(load_row(row)));
    set_errors(lane_frame.frame.slack,
               most_of(select_lanes(lanes_of_bits<float, kPacketLanes>(usable), most,
                                    PacketFloats(0.0f))));
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        store_slab(k, load_row(origin[k]), reciprocal_of(load_row(direction[k])), 0);
    }
    return usable;
}

HWY_INLINE std::uint32_t LanePacket::load_from_one_start(const LaneFrame& lane_frame,
                                                         const TreeBox& box, const GivenRays& given,
                                                         std::uint32_t& wanted) {
    float ends[2], point[3], distance = 0.0f;
    lane_frame.start_of(given, point, ends);
    for (std::size_t k = 0; k < 3; ++k) {
        // Written so that a NaN is far.
        if (!(std::abs(point[k]) <= TreeBox::kNear)) return 0;
        distance = std::max(distance, std::abs(point[k]));
    }
    LoadedFloats d[kLoads][3], r[kLoads][3];
    std::uint32_t usable = 0, missed = 0;
    HWY_UNROLL(2)
    for (std::size_t n = 0; n < kLoads; ++n) {
        const std::size_t at = n * kLoadedRays;
        if (given.columns() != nullptr) {
            load_directions(*given.columns(), given.first() + at, d[n]);
        } else {
            load_directions(std::span<const Ray, kLoadedRays>(given.array() + at, kLoadedRays),
                            d[n]);
        }
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) r[n][k] = reciprocal_of(d[n][k]);
        usable |= bits_of(of_usable_length(lane_frame, d[n])) << at;
        missed |= box.missed_from(point, r[n]) << at;
    }
    // `ends` in float keeps the sign of what rounds to 0.
    if (!std::signbit(ends[0])) wanted &= ~(missed & usable);
    if ((wanted & usable) == 0) return 0;
    set_errors(lane_frame.frame.slack, distance);
    const LoadedFloats o[3] = {LoadedFloats(point[0]), LoadedFloats(point[1]),
                               LoadedFloats(point[2])};
    std::uint32_t begun = 0;
    HWY_UNROLL(2)
    for (std::size_t n = 0; n < kLoads; ++n) {
        const std::size_t at = n * kLoadedRays;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            store_lanes(d[n][k], direction[k] + at);
            store_slab(k, o[k], r[n][k], at);
        }
        const auto begins = store_start(o, LoadedFloats(ends[0]), LoadedFloats(ends[1]), at);
        begun |= bits_of(begins) << at;
    }
    for (std::size_t k = 0; k < 3; ++k) start_[k] = point[k];
    start_[3] = s_min[0];
    return usable & begun & wanted;
}

inline std::uint32_t LanePacket::load(const LaneFrame& lane_frame, const TreeBox& box,
                                      const GivenRays& given, std::uint32_t& wanted,
                                      bool may_share) {
    one_start_ = may_share && given.size() >= kPacketLanes && given.share_start<kPacketLanes>();
    return one_start_ ? load_from_one_start(lane_frame, box, given, wanted)
                      : load_apart(lane_frame, box, given, wanted);
}

inline std::uint32_t LanePacket::choose_set(std::uint32_t among) {
    const auto first = static_cast<std::size_t>(std::countr_zero(among));
    const auto along = [&](std::size_t k) { return std::abs(direction[k][first]); };
    kz = along(1) > along(0) ? 1 : 0;
    if (along(2) > along(kz)) kz = 2;
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    const PacketFloats zero(0.0f);
    const PacketFloats z = abs(load_row(direction[kz]));
    PacketMask same = (z >= abs(load_row(direction[kx]))) & (z >= abs(load_row(direction[ky])));
    for (std::size_t k = 0; k < 3; ++k) {
        const PacketFloats r = load_row(reciprocal[k]);
        const bool up = reciprocal[k][first] > 0.0f;
        near_row[k] = up ? k : k + 3;
        same = same & (up ? r > zero : r < zero);
    }
    const std::uint32_t set = bits_of(same) & among;
    make_frustum(set, first);
    return set;
}

inline void LanePacket::make_frustum(std::uint32_t set, std::size_t first) {
    using F4 = Lanes<float, 4>;
    set_ = set;
    const PacketMask in_set = lanes_of_bits<float, kPacketLanes>(set);
    // Rays of other sets repeat the first.
    const auto row_of_set = [&](const PacketRow& row) HWY_ATTR {
        return select_lanes(in_set, load_row(row), PacketFloats(row[first]));
    };
    F4 least_start, most_start;
    if (one_start_) {
        least_start = most_start = load_lanes<4>(start_);
    } else {
        const PacketFloats starts[4] = {row_of_set(origin[0]), row_of_set(origin[1]),
                                        row_of_set(origin[2]), row_of_set(s_min)};
        const LaneExtremes<kPacketLanes> o(starts);
        least_start = o.least;
        most_start = o.most;
    }
    const PacketFloats steps[4] = {abs(row_of_set(reciprocal[0])), abs(row_of_set(reciprocal[1])),
                                   abs(row_of_set(reciprocal[2])), row_of_set(s_max)};
    const LaneExtremes<kPacketLanes> a(steps);
    std::uint32_t ways = 0;
    for (std::size_t k = 0; k < 3; ++k) ways |= std::uint32_t{near_row[k] == k} << k;
    const auto up = lanes_of_bits<float, 4>(ways);
    const F4 o_least = least_start - F4(slack_), o_most = most_start + F4(slack_);
    const F4 near = select_lanes(up, a.least, -a.least), far = select_lanes(up, a.most, -a.most);
    store_lanes(near, set_near_);
    store_lanes(far, set_far_);
    store_lanes(-select_lanes(up, o_most, o_least) * near, set_near_offset_);
    store_lanes(-select_lanes(up, o_least, o_most) * far, set_far_offset_);
    HWY_ALIGN float ends[2][4];
    store_lanes(least_start, ends[0]);
    store_lanes(a.most, ends[1]);
    set_s_min_ = ends[0][3];
    set_s_max_ = ends[1][3];
    const PacketFloats sz = load_row(reciprocal[kz]);
    store_lanes(load_row(direction[kx]) * sz, slope[0]);
    store_lanes(load_row(direction[ky]) * sz, slope[1]);
    pinhole.used = one_start_ || (bits_of(least_start >= most_start) & 7) == 7;
    pinhole.made = false;
}

inline void LanePacket::make_pinhole() {
    pinhole.made = true;
    const PacketMask in_set = lanes_of_bits<float, kPacketLanes>(set_);
    const auto first = static_cast<std::size_t>(std::countr_zero(set_));
    const PacketFloats x = load_row(slope[0]), y = load_row(slope[1]);
    const PacketFloats own_x = select_lanes(in_set, x, PacketFloats(slope[0][first]));
    const PacketFloats own_y = select_lanes(in_set, y, PacketFloats(slope[1][first]));
    const PacketFloats rows[4] = {own_x, own_y, own_x, own_y};
    const LaneExtremes<kPacketLanes> s(rows);
    HWY_ALIGN float least[4], most[4];
    store_lanes(s.least, least);
    store_lanes(s.most, most);
    for (std::size_t k = 0; k < 2; ++k) {
        const float middle = 0.5f * (least[k] + most[k]);
        pinhole.middle[k] = middle;
        // Rounding keeps the order of the differences.
        pinhole.wide[k] = std::max(middle - least[k], most[k] - middle);
    }
    store_lanes(x - PacketFloats(pinhole.middle[0]), pinhole.aside[0]);
    store_lanes(y - PacketFloats(pinhole.middle[1]), pinhole.aside[1]);
    pinhole.origin[0] = origin[kx][first];
    pinhole.origin[1] = origin[ky][first];
    pinhole.origin[2] = origin[kz][first];
    pinhole.least_step = std::abs(set_near_[kz]);
    pinhole.most_step = std::abs(set_far_[kz]);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    pinhole.sure_min = one_start_ ? sure_min[0] : kInfinity;
    pinhole.sure_max = one_start_ ? sure_max[0] : -kInfinity;
    pinhole.most_off = 1.1f / 5.12f * edge_slack;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
