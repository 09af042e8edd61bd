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
    const WideBvh& tree = query.scene.layout->tree;
    return with_policy(stats, [&](auto policy) HWY_ATTR {
        return traverse<Query::kOrdered>(tree.nodes.data(), tree.root, query.slabs, query, policy);
    });
}

HWY_INLINE void make_group(const WideBvhScene& scene, const Ray& ray, RayGroup<1>& group) {
    RayLanes<1> lanes;
    lanes.set(0, ray);
    group.make(scene.layout->frame, lanes);
}

void closest(const WideBvhScene& scene, const Ray& ray, Hit& best, TraversalStats* stats) {
    RayGroup<1> group;
    make_group(scene, ray, group);
    ClosestQuery<1> query(scene, group, 0, ray, best);
    run(query, stats);
    with_policy(stats, [&](auto policy) HWY_ATTR { query.finish(policy); });
}

bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
    RayGroup<1> group;
    make_group(scene, ray, group);
    bool result = false;
    OccludedQuery<1> query(scene, group, 0, ray, result);
    return run(query, stats);
}

template <bool kStopAtOpaque>
bool collect(const WideBvhScene& scene, const Ray& ray, std::vector<Hit>& hits,
             TraversalStats* stats) {
    RayGroup<1> group;
    make_group(scene, ray, group);
    CollectQuery<kStopAtOpaque> query(scene, group, ray, hits);
    return run(query, stats);
}

// ---- many rays

/// Rays that are made ready together.
constexpr std::size_t kGroup = 8;

/// The rays of a batch one after the other; those that cannot be traced, or need not be, are left
/// out.
template <class Query, class Result>
class BatchSource {
  public:
    HWY_INLINE BatchSource(const WideBvhScene& scene, std::span<const Ray> rays,
                           std::span<Result> results)
        : scene_(scene), rays_(rays), results_(results) {}

    HWY_INLINE Query* start(void* place) {
        if (next_ == ready_ && !prepare()) return nullptr;
        const std::size_t i = next_++;
        Group& group = groups_[current_];
        return new (place) Query(scene_, group.rays, i, group.ray[i], results_[group.index[i]]);
    }
    /// The query is done with its ray.
    HWY_INLINE void release(const Query& query) {
        const auto* place = reinterpret_cast<const char*>(&query.slabs);
        const auto* first = reinterpret_cast<const char*>(groups_);
        --groups_[static_cast<std::size_t>(place - first) / sizeof(Group)].left;
    }

  private:
    struct Group {
        RayGroup<kGroup> rays;
        Ray ray[kGroup];
        std::size_t index[kGroup];  ///< in the batch
        std::size_t left = 0;       ///< rays that are not done
    };

    /// False when there are no more.
    HWY_NOINLINE bool prepare() {
        // One of them is free: a ray on its way holds one group, and one is started from.
        current_ = 0;
        while (groups_[current_].left != 0) ++current_;
        Group& group = groups_[current_];
        RayLanes<kGroup> lanes;
        std::size_t count = 0;
        for (; count < kGroup && position_ < rays_.size(); ++position_) {
            if (!needed(rays_[position_], results_[position_])) continue;
            group.index[count] = position_;
            group.ray[count] = shortened(rays_[position_], results_[position_]);
            lanes.set(count, group.ray[count]);
            ++count;
        }
        if (count == 0) return false;
        for (std::size_t i = count; i < kGroup; ++i) lanes.set(i, group.ray[0]);
        group.rays.make(scene_.layout->frame, lanes);
        group.left = count;
        next_ = 0;
        ready_ = count;
        return true;
    }

    static bool needed(const Ray& ray, const Hit&) { return is_valid(ray); }
    static bool needed(const Ray& ray, bool occluded) { return !occluded && is_valid(ray); }
    static Ray shortened(Ray ray, const Hit& best) {
        if (best.found()) ray.t_max = best.t;
        return ray;
    }
    static const Ray& shortened(const Ray& ray, bool) { return ray; }

    const WideBvhScene& scene_;
    std::span<const Ray> rays_;
    std::span<Result> results_;
    std::size_t position_ = 0;          ///< of the next ray of the batch
    std::size_t current_ = 0;           ///< the group that rays are started from
    std::size_t next_ = 0, ready_ = 0;  ///< in that group
    Group groups_[kStreamSlots + 1];
};

template <class Query, class Result>
HWY_INLINE void run_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                          std::span<Result> results, TraversalStats* stats) {
    BatchSource<Query, Result> source(scene, rays, results);
    const WideBvh& tree = scene.layout->tree;
    with_policy(stats, [&](auto policy) HWY_ATTR {
        traverse_stream<Query>(tree.nodes.data(), tree.root, source, policy);
    });
}

void closest_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<Hit> best,
                   TraversalStats* stats) {
    run_batch<ClosestQuery<kGroup>>(scene, rays, best, stats);
}

void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays, std::span<bool> occluded,
                    TraversalStats* stats) {
    run_batch<OccludedQuery<kGroup>>(scene, rays, occluded, stats);
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
