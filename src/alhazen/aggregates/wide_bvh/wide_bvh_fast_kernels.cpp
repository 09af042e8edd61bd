#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/wide_bvh_fast_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/dispatch-inl.h"
#include "alhazen/aggregates/wide_bvh/fast_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Those of wide_bvh_kernels.cpp, for the same target.
const WideBvhKernels& kernels();

namespace {

void fast_closest(const WideBvhScene& scene, const Ray& ray, Hit& best, TraversalStats* stats) {
    FastClosestQuery query(scene, ray, best);
    run<8>(query, stats);
}

bool fast_occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
    bool result = false;
    FastOccludedQuery query(scene, ray, result);
    return run<8>(query, stats);
}

void fast_closest_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                        TraversalStats* stats) {
    run_batch<FastClosestQuery, 8>(scene, rays, best, stats);
}

void fast_occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                         std::span<bool> occluded, TraversalStats* stats) {
    run_batch<FastOccludedQuery, 8>(scene, rays, occluded, stats);
}

}  // namespace

const WideBvhKernels& fast_kernels() {
    static const WideBvhKernels table = [] {
        WideBvhKernels fast = kernels();
        fast.closest = &fast_closest;
        fast.occluded = &fast_occluded;
        fast.closest_batch = &fast_closest_batch;
        fast.occluded_batch = &fast_occluded_batch;
        // Packets decide in double: the hint must not change a hit.
        fast.closest_coherent = &fast_closest_batch;
        return fast;
    }();
    return table;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(fast_kernels);

const WideBvhKernels& wide_bvh_fast_kernels() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(fast_kernels)();
}

}  // namespace alhazen
#endif
