#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/wide_bvh_kernels_4.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/width_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

const WideBvhKernels& kernels_4() {
    static constexpr WideBvhKernels kernels = WidthKernels<4>::table();
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(kernels_4);

const WideBvhKernels& wide_bvh_kernels_4() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(kernels_4)();
}

}  // namespace alhazen
#endif
