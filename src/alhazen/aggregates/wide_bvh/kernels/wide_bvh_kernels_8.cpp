// Kernels for nodes of 8 children, with triangles in double and in single precision, without
// counting.
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/kernels/wide_bvh_kernels_8.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/kernels/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

const WideBvhKernels& wide_bvh_kernels_8() {
    static constexpr WideBvhKernels kernels = Kernels<8, FilteredTriangleTest, NoStats>::table();
    return kernels;
}
const WideBvhKernels& wide_bvh_kernels_fast() {
    static constexpr WideBvhKernels kernels = Kernels<8, FloatTriangleTest, NoStats>::table();
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_8);

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_fast);

const WideBvhKernels& wide_bvh_kernels_8() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_8)();
}

const WideBvhKernels& wide_bvh_kernels_fast() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_fast)();
}

}  // namespace alhazen
#endif
