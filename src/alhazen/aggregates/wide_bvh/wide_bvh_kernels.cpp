#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/wide_bvh_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/coherent_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/width_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

using Kernels = WidthKernels<8>;

/// Rays that are in no packet go one by one: what neighbours do is predicted well, and a ray begins
/// before the one before it has ended. The stream is 10 to 30 % slower on them.
void closest_coherent(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                      TraversalStats* stats) {
    with_policy(stats, [&](auto policy) HWY_ATTR {
        run_coherent(scene, rays, best, policy, [&](std::size_t first, std::size_t count) {
            for (std::size_t i = first; i < first + count; ++i) {
                Kernels::closest(scene, rays[i], best[i], stats);
            }
        });
    });
}

}  // namespace

const WideBvhKernels& kernels() {
    static constexpr WideBvhKernels kernels = [] {
        WideBvhKernels table = Kernels::table();
        table.closest_coherent = &closest_coherent;
        return table;
    }();
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(kernels);

const WideBvhKernels& wide_bvh_kernels(std::uint32_t width) {
    if (width == 4) return wide_bvh_kernels_4();
    if (width == 16) return wide_bvh_kernels_16();
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace alhazen
#endif
