/// Eight rays side by side in lanes: a part of a packet.
///
/// Source: packet-inl.h.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_RAY_GROUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_RAY_GROUP_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_RAY_GROUP_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_RAY_GROUP_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <span>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Number of rays of a packet, and of a group, whose rays are in the lanes of one vector.
inline constexpr std::size_t kPacketRays = 64;
inline constexpr std::size_t kGroupRays = kRayLanes;
inline constexpr std::size_t kPacketGroups = kPacketRays / kGroupRays;
using GroupFloats = Lanes<float, kGroupRays>;
using GroupRow = float[kGroupRays];

/// Eight rays in the local frame. Unused lanes repeat another ray and end before they begin.
struct alignas(64) RayGroup {
    GroupRow origin[3], direction[3];  ///< [axis]: first those of the scene, then as in
                                       ///< TriangleFilterRay
    GroupRow s_min, s_max;             ///< as in SlabRay
    GroupRow sure_min, sure_max;       ///< as in TriangleFilterRay
    GroupRow slope[2], reciprocal;     ///< TriangleFilterRay::sx, sy, sz
    GroupRow aside[2];                 ///< slopes relative to the middle one of the packet
    GroupRow shift;                    ///< from the origin to the point of the packet, along z
    GroupRow depth, rate;              ///< k at s = 0, and its increase per unit of s
    std::uint32_t used;

    /// The largest k of the group plus `slack`.
    [[nodiscard]] HWY_INLINE float deepest(float slack) const {
        const GroupFloats k = mul_add(load_lanes<kGroupRays>(s_max), load_lanes<kGroupRays>(rate),
                                      load_lanes<kGroupRays>(depth));
        // Finite, so that free slots fail.
        return most_of(min_lanes(k, GroupFloats(1e30f))) + slack;
    }
    static HWY_INLINE float most_of(const GroupFloats& a) { return -least_of(-a); }
    static HWY_INLINE float least_of(const GroupFloats& a) {
        const LaneTag<float, kGroupRays> d;
        auto least = a.part[0];
        for (std::size_t i = 1; i < kParts<float, kGroupRays>; ++i) {
            least = hn::Min(least, a.part[i]);
        }
        return hn::GetLane(hn::MinOfLanes(d, least));
    }
};

/// Transposes eight rays.
HWY_INLINE void take_lanes(std::span<const Ray, kRayLanes> rays, RayLanes& lanes) {
#if HWY_TARGET != HWY_SCALAR
    const LaneTag<double> d;
    if constexpr (hn::MaxLanes(LaneTag<double>()) == 4) {
        // A ray is two rows of four numbers; the numbers of a component are eight apart in `lanes`.
        static_assert(offsetof(Ray, direction) == 3 * sizeof(double) &&
                      offsetof(Ray, t_min) == 6 * sizeof(double));
        static_assert(offsetof(RayLanes, origin) == 0 &&
                      offsetof(RayLanes, direction) == 3 * kRayLanes * sizeof(double) &&
                      offsetof(RayLanes, t_min) == 6 * kRayLanes * sizeof(double));
        double* const numbers = reinterpret_cast<double*>(&lanes);
        for (std::size_t i = 0; i < kRayLanes; i += 4) {
            HWY_UNROLL(2)
            for (std::size_t half = 0; half < 2; ++half) {
                const auto row = [&](std::size_t k) HWY_ATTR {
                    return hn::Load(d, &rays[i + k].origin.x + 4 * half);
                };
                const auto r0 = row(0), r1 = row(1), r2 = row(2), r3 = row(3);
                const auto even0 = hn::InterleaveLower(d, r0, r1);
                const auto even2 = hn::InterleaveLower(d, r2, r3);
                const auto odd0 = hn::InterleaveUpper(d, r0, r1);
                const auto odd2 = hn::InterleaveUpper(d, r2, r3);
                double* const to = numbers + 4 * half * kRayLanes + i;
                hn::Store(hn::ConcatLowerLower(d, even2, even0), d, to);
                hn::Store(hn::ConcatLowerLower(d, odd2, odd0), d, to + kRayLanes);
                hn::Store(hn::ConcatUpperUpper(d, even2, even0), d, to + 2 * kRayLanes);
                hn::Store(hn::ConcatUpperUpper(d, odd2, odd0), d, to + 3 * kRayLanes);
            }
        }
        return;
    }
#endif
    for (std::size_t i = 0; i < kRayLanes; ++i) lanes.set(i, rays[i]);
}

/// Converts eight rays to the local frame, as `make_ray_nearby`; returns the bits of those that it
/// accepts.
HWY_INLINE std::uint32_t load_rays(const LocalFrame& frame, const RayLanes& rays, RayGroup& group) {
    using D = Doubles;
    using F = Floats;
    const D scale(frame.scale);
    const double center[3] = {frame.center.x, frame.center.y, frame.center.z};
    F away(0.0f), across(0.0f);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const F o = as_floats((load_lanes(rays.origin[k]) - D(center[k])) * scale);
        const F d = as_floats(load_lanes(rays.direction[k]));
        // In this order a NaN propagates on every target.
        away = away + abs(o);
        across = across + abs(d);
        store_lanes(o, group.origin[k]);
        store_lanes(d, group.direction[k]);
    }
    const D t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const D begin = min_lanes(max_lanes(t_min * scale, D(-1e37)), D(1e37));
    const D end = min_lanes(max_lanes(t_max * scale, D(-1e37)), D(1e37));
    const D begin_step = abs(begin) * D(0x1p-23) + D(0x1p-100);
    const D end_step = abs(end) * D(0x1p-23) + D(0x1p-100);
    store_lanes(as_floats(begin - begin_step), group.s_min);
    store_lanes(as_floats(begin + begin_step), group.sure_min);
    store_lanes(as_floats(end - end_step), group.sure_max);
    store_lanes(as_floats(end + end_step), group.s_max);
    // A sum of three is at most three times the largest.
    return bits_of((away <= F(8.0f)) & (across <= F(0x1p40f)) &
                   (across >= F(3.0f * frame.slack.least_length))) &
           bits_of((t_min <= t_max) & (t_min >= D(0.0)));
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
