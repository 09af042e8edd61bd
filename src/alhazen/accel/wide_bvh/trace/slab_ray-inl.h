/// Prepares rays for the slab test: see slab_ray.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The axes are in lanes.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_SLAB_RAY_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

#include "alhazen/accel/wide_bvh/trace/slab_ray.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A ray in the local frame, in registers, from which the float tests of nodes and leaves are
/// prepared.
struct AxisLanes {
    using F = Lanes<float, 4>;
    F origin, direction;      ///< [axis]; origin after the shift; the fourth is arbitrary
    float reach, delta;       ///< as in FrameSlack
    Lanes<float, 2> sure;     ///< the beginning of the ray's range rounded up, the end rounded down
    std::uint32_t main_axis;  ///< index of the largest component of the direction
    bool regular;             ///< as in LocalRay
    LocalParameter parameter;
};

/// What the slab test needs of a ray, in registers.
struct SlabLanes {
    AxisLanes::F reciprocal, near_offset, far_offset;
    Lanes<float, 2> range;  ///< s_min, s_max
    NearRows near;
};

HWY_INLINE void store_slab_ray(const SlabLanes& lanes, SlabRay& slabs) {
    static_assert(offsetof(SlabRay, s_max) == offsetof(SlabRay, s_min) + sizeof(float));
    store_lanes(lanes.reciprocal, slabs.reciprocal);
    store_lanes(lanes.near_offset, slabs.near_offset);
    store_lanes(lanes.far_offset, slabs.far_offset);
    // Two members, addressed relative to the whole object.
    store_lanes(lanes.range,
                reinterpret_cast<float*>(&slabs) + offsetof(SlabRay, s_min) / sizeof(float));
    slabs.near = lanes.near;
}

/// Lane `kLane` of three in every lane.
template <std::size_t kLane, std::size_t N>
HWY_INLINE Lanes<float, N> spread(const AxisLanes::F& a) {
#if HWY_TARGET == HWY_SCALAR
    return Lanes<float, N>(hn::GetLane(a.part[kLane]));
#else
    return Lanes<float, N>(hn::GetLane(hn::Broadcast<static_cast<int>(kLane)>(a.part[0])));
#endif
}

/// Sets the ray's rows of planes. `slack`: of the slab test, for a direction of length 1, in every
/// lane.
HWY_INLINE void make_slab_rows(const AxisLanes::F& origin, const AxisLanes::F& direction,
                               const AxisLanes::F& slack, SlabLanes& slabs) {
    using F = AxisLanes::F;
    // The length is at least 2^-40, so its bound is independent of this one of the components.
    const F steep = copysign(larger_by_bits(abs(direction), F(0x1p-100f)), direction);
    slabs.reciprocal = F(1.0f) / steep;
    const F c = -(origin * slabs.reciprocal);
    const F aside = slack * abs(slabs.reciprocal);
    slabs.near_offset = c - aside;
    slabs.far_offset = c + aside;
    slabs.near = kNearRows[bits_of(steep < F(0.0f)) & 7];
}

/// A ray in the local frame, without a shift, of which the slab test has been prepared.
struct NearbyRay {
    AxisLanes::F origin, direction;    ///< as in AxisLanes
    AxisLanes::F size, length, reach;  ///< magnitudes of the direction; its largest; the origin's
};

/// The largest of the first three lanes in each of them; 0 in the fourth. Precondition: they are
/// not negative; a NaN is greater than any number.
HWY_INLINE AxisLanes::F largest_of_three(const AxisLanes::F& a) {
    HWY_ALIGN static constexpr std::int32_t kNext[4] = {1, 2, 0, 3}, kLast[4] = {2, 0, 1, 3};
    return larger_by_bits(larger_by_bits(a, permuted(a, kNext)), permuted(a, kLast));
}

/// The range of a ray in local parameters, rounded to the nearest.
HWY_INLINE Lanes<float, 2> nearby_range(const LocalFrame& frame, const Ray& ray) {
    using D2 = Lanes<double, 2>;
    static_assert(offsetof(Ray, t_max) == offsetof(Ray, t_min) + sizeof(double));
    // The scale is a power of two, so only the rounding to float counts. The ends are finite in
    // float, beyond every scene, and not negative.
    return min_lanes(as_floats(load_unaligned<2>(&ray.t_min) * D2(frame.scale)),
                     Lanes<float, 2>(1e37f));
}
HWY_ALIGN inline constexpr float kRangeStep[4] = {0x1p-100f, -0x1p-100f};

