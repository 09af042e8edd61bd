#include "alhazen/scene/wide_bvh_kernels.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/scene/wide_bvh_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/scene/coherent_queries-inl.h"
#include "alhazen/scene/leaf_queries-inl.h"
#include "alhazen/scene/run_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

void closest(const WideBvhScene& scene, const Ray& ray, Hit& best, TraversalStats* stats) {
    ClosestQuery query(scene, ray, best);
    run(query, stats);
}

bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
    bool result = false;
    OccludedQuery query(scene, ray, result);
    return run(query, stats);
}

template <bool kStopAtOpaque>
bool collect(const WideBvhScene& scene, const Ray& ray, std::vector<Hit>& hits,
             TraversalStats* stats) {
    CollectQuery<kStopAtOpaque> query(scene, ray, hits);
    return run(query, stats);
}

void closest_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                   TraversalStats* stats) {
    run_batch<ClosestQuery>(scene, rays, best, stats);
}

void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<bool> occluded,
                    TraversalStats* stats) {
    run_batch<OccludedQuery>(scene, rays, occluded, stats);
}

// ---- coherent rays

void closest_coherent(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                      TraversalStats* stats) {
    with_policy(stats, [&](auto policy) HWY_ATTR {
        run_coherent(scene, rays, best, policy, [&](std::size_t first, std::size_t count) {
            closest_batch(scene, rays.subspan(first, count), best.subspan(first, count), stats);
        });
    });
}

void occluded_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                       std::span<bool> occluded, TraversalStats* stats) {
    with_policy(stats, [&](auto policy) HWY_ATTR {
        run_coherent(scene, rays, occluded, policy, [&](std::size_t first, std::size_t count) {
            occluded_batch(scene, rays.subspan(first, count), occluded.subspan(first, count),
                           stats);
        });
    });
}

}  // namespace

const WideBvhKernels& kernels() {
    static constexpr WideBvhKernels kernels{&closest,          &occluded,         &collect<false>,
                                            &collect<true>,    &closest_batch,    &occluded_batch,
                                            &closest_coherent, &occluded_coherent};
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(kernels);

const WideBvhKernels& wide_bvh_kernels() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(kernels)();
}

}  // namespace alhazen
#endif
