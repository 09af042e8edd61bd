/// Constructs a frustum packet from rays: groups of rays of a common direction, the point near
/// which all pass, and the planes around them.
///
/// Source: see packet-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_MAKE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_MAKE_PACKET_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_MAKE_PACKET_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_MAKE_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

inline bool RayPacket::make(const LocalFrame& frame, std::span<const Ray> given,
                            std::uint64_t& used) {
    used &= load(frame, given);
    if (used == 0 || !keep_one_way(used)) return false;
    for (std::size_t i = 0; i < 2; ++i) {
        store_lanes(Floats(std::numeric_limits<float>::infinity()), slope_lo[i]);
        store_lanes(Floats(-std::numeric_limits<float>::infinity()), slope_hi[i]);
    }
    store_lanes(Floats(-std::numeric_limits<float>::infinity()), group_k_max);
    store_lanes(Floats(std::numeric_limits<float>::infinity()), group_k_min);
    for (std::size_t g = 0; g < group_count; ++g) make_slopes(g);
    if (!find_point() || !find_planes()) return false;
    for (std::size_t g = 0; g < group_count; ++g) {
        retire(groups[g], kAllLanes & ~groups[g].used);
    }
    shrink_all();
    return true;
}

inline std::uint64_t RayPacket::load(const LocalFrame& frame, std::span<const Ray> given) {
    group_count = (given.size() + kGroupRays - 1) / kGroupRays;
    for (std::size_t g = 0; g < group_count; ++g) {
        const std::span<const Ray> group = given.subspan(g * kGroupRays);
        if (group.size() >= kGroupRays) {
            take_lanes(group.first<kGroupRays>(), rays[g]);
            continue;
        }
        for (std::size_t i = 0; i < kGroupRays; ++i) {
            rays[g].set(i, group[std::min(i, group.size() - 1)]);
        }
    }
    std::uint64_t used = 0;
    for (std::size_t g = 0; g < group_count; ++g) {
        used |= std::uint64_t{load_rays(frame, rays[g], groups[g])} << (g * kGroupRays);
    }
    const std::uint64_t all = ~std::uint64_t{0} >> (kPacketRays - given.size());
    float distance = 0;
    for (std::size_t g = 0; g < group_count; ++g) {
        GroupFloats most(0.0f);
        for (const GroupRow& row : groups[g].origin) {
            most = max_lanes(most, abs(load_lanes<kGroupRays>(row)));
        }
        distance = std::max(distance, RayGroup::most_of(most));
    }
    // An unused ray may be NaN and hide another, so the limit of load_rays is taken then.
    if ((used & all) != all) distance = 8.0f;
    reach_ = frame.slack.reach.at(distance);
    delta_ = frame.slack.delta.at(distance);
    near_error = 2.2f * kUnit * reach_ + 4.0f * delta_;
    return used & all;
}

/// Keeps the rays with the dominant axis and the sign of the first one; sets the axes.
inline bool RayPacket::keep_one_way(std::uint64_t& used) {
    const auto first = static_cast<std::size_t>(std::countr_zero(used));
    const RayGroup& leader = groups[first / kGroupRays];
    const std::size_t lane = first % kGroupRays;
    const auto along = [&](std::size_t k) { return leader.direction[k][lane]; };
    kz = std::abs(along(1)) > std::abs(along(0)) ? 1 : 0;
    if (std::abs(along(2)) > std::abs(along(kz))) kz = 2;
    kx = (kz + 1) % 3;
    ky = (kz + 2) % 3;
    sign_ = along(kz) < 0.0f ? -1.0f : 1.0f;
    std::uint64_t same = 0;
    for (std::size_t g = 0; g < group_count; ++g) {
        const auto z = load_lanes<kGroupRays>(groups[g].direction[kz]) * GroupFloats(sign_);
        const auto x = abs(load_lanes<kGroupRays>(groups[g].direction[kx]));
        const auto y = abs(load_lanes<kGroupRays>(groups[g].direction[ky]));
        same |= std::uint64_t{bits_of((z >= x) & (z >= y))} << (g * kGroupRays);
    }
    used &= same;
    if (used == 0) return false;
    const std::uint64_t lanes = group_count == kPacketGroups
                                    ? ~std::uint64_t{0}
                                    : (std::uint64_t{1} << (group_count * kGroupRays)) - 1;
    for (std::uint64_t rest = lanes & ~used; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(rest));
        RayGroup& group = groups[i / kGroupRays];
        const std::size_t at = i % kGroupRays;
        for (std::size_t k = 0; k < 3; ++k) {
            group.origin[k][at] = leader.origin[k][lane];
            group.direction[k][at] = leader.direction[k][lane];
        }
        group.s_min[at] = leader.s_min[lane];
        group.s_max[at] = leader.s_max[lane];
    }
    for (std::size_t g = 0; g < group_count; ++g) {
        groups[g].used = static_cast<std::uint32_t>(used >> (g * kGroupRays)) & kAllLanes;
    }
    return true;
}

