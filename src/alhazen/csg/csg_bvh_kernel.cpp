#include "alhazen/csg/csg_bvh.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/csg/csg_bvh_kernel.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

HWY_INLINE Doubles as_doubles(const float* values) {
    const LaneTag<double> d;
    const hn::Rebind<float, LaneTag<double>> df;
    Doubles r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<double>; ++i) {
        r.part[i] = hn::PromoteTo(d, hn::LoadU(df, values + i * hn::Lanes(d)));
    }
    return r;
}

/// Every operation is correctly rounded; none is fused.
std::uint32_t ranges(const CsgBvh::Node& node, const CsgBvh::RaySlabs& ray,
                     CsgBvh::Ranges& ranges) {
    static_assert(CsgBvh::kWidth == kLaneCount);
    Doubles enter(-std::numeric_limits<double>::infinity());
    Doubles exit(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < 3; ++k) {
        const Doubles near = as_doubles(ray.negative[k] ? node.hi[k] : node.lo[k]);
        const Doubles far = as_doubles(ray.negative[k] ? node.lo[k] : node.hi[k]);
        const Doubles inverse(ray.inverse[k]);
        enter = max_lanes(enter, (near - Doubles(ray.near_origin[k])) * inverse);
        exit = min_lanes(exit, (far - Doubles(ray.far_origin[k])) * inverse);
    }
    store_lanes(enter, ranges.enter);
    store_lanes(exit, ranges.exit);
    return bits_of(enter <= exit);
}

}  // namespace

CsgBvh::RangesKernel ranges_kernel() {
    return &ranges;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(ranges_kernel);

CsgBvh::RangesKernel csg_ranges_kernel() {
    return ALHAZEN_KERNEL(ranges_kernel)();
}

}  // namespace alhazen
#endif
