#include "alhazen/scene/wide_bvh_kernels.h"

#include <new>

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/scene/wide_bvh_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/accel/wide_bvh/stream-inl.h"
#include "alhazen/accel/wide_bvh/traverse-inl.h"
#include "alhazen/scene/leaf_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

/// Calls `body(policy)` with the policy that counts into `stats`, or the one that does not.
template <class Body>
HWY_INLINE auto with_policy(TraversalStats* stats, Body&& body) {
    return stats != nullptr ? body(CountingStats{stats}) : body(NoStats{});
}

// ---- one ray

template <class Query>
HWY_INLINE bool run(Query& query, TraversalStats* stats) {
    if (!query.valid) return false;
    const WideBvh& tree = query.scene.layout->tree;
    return with_policy(stats, [&](auto policy) HWY_ATTR {
        return traverse<Query::kOrdered>(tree.nodes.data(), tree.root, query.slabs, query, policy);
    });
}

void closest(const WideBvhScene& scene, const Ray& ray, Hit& best, TraversalStats* stats) {
    ClosestQuery query(scene, ray, best);
    run(query, stats);
    with_policy(stats, [&](auto policy) HWY_ATTR { query.finish(policy); });
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

// ---- many rays

/// The rays of a batch one after the other; those that cannot be traced, or need not be, are left
/// out.
template <class Query, class Result>
class BatchSource {
  public:
    HWY_INLINE BatchSource(const WideBvhScene& scene, std::span<const Ray> rays,
                           std::span<Result> results)
        : scene_(scene), rays_(rays), results_(results), decider_(scene) {}

    HWY_INLINE bool start(void* place) {
        while (next_ < rays_.size()) {
            const std::size_t i = next_++;
            if (done(results_[i])) continue;
            if ((new (place) Query(scene_, rays_[i], results_[i]))->valid) return true;
        }
        return false;
    }

    template <class Stats>
    HWY_INLINE void finish(ClosestQuery& query, Stats stats) {
        query.finish_later(decider_, stats);
    }
    template <class Stats>
    HWY_INLINE void finish(OccludedQuery&, Stats) {}
    /// After the last ray.
    template <class Stats>
    HWY_INLINE void finish_all(Stats stats) {
        decider_.flush(stats);
    }

  private:
    static bool done(const Hit&) { return false; }
    static bool done(bool occluded) { return occluded; }

    const WideBvhScene& scene_;
    std::span<const Ray> rays_;
    std::span<Result> results_;
    std::size_t next_ = 0;
    TriangleDecider decider_;
};

/// Trees up to this size are near enough without prefetching: measured with a second-level cache of
/// 2 MB.
constexpr std::size_t kCachedBytes = std::size_t{8} << 20;

template <class Query, class Result>
HWY_INLINE void run_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                          std::span<Result> results, TraversalStats* stats) {
    BatchSource<Query, Result> source(scene, rays, results);
    const WideBvh& tree = scene.layout->tree;
    const WideBvhLayout& layout = *scene.layout;
    const Places places(tree.nodes.data(),
                        {layout.triangles.data(), layout.spheres.data(), layout.others.data()},
                        {sizeof(TriangleBlock), sizeof(SphereBlock), sizeof(PrimitiveId)});
    with_policy(stats, [&](auto policy) HWY_ATTR {
        if (layout.memory_bytes() > kCachedBytes) {
            traverse_stream<Query, true>(tree.nodes.data(), tree.root, places, source, policy);
        } else {
            traverse_stream<Query, false>(tree.nodes.data(), tree.root, places, source, policy);
        }
        source.finish_all(policy);
    });
}

void closest_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                   TraversalStats* stats) {
    run_batch<ClosestQuery>(scene, rays, best, stats);
}

void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<bool> occluded,
                    TraversalStats* stats) {
    run_batch<OccludedQuery>(scene, rays, occluded, stats);
}

}  // namespace

const WideBvhKernels& kernels() {
    static constexpr WideBvhKernels kernels{&closest,       &occluded,      &collect<false>,
                                            &collect<true>, &closest_batch, &occluded_batch};
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