HWY_INLINE void RayPacket::make_slopes(std::size_t g) {
    RayGroup& group = groups[g];
    const GroupFloats z = load_lanes<kGroupRays>(group.direction[kz]);
    const GroupFloats reciprocal = GroupFloats(1.0f) / z;
    store_lanes(reciprocal, group.reciprocal);
    store_lanes(z * GroupFloats(sign_), group.rate);
    const std::uint32_t axes[2] = {kx, ky};
    HWY_UNROLL(2)
    for (std::size_t i = 0; i < 2; ++i) {
        const GroupFloats s = load_lanes<kGroupRays>(group.direction[axes[i]]) * reciprocal;
        store_lanes(s, group.slope[i]);
        slope_lo[i][g] = RayGroup::least_of(s);
        slope_hi[i][g] = RayGroup::most_of(s);
    }
}

/// The box around points of the rays, one per ray.
struct PacketPoints {
    GroupFloats lo[3], hi[3];
    HWY_INLINE void include(std::size_t k, const GroupFloats& x, bool first) {
        lo[k] = first ? x : min_lanes(lo[k], x);
        hi[k] = first ? x : max_lanes(hi[k], x);
    }
    HWY_INLINE void summarize(float (&middle)[3], float (&half)[3]) const {
        for (std::size_t k = 0; k < 3; ++k) {
            const float a = RayGroup::least_of(lo[k]), b = RayGroup::most_of(hi[k]);
            middle[k] = 0.5f * a + 0.5f * b;
            half[k] = std::max(middle[k] - a, b - middle[k]);
        }
    }
};

/// Sets P to the middle of the points where the rays begin or end, whichever lie closer together.
/// False if they lie too far apart.
inline bool RayPacket::find_point() {
    const std::uint32_t axes[3] = {kx, ky, kz};
    PacketPoints begins;
    GroupFloats first(0.0f), last(0.0f);
    for (std::size_t g = 0; g < group_count; ++g) {
        const RayGroup& group = groups[g];
        const GroupFloats s_max = load_lanes<kGroupRays>(group.s_max);
        const GroupFloats s_min = load_lanes<kGroupRays>(group.s_min);
        first = g == 0 ? s_min : min_lanes(first, s_min);
        last = g == 0 ? s_max : max_lanes(last, s_max);
        for (std::size_t k = 0; k < 3; ++k) {
            begins.include(k, load_lanes<kGroupRays>(group.origin[axes[k]]), g == 0);
        }
    }
    float begin_half[3], end_half[3], end[3];
    begins.summarize(point, begin_half);
    const auto sum = [](const float(&h)[3]) { return h[0] + h[1] + h[2]; };
    float spread = RayGroup::least_of(first) >= -1e-20f ? sum(begin_half)
                                                        : std::numeric_limits<float>::infinity();
    from_start_ = true;
    const float* half = begin_half;
    float rounding = 0;
    if (RayGroup::most_of(last) < 1e20f) {
        PacketPoints ends;
        for (std::size_t g = 0; g < group_count; ++g) {
            const RayGroup& group = groups[g];
            const GroupFloats s_max = load_lanes<kGroupRays>(group.s_max);
            for (std::size_t k = 0; k < 3; ++k) {
                const GroupFloats o = load_lanes<kGroupRays>(group.origin[axes[k]]);
                const GroupFloats d = load_lanes<kGroupRays>(group.direction[axes[k]]);
                ends.include(k, mul_add(d, s_max, o), g == 0);
            }
        }
        ends.summarize(end, end_half);
        const float far = std::max({std::abs(end[0]) + end_half[0], std::abs(end[1]) + end_half[1],
                                    std::abs(end[2]) + end_half[2]});
        if (far <= 64.0f && sum(end_half) < spread) {
            spread = sum(end_half);
            from_start_ = false;
            half = end_half;
            for (std::size_t k = 0; k < 3; ++k) point[k] = end[k];
            reach_ = std::max(reach_, 1.001f * (1.0f + far));
            rounding = 4.0f * kUnit * (far + reach_);
        }
    }
    for (std::size_t i = 0; i < 2; ++i) away[i] = half[i] + half[2] + 2.0f * rounding;
    return spread <= kFarthest;
}

