// Kernels for nodes of 4, 8 and 16 children, counting.
#include "alhazen/aggregates/wide_bvh/kernels/comparison_targets.h"
// Included after it.
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/kernels/wide_bvh_kernels_counting.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/kernels/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <std::size_t W, class TriangleTest>
const WideBvhKernels& counting_kernels() {
    static constexpr WideBvhKernels kernels = Kernels<W, TriangleTest, CountingStats>::table();
    return kernels;
}

const WideBvhKernels& wide_bvh_kernels_4_counting() {
    return counting_kernels<4, FilteredTriangleTest>();
}
const WideBvhKernels& wide_bvh_kernels_8_counting() {
    return counting_kernels<8, FilteredTriangleTest>();
}
const WideBvhKernels& wide_bvh_kernels_16_counting() {
    return counting_kernels<16, FilteredTriangleTest>();
}
const WideBvhKernels& wide_bvh_kernels_fast_counting() {
    return counting_kernels<8, FloatTriangleTest>();
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_4_counting);

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_8_counting);

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_16_counting);

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_fast_counting);

const WideBvhKernels& wide_bvh_kernels_4_counting() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_4_counting)();
}

const WideBvhKernels& wide_bvh_kernels_8_counting() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_8_counting)();
}

const WideBvhKernels& wide_bvh_kernels_16_counting() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_16_counting)();
}

const WideBvhKernels& wide_bvh_kernels_fast_counting() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_fast_counting)();
}

}  // namespace alhazen
#endif
