// Kernels for nodes of 4 and 16 children, for comparison with nodes of 8, without counting.
#include "alhazen/aggregates/wide_bvh/kernels/comparison_targets.h"
// Included after it.
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/kernels/wide_bvh_kernels_widths.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/kernels/kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <std::size_t W>
const WideBvhKernels& kernels_of_width() {
    static constexpr WideBvhKernels kernels = Kernels<W, FilteredTriangleTest, NoStats>::table();
    return kernels;
}

const WideBvhKernels& wide_bvh_kernels_4() {
    return kernels_of_width<4>();
}
const WideBvhKernels& wide_bvh_kernels_16() {
    return kernels_of_width<16>();
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_4);

ALHAZEN_KERNEL_TABLE(wide_bvh_kernels_16);

const WideBvhKernels& wide_bvh_kernels_4() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_4)();
}

const WideBvhKernels& wide_bvh_kernels_16() {
    return ALHAZEN_KERNEL(wide_bvh_kernels_16)();
}

}  // namespace alhazen
#endif
