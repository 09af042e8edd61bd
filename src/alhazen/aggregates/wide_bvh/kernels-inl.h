/// The kernels of the wide BVH aggregate (wide_bvh_kernels.h) for one node width and one triangle
/// test.
///
/// A source file defines three macros and includes this file, which compiles itself once per
/// instruction set:
/// - ALHAZEN_KERNELS_FUNCTION: the function that returns the kernels of the chosen instruction set
/// - ALHAZEN_KERNELS_WIDTH: children of a node
/// - ALHAZEN_KERNELS_TEST: the triangle test, FilteredTriangleTest or FloatTriangleTest

#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/aggregates/wide_bvh/kernels-inl.h"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/aggregates/wide_bvh/coherent_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/dispatch-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// `W` children a node.
template <std::size_t W, class TriangleTest>
struct Kernels {
    using Closest = ClosestQuery<TriangleTest>;
    using Occluded = OccludedQuery<TriangleTest>;

    static void closest(const WideBvhScene& scene, const Ray& ray, Hit& best,
                        TraversalStats* stats) {
        Closest query(scene, ray, best);
        run<W>(query, stats);
    }
    static bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
        bool result = false;
        Occluded query(scene, ray, result);
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
        run_batch<Closest, W>(scene, rays, best, stats);
    }
    static void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                               std::span<bool> occluded, TraversalStats* stats) {
        run_batch<Occluded, W>(scene, rays, occluded, stats);
    }
    /// Rays in no packet go one by one where they are few or the tree is small.
    static void closest_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                                 std::span<Hit> best, TraversalStats* stats) {
        with_policy(stats, [&](auto policy) HWY_ATTR {
            const auto otherwise = [&](std::size_t first, std::size_t count) {
                if (streams_coherent(scene, count)) {
                    return closest_batch(scene, rays.subspan(first, count),
                                         best.subspan(first, count), stats);
                }
                for (std::size_t i = first; i < first + count; ++i) {
                    closest(scene, rays[i], best[i], stats);
                }
            };
            run_coherent<ClosestPacket>(scene, rays, best, policy, otherwise);
        });
    }
    static void occluded_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                                  std::span<bool> result, TraversalStats* stats) {
        with_policy(stats, [&](auto policy) HWY_ATTR {
            const auto otherwise = [&](std::size_t first, std::size_t count) {
                if (streams_coherent(scene, count)) {
                    return occluded_batch(scene, rays.subspan(first, count),
                                          result.subspan(first, count), stats);
                }
                for (std::size_t i = first; i < first + count; ++i) {
                    if (!result[i]) result[i] = occluded(scene, rays[i], stats);
                }
            };
            run_coherent<OccludedPacket>(scene, rays, result, policy, otherwise);
        });
    }

    /// Packets are for nodes of 8, and exact. The collecting queries are exact in both precisions:
    /// with FloatTriangleTest they are null here, and taken from the exact kernels.
    static constexpr WideBvhKernels table() {
        WideBvhKernels kernels{&closest,       &occluded,       nullptr, nullptr,
                               &closest_batch, &occluded_batch, nullptr, nullptr};
        if constexpr (TriangleTest::kExact) {
            kernels.all_hits = &collect<false>;
            kernels.shadowed = &collect<true>;
            if constexpr (W == 8) {
                kernels.closest_coherent = &closest_coherent;
                kernels.occluded_coherent = &occluded_coherent;
            }
        }
        return kernels;
    }
};

const WideBvhKernels& ALHAZEN_KERNELS_FUNCTION() {
    static constexpr WideBvhKernels kernels =
        Kernels<ALHAZEN_KERNELS_WIDTH, ALHAZEN_KERNELS_TEST>::table();
    return kernels;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

HWY_EXPORT(ALHAZEN_KERNELS_FUNCTION);

const WideBvhKernels& ALHAZEN_KERNELS_FUNCTION() {
    return HWY_DYNAMIC_DISPATCH(ALHAZEN_KERNELS_FUNCTION)();
}

}  // namespace alhazen
#endif
