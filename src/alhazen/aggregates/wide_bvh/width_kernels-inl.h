/// The queries of the wide BVH aggregate over nodes of one width, but for packets.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_WIDTH_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_WIDTH_KERNELS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_WIDTH_KERNELS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_WIDTH_KERNELS_INL_H_
#endif

#include "alhazen/aggregates/wide_bvh/dispatch-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// `W` children a node.
template <std::size_t W>
struct WidthKernels {
    static void closest(const WideBvhScene& scene, const Ray& ray, Hit& best,
                        TraversalStats* stats) {
        ClosestQuery query(scene, ray, best);
        run<W>(query, stats);
    }
    static bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
        bool result = false;
        OccludedQuery query(scene, ray, result);
        return run<W>(query, stats);
    }
    template <bool kStopAtOpaque>
    static bool collect(const WideBvhScene& scene, const Ray& ray, std::vector<Hit>& hits,
                        TraversalStats* stats) {
        CollectQuery<kStopAtOpaque> query(scene, ray, hits);
        return run<W>(query, stats);
    }
    static void closest_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                              std::span<Hit> best, TraversalStats* stats) {
        run_batch<ClosestQuery, W>(scene, rays, best, stats);
    }
    static void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                               std::span<bool> occluded, TraversalStats* stats) {
        run_batch<OccludedQuery, W>(scene, rays, occluded, stats);
    }

    /// Coherent rays are traced like any others.
    static constexpr WideBvhKernels table() {
        return {&closest,       &occluded,       &collect<false>, &collect<true>,
                &closest_batch, &occluded_batch, &closest_batch};
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
