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

/// Sets the ray's rows of planes. `slack`: of the slab test, for a direction of length 1, in every
/// lane.
HWY_INLINE void make_slab_ray(const AxisLanes& axes, const AxisLanes::F& slack, SlabRay& slabs) {
    using F = AxisLanes::F;
    // The length is at least 2^-40, so its bound is independent of this one of the components.
    const F steep = copysign(larger_by_bits(abs(axes.direction), F(0x1p-100f)), axes.direction);
    const F reciprocal = F(1.0f) / steep;
    const F c = -(axes.origin * reciprocal);
    const F aside = slack * abs(reciprocal);
    store_lanes(reciprocal, slabs.reciprocal);
    store_lanes(c - aside, slabs.near_offset);
    store_lanes(c + aside, slabs.far_offset);
    slabs.near = kNearRows[bits_of(steep < F(0.0f)) & 7];
}

/// Sets `axes` without a shift, and `slabs`. False if the ray is invalid, far from the scene or of
/// an unusual length. `bound`: as in `make_ray`.
HWY_INLINE bool make_ray_nearby(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                                SlabRay& slabs, AxisLanes& axes) {
    using D = Lanes<double, 4>;
    using F = AxisLanes::F;
    static_assert(offsetof(Ray, direction) == 24 && offsetof(LocalFrame, scale) == 24);
    const D origin =
        (load_unaligned<4>(&ray.origin.x) - load_unaligned<4>(&frame.center.x)) * D(frame.scale);
    axes.origin = as_floats(origin);
    axes.direction = as_floats(load_unaligned<4>(&ray.direction.x));
    const Floats sizes = joined(first_three(abs(axes.direction)), first_three(abs(axes.origin)));
    const Floats largest = largest_of_fours(sizes);  // of the direction, and of the origin
    // Written so that NaN fails.
    HWY_ALIGN static constexpr float kUsual[8] = {0x1p40f, 0x1p40f, 0x1p40f, 0x1p40f,
                                                  8.0f,    8.0f,    8.0f,    8.0f};
    if (bits_of(sizes <= load_lanes(kUsual)) != kAllLanes ||
        !(first_lane(largest) >= frame.slack.least_length) || !(ray.t_min <= ray.t_max) ||
        !(ray.t_min >= 0.0)) {
        return false;
    }
    axes.main_axis =
        static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits_of(sizes >= largest)));
    const F distance = upper_half(largest);
    axes.delta = frame.slack.delta.at(first_lane(distance));
    axes.reach = frame.slack.reach.at(first_lane(distance));
    axes.regular = true;
    axes.parameter = {frame.scale, 0.0};
    make_slab_ray(axes, mul_add(distance, F(bound.slope), F(bound.constant)), slabs);
    // The scale is a power of two, so only the rounding to float counts. The ends are finite in
    // float, beyond every scene, and not negative.
    using D2 = Lanes<double, 2>;
    using F2 = Lanes<float, 2>;
    static_assert(offsetof(Ray, t_max) == offsetof(Ray, t_min) + sizeof(double));
    static_assert(offsetof(SlabRay, s_max) == offsetof(SlabRay, s_min) + sizeof(float));
    HWY_ALIGN static constexpr float kWider[4] = {1.0f - 0x1p-22f, 1.0f + 0x1p-22f};
    HWY_ALIGN static constexpr float kNarrower[4] = {1.0f + 0x1p-22f, 1.0f - 0x1p-22f};
    HWY_ALIGN static constexpr float kStep[4] = {0x1p-100f, -0x1p-100f};
    const F2 range =
        min_lanes(as_floats(load_unaligned<2>(&ray.t_min) * D2(frame.scale)), F2(1e37f));
    const F2 step = load_lanes<2>(kStep);
    // Two members, addressed relative to the whole object.
    float* const ends = reinterpret_cast<float*>(&slabs) + offsetof(SlabRay, s_min) / sizeof(float);
    store_lanes(max_lanes(mul_sub(range, load_lanes<2>(kWider), step), F2(0.0f)), ends);
    axes.sure = mul_add(range, load_lanes<2>(kNarrower), step);
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
    make_slab_ray(axes, AxisLanes::F(slack), slabs);
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
