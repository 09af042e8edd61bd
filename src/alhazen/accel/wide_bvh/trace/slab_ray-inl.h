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

/// A ray with its axes in lanes.
struct AxisLanes {
    using F = Lanes<float, 4>;
    F origin, direction;
    F length, distance;  ///< the largest component of direction and origin, in every lane
};

/// Sets `local` and `axes` without a shift. False if the ray is invalid, far from the scene or of
/// an unusual length.
HWY_INLINE bool local_ray_nearby(const LocalFrame& frame, const Ray& ray, LocalRay& local,
                                 AxisLanes& axes) {
    using D = Lanes<double, 4>;
    using F = AxisLanes::F;
    static_assert(offsetof(Ray, direction) == 24 && offsetof(LocalFrame, scale) == 24);
    const D origin =
        (load_unaligned<4>(&ray.origin.x) - load_unaligned<4>(&frame.center.x)) * D(frame.scale);
    axes.origin = first_three(as_floats(origin));
    axes.direction = first_three(as_floats(load_unaligned<4>(&ray.direction.x)));
    const F across = abs(axes.direction);
    const F away = abs(axes.origin);
    axes.length = largest_of(across);
    axes.distance = largest_of(away);
    // Written so that NaN fails.
    const std::uint32_t usual = bits_of((away <= F(8.0f)) & (across <= F(0x1p40f)));
    if (usual != 15 || !(first_lane(axes.length) >= frame.slack.least_length) ||
        !(ray.t_min <= ray.t_max) || !(ray.t_min >= 0.0)) {
        return false;
    }
    local.main_axis = static_cast<std::uint32_t>(std::countr_zero(bits_of(across >= axes.length)));
    store_lanes(axes.origin, local.origin);
    store_lanes(axes.direction, local.direction);
    local.delta = frame.slack.delta.at(first_lane(axes.distance));
    local.reach = frame.slack.reach.at(first_lane(axes.distance));
    local.valid = local.regular = true;
    local.parameter = {frame.scale, 0.0};
    // The scale is a power of two, so only the rounding to float counts. The ends are finite in
    // float, beyond every scene, and not negative.
    using D2 = Lanes<double, 2>;
    using F2 = Lanes<float, 2>;
    static_assert(offsetof(Ray, t_max) == offsetof(Ray, t_min) + sizeof(double));
    const F2 range =
        min_lanes(as_floats(load_unaligned<2>(&ray.t_min) * D2(frame.scale)), F2(1e37f));
    store_lanes(mul_sub(range, F2(1.0f - 0x1p-22f), F2(0x1p-100f)), local.below);
    store_lanes(mul_add(range, F2(1.0f + 0x1p-22f), F2(0x1p-100f)), local.above);
    return true;
}

/// `slack`: of the slab test, for a direction of length 1, in every lane.
HWY_INLINE void make_slab_ray(const AxisLanes& axes, const AxisLanes::F& slack,
                              const LocalRay& local, SlabRay& slabs) {
    using F = AxisLanes::F;
    // The length is at least 2^-40, so its bound is independent of this one of the components.
    const F steep = copysign(larger_by_bits(abs(axes.direction), F(0x1p-100f)), axes.direction);
    const F reciprocal = F(1.0f) / steep;
    const F c = -(axes.origin * reciprocal);
    const F aside = slack * abs(reciprocal);
    store_lanes(reciprocal, slabs.reciprocal);
    store_lanes(c - aside, slabs.near_offset);
    store_lanes(c + aside, slabs.far_offset);
    slabs.s_min = std::max(local.below[0], 0.0f);
    slabs.s_max = local.above[1];
    slabs.near = kNearRows[bits_of(steep < F(0.0f)) & 7];
}

/// As `make_ray`, for the rays that local_ray_nearby rejects.
HWY_NOINLINE inline void make_ray_from_afar(const LocalFrame& frame, const Ray& ray, SlabRay& slabs,
                                            LocalRay& local) {
    local = local_ray_from_afar(frame, ray);
    if (!local.valid) return;
    if (!local.regular) return pass_everything(slabs);
    AxisLanes axes;
    axes.origin = load_lanes<4>(local.origin);
    axes.direction = load_lanes<4>(local.direction);
    axes.length = largest_of(abs(axes.direction));
    const float slack = 6.5f * 0x1p-24f * local.reach + 1.001f * local.delta;
    make_slab_ray(axes, AxisLanes::F(slack), local, slabs);
}

/// Prepares a ray for nodes, then calls `then(local)` to prepare it for leaves. Returns false,
/// without the call, for an invalid ray. `bound`: the slack of the slab test, frame.slack.slab for
/// exact results.
template <class Then>
HWY_INLINE bool make_ray(const LocalFrame& frame, const DistanceBound& bound, const Ray& ray,
                         SlabRay& slabs, Then&& then) {
    {
        LocalRay local;
        AxisLanes axes;
        if (HWY_LIKELY(local_ray_nearby(frame, ray, local, axes))) {
            using F = AxisLanes::F;
            make_slab_ray(axes, mul_add(axes.distance, F(bound.slope), F(bound.constant)), local,
                          slabs);
            then(local);
            return true;
        }
    }
    LocalRay local;
    make_ray_from_afar(frame, ray, slabs, local);
    if (local.valid) then(local);
    return local.valid;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
