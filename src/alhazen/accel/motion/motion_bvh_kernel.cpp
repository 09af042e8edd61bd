#include "alhazen/accel/motion/motion_bvh.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/accel/motion/motion_bvh_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Doubles doubles_at(const float* open, const float* close, const Doubles& at_open,
                              const Doubles& at_close) {
    const LaneTag<double> d;
    const hn::Rebind<float, LaneTag<double>> df;
    Doubles r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<double>; ++i) {
        const auto a = hn::PromoteTo(d, hn::LoadU(df, open + i * hn::Lanes(d)));
        const auto b = hn::PromoteTo(d, hn::LoadU(df, close + i * hn::Lanes(d)));
        r.part[i] = hn::Add(hn::Mul(at_open.part[i], a), hn::Mul(at_close.part[i], b));
    }
    return r;
}

/// Every operation is correctly rounded, none is fused.
std::uint32_t met_children(const MotionBvh::Node& node, const MotionBvh::RaySlabs& ray,
                           double t_min, double t_max, MotionBvh::Entries& entries) {
    static_assert(MotionBvh::kWidth == kLaneCount);
    const Doubles at_open(1.0 - ray.time), at_close(ray.time);
    Doubles enter(t_min), exit(t_max);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto& near_rows = ray.negative[k] ? node.hi : node.lo;
        const auto& far_rows = ray.negative[k] ? node.lo : node.hi;
        const Doubles near = doubles_at(near_rows[0][k], near_rows[1][k], at_open, at_close);
        const Doubles far = doubles_at(far_rows[0][k], far_rows[1][k], at_open, at_close);
        const Doubles inverse(ray.inverse[k]);
        enter = max_lanes(enter, (near - Doubles(ray.near_origin[k])) * inverse);
        exit = min_lanes(exit, (far - Doubles(ray.far_origin[k])) * inverse);
    }
    store_lanes(enter, entries.enter);
    return bits_of(enter <= exit);
}

}  // namespace

MotionBvh::Kernel met_children_kernel() {
    return &met_children;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(met_children_kernel);

MotionBvh::Kernel motion_bvh_kernel() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(met_children_kernel)();
}

}  // namespace alhazen
#endif
