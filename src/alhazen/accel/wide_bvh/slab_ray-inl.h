/// Makes the rays of the slab test: see slab_ray.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The axes are in lanes.

#if defined(ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#undef ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#else
#define ALHAZEN_WIDE_BVH_SLAB_RAY_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

#include "alhazen/accel/wide_bvh/slab_ray.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A ray with its axes in lanes.
struct AxisLanes {
    using F = Lanes<float, 4>;
    F origin, direction;
    F length;  ///< the largest component of the direction, in every lane
};

/// The ray as it stands where that is valid, near the scene and of a usual length; else false.
HWY_INLINE bool local_ray_nearby(const LocalFrame& frame, const Ray& ray, double t_max,
                                 LocalRay& local, AxisLanes& axes) {
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
    // Written so that a NaN is not near.
    const std::uint32_t usual = bits_of((away <= F(8.0f)) & (across <= F(0x1p40f)));
    const float length = first_lane(axes.length);
    if (usual != 15 || !(length >= 0x1p-40f) || !(ray.t_min <= t_max)) return false;
    const float distance = first_lane(largest_of(away));
    local.main_axis = static_cast<std::uint32_t>(std::countr_zero(bits_of(across >= axes.length)));
    const double scale = frame.scale;
    if (!(scale >= 0x1p-200 && scale <= 0x1p200)) return false;
    store_lanes(axes.origin, local.origin);
    store_lanes(axes.direction, local.direction);
    local.delta =
        static_cast<float>(kExactTestSlack) * (distance + 1.01f + static_cast<float>(frame.offset));
    local.reach = distance + 1.0001f + 2.0f * local.delta;
    local.valid = local.regular = true;
    local.parameter = {scale, 0.0};
    constexpr double kEnd = 1e37;  // finite in float, beyond every scene
    // The scale is a power of two: only the rounding to float counts.
    const double first = std::min(std::max(ray.t_min * scale, -kEnd), kEnd);
    const double last = std::min(std::max(t_max * scale, -kEnd), kEnd);
    const double first_step = std::abs(first) * 0x1p-23 + 0x1p-100;
    const double last_step = std::abs(last) * 0x1p-23 + 0x1p-100;
    local.s_min = static_cast<float>(first - first_step);
    local.sure_min = static_cast<float>(first + first_step);
    local.sure_max = static_cast<float>(last - last_step);
    local.s_max = static_cast<float>(last + last_step);
    return true;
}

/// `t_max` counts in place of the ray's own. `local` is for the tests of leaves; where it is not
/// valid, `slabs` is not made.
HWY_INLINE void make_slab_ray(const LocalFrame& frame, const Ray& ray, double t_max, SlabRay& slabs,
                              LocalRay& local) {
    using F = AxisLanes::F;
    AxisLanes axes;
    if (HWY_UNLIKELY(!local_ray_nearby(frame, ray, t_max, local, axes))) {
        local = local_ray_from_afar(frame, ray, t_max);
        if (!local.valid) return;
        if (!local.regular) return pass_everything(slabs);
        axes.origin = load_lanes<4>(local.origin);
        axes.direction = load_lanes<4>(local.direction);
        axes.length = largest_of(abs(axes.direction));
    }
    const F steep =
        copysign(max_lanes(abs(axes.direction), axes.length * F(0x1p-60f)), axes.direction);
    const F reciprocal = F(1.0f) / steep;
    const F c = -(axes.origin * reciprocal);
    const F slack = F(6.5f * 0x1p-24f * local.reach + 1.001f * local.delta) * abs(reciprocal);
    store_lanes(reciprocal, slabs.reciprocal);
    store_lanes(c - slack, slabs.near_offset);
    store_lanes(c + slack, slabs.far_offset);
    slabs.s_min = local.s_min;
    slabs.s_max = local.s_max;
    slabs.near = kNearRows[bits_of(steep < F(0.0f)) & 7];
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