/// The first part of `make_ray_nearby`. False as there.
HWY_INLINE bool start_nearby(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                             SlabLanes& slabs, NearbyRay& nearby) {
    using D = Lanes<double, 4>;
    using F = AxisLanes::F;
    static_assert(offsetof(Ray, direction) == 24 && offsetof(LocalFrame, scale) == 24);
    const D origin =
        (load_unaligned<4>(&ray.origin.x) - load_unaligned<4>(&frame.center.x)) * D(frame.scale);
    nearby.origin = as_floats(origin);
    nearby.direction = as_floats(load_unaligned<4>(&ray.direction.x));
    nearby.size = first_three(abs(nearby.direction));
    nearby.length = largest_of_three(nearby.size);
    nearby.reach = largest_of_three(first_three(abs(nearby.origin)));
    // Written so that NaN fails.
    const float length = first_lane(nearby.length);
    if (!(first_lane(nearby.reach) <= 8.0f) || !(length <= 0x1p40f) ||
        !(length >= frame.slack.least_length) || !(ray.t_min <= ray.t_max) || !(ray.t_min >= 0.0)) {
        return false;
    }
    make_slab_rows(nearby.origin, nearby.direction,
                   mul_add(nearby.reach, F(bound.slope), F(bound.constant)), slabs);
    HWY_ALIGN static constexpr float kWider[4] = {1.0f - 0x1p-22f, 1.0f + 0x1p-22f};
    using F2 = Lanes<float, 2>;
    slabs.range = max_lanes(
        mul_sub(nearby_range(frame, ray), load_lanes<2>(kWider), load_lanes<2>(kRangeStep)),
        F2(0.0f));
    return true;
}

/// The second part of `make_ray_nearby`.
HWY_INLINE void finish_nearby(const LocalFrame& frame, const Ray& ray, const NearbyRay& nearby,
                              AxisLanes& axes) {
    axes.origin = nearby.origin;
    axes.direction = nearby.direction;
    axes.main_axis = static_cast<std::uint32_t>(
        hwy::Num0BitsBelowLS1Bit_Nonzero32(bits_of(nearby.size >= nearby.length)));
    const float distance = first_lane(nearby.reach);
    axes.delta = frame.slack.delta.at(distance);
    axes.reach = frame.slack.reach.at(distance);
    axes.regular = true;
    axes.parameter = {frame.scale, 0.0};
    HWY_ALIGN static constexpr float kNarrower[4] = {1.0f + 0x1p-22f, 1.0f - 0x1p-22f};
    axes.sure =
        mul_add(nearby_range(frame, ray), load_lanes<2>(kNarrower), load_lanes<2>(kRangeStep));
}

/// Sets `axes` without a shift, and `slabs`. False if the ray is invalid, far from the scene or of
/// an unusual length. `bound`: as in `make_ray`.
HWY_INLINE bool make_ray_nearby(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                                SlabRay& slabs, AxisLanes& axes) {
    SlabLanes lanes;
    NearbyRay nearby;
    if (!start_nearby(frame, bound, ray, lanes, nearby)) return false;
    store_slab_ray(lanes, slabs);
    finish_nearby(frame, ray, nearby, axes);
    return true;
}

/// As `make_ray`, for the rays that make_ray_nearby rejects.
HWY_NOINLINE inline bool make_ray_from_afar(const LocalFrame& frame, const Ray& ray, SlabRay& slabs,
                                            AxisLanes& axes) {
    const LocalRay local = local_ray_from_afar(frame, ray);
    if (!local.valid) return false;
    axes.origin = load_lanes<4>(local.origin);
    axes.direction = load_lanes<4>(local.direction);
    axes.reach = local.reach;
    axes.delta = local.delta;
    HWY_ALIGN const float sure[2] = {local.above[0], local.below[1]};
    axes.sure = load_lanes<2>(sure);
    axes.main_axis = local.main_axis;
    axes.regular = local.regular;
    axes.parameter = local.parameter;
    if (!local.regular) {
        pass_everything(slabs);
        return true;
    }
    const float slack = 6.5f * 0x1p-24f * local.reach + 1.001f * local.delta;
    SlabLanes lanes;
    make_slab_rows(axes.origin, axes.direction, AxisLanes::F(slack), lanes);
    lanes.range = Lanes<float, 2>(0.0f);
    store_slab_ray(lanes, slabs);
    slabs.s_min = std::max(0.0f, local.below[0]);  // in this order -0 becomes 0
    slabs.s_max = local.above[1];
    return true;
}

/// Prepares a ray for nodes, then calls `then(axes)` to prepare it for leaves. Returns false,
/// without the call, for an invalid ray. `bound`: the slack of the slab test, frame.slack.slab for
/// exact results.
template <class Then>
HWY_INLINE bool make_ray(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                         SlabRay& slabs, Then&& then) {
    {
        AxisLanes axes;
        if (HWY_LIKELY(make_ray_nearby(frame, bound, ray, slabs, axes))) {
            then(axes);
            return true;
        }
    }
    AxisLanes axes;
    if (!make_ray_from_afar(frame, ray, slabs, axes)) return false;
    then(axes);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