inline bool RayPacket::find_planes() {
    error = 13.2f * kUnit * reach_ + 4.0f * delta_;
    // Includes the sum that converts a position from the point to the origin.
    s_error = 15.7f * kUnit * reach_ + 4.4f * delta_;
    depth_of_point_ = sign_ * point[2];
    k_slack_ = 2.0f * error + std::max(away[0], away[1]);
    near_row_ = sign_ > 0 ? kz : kz + 3;
    far_row_ = sign_ > 0 ? kz + 3 : kz;
    lateral_row_[0] = kx;
    lateral_row_[1] = ky;
    const float turn = from_start_ ? sign_ : -sign_;
    for (std::size_t i = 0; i < 2; ++i) {
        const float lo = RayGroup::least_of(load_lanes(slope_lo[i]));
        const float hi = RayGroup::most_of(load_lanes(slope_hi[i]));
        if (!(hi - lo <= kWidest)) return false;
        middle[i] = 0.5f * (lo + hi);
        widest = std::max(widest, std::max(hi - middle[i], middle[i] - lo));
        const float a = turn > 0 ? lo : -hi, b = turn > 0 ? hi : -lo;
        lo_up_[i] = std::max(a, 0.0f);
        lo_down_[i] = std::min(a, 0.0f);
        hi_up_[i] = std::max(b, 0.0f);
        hi_down_[i] = std::min(b, 0.0f);
        const float slack = 2.0f * (error + away[i]);
        point_lo_[i] = point[i] - slack;
        point_hi_[i] = point[i] + slack;
    }
    ball_slack_ = 3.0f * error + 2.0f * (away[0] + away[1]);
    Floats squared(0.0f);
    for (std::size_t i = 0; i < 2; ++i) {
        const Floats lo = load_lanes(slope_lo[i]), hi = load_lanes(slope_hi[i]);
        const Floats between = Floats(0.5f) * (lo + hi);
        store_lanes(Floats(turn) * between, group_middle[i]);
        const Floats a = turn > 0 ? lo : -hi, b = turn > 0 ? hi : -lo, zero(0.0f);
        store_lanes(max_lanes(a, zero), group_lo_up_[i]);
        store_lanes(min_lanes(a, zero), group_lo_down_[i]);
        store_lanes(max_lanes(b, zero), group_hi_up_[i]);
        store_lanes(min_lanes(b, zero), group_hi_down_[i]);
        const Floats most = max_lanes(hi - between, between - lo);
        squared = mul_add(most, most, squared);
    }
    store_lanes(sqrt(squared), group_spread);
    k_min_ = std::numeric_limits<float>::infinity();
    for (std::size_t g = 0; g < group_count; ++g) {
        RayGroup& group = groups[g];
        const GroupFloats depth = mul_add(load_lanes<kGroupRays>(group.origin[kz]),
                                          GroupFloats(sign_), GroupFloats(-depth_of_point_));
        store_lanes(depth, group.depth);
        store_lanes(GroupFloats(point[2]) - load_lanes<kGroupRays>(group.origin[kz]), group.shift);
        for (std::size_t i = 0; i < 2; ++i) {
            store_lanes(load_lanes<kGroupRays>(group.slope[i]) - GroupFloats(middle[i]),
                        group.aside[i]);
        }
        const GroupFloats k =
            mul_add(load_lanes<kGroupRays>(group.s_min), load_lanes<kGroupRays>(group.rate), depth);
        group_k_min[g] = RayGroup::least_of(k) - k_slack_;
        k_min_ = std::min(k_min_, group_k_min[g]);
    }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
