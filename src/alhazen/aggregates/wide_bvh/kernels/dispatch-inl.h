/// Traversal of the tree of a scene by one ray or by a batch.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_DISPATCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_DISPATCH_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_DISPATCH_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_DISPATCH_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <type_traits>

#include "alhazen/accel/wide_bvh/trace/sorted_stream-inl.h"
#include "alhazen/accel/wide_bvh/trace/traverse-inl.h"
#include "alhazen/aggregates/wide_bvh/batch_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_prefetch-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/ray_records-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/shared_descent-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Whether a ray begins close to the one that this thread asked about before, whatever the tree.
HWY_INLINE bool begins_near_last(const LocalFrame& frame, const Ray& ray) {
    using D = Lanes<double, 4>;
    constexpr double kNear = 0x1p-5;  // in the local frame, where the scene is 2 wide
    alignas(32) static thread_local double last[4];
    const D origin = load_unaligned<4>(&ray.origin.x);  // and a component of the direction
    const D moved = abs(origin - load_lanes<4>(last));
    store_lanes(origin, last);
    return (bits_of(moved <= D(kNear * frame.inverse_scale)) & 7) == 7;
}

/// Whether it has about the direction of the last one that this function was asked about.
HWY_INLINE bool goes_as_last(const NearbyRay& ray) {
    using F = AxisLanes::F;
    alignas(16) static thread_local float last[4];
    const F direction = first_three(ray.direction);
    const F turned = abs(direction - load_lanes<4>(last));
    store_lanes(direction, last);
    return (bits_of(turned <= F(0x1p-4f) * ray.length()) & 7) == 7;
}

/// `near_last`: whether the ray begins near the last one.
template <std::size_t W, class Query, class Stats>
HWY_INLINE bool run(Query& query, bool near_last, Stats stats) {
    if (!query.valid) return false;
    const WideBvh& tree = query.scene.layout->tree;
    const bool stopped =
        traverse<Query::kOrdered>(nodes_of<W>(tree).data(), tree.root, query.slabs,
                                  near_last ? Follows::Origin : Follows::Nothing, query, stats);
    if constexpr (requires { query.finish(stats); }) query.finish(stats);
    return stopped;
}

/// The valid, unfinished rays of a batch that meet a child of the root, if it is a node. Of each
/// sixteen, those that are not prepared in lanes come last.
template <class Query, std::size_t W, class Result, class Stats>
class BatchSource {
    /// Whether rays visit the upper nodes together (shared_descent-inl.h).
    static constexpr bool kShares = RayRecords::kSupported && W == WideNode::kWidth &&
                                    !Query::kOrdered && Query::kExact && !Stats::kCounts;
    /// Whether they are tested together against the leaves of the root first, for closest hits.
    static constexpr bool kLimits =
        RayRecords::kHasEntries<W> && Query::kOrdered && Query::kExact && !Stats::kCounts;

  public:
    HWY_INLINE BatchSource(const WideBvhScene& scene, const PrefetchTable& prefetch_table,
                           const GivenRays& rays, std::span<Result> results, Stats stats)
        : scene_(scene),
          prefetch_table_(prefetch_table),
          rays_(rays),
          results_(results),
          frame_(scene.layout->frame, rays),
          stats_(stats),
          resolution_(scene) {
        const WideBvh& tree = scene.layout->tree;
        if (tree.root.is_leaf()) return;
        root_ = &nodes_of<W>(tree)[tree.root.index()];
        find_box(*root_, root_box_);
        if (!Stats::kCounts) {
            const LocalFrame& frame = scene.layout->frame;
            tree_box_ = TreeBox(*root_, Query::slab_slack(frame), frame.slack);
        }
        if (scene.layout->is_indexed()) return;
        for (std::uint32_t i = 0; kLimits && i < root_->child_count(); ++i) {
            const NodeRef child = root_->child[i];
            const bool first =
                child.is_leaf() && static_cast<LeafType>(child.kind()) == LeafType::Triangles;
            first_leaves_ |= std::uint32_t{first} << i;
        }
        shares_ = kShares || first_leaves_ != 0;
    }

    /// `entries`: set to where the ray enters the children of the root, if that is known.
    HWY_INLINE bool start(void* place, const float*& entries) {
        while (true) {
            if (HWY_LIKELY(prepared_ != 0)) {
                const std::size_t i = take(prepared_);
                if constexpr (kShares) started_ = i - first_;
                if constexpr (RayRecords::kHasEntries<W>) {
                    if (HWY_LIKELY(root_ != nullptr && !(kShares && shared_))) {
                        entries = records_.entries(i - first_);
                    }
                }
                auto* const query = new (place) Query(
                    scene_, PreparedRay{given_[i - first_], records_[i - first_]}, results_[i]);
                if constexpr (kLimits) {
                    if ((limited_ >> (i - first_) & 1) != 0) {
                        const std::uint32_t nearest = nearest_of(i - first_);
                        (void)query->candidates.add(block_of(nearest), nearest % kBlockWidth,
                                                    nearest_lo_[i - first_]);
                    }
                }
                return true;
            }
            if (HWY_UNLIKELY(others_ != 0)) {
                if constexpr (kShares) started_ = kAlone;
                if (start_alone(place, take(others_))) return true;
            } else if (!fill()) {
                return false;
            }
        }
    }

    /// See sorted_stream-inl.h.
    HWY_INLINE std::size_t subtrees(std::uint32_t* place) const requires kShares {
        return started_ == kAlone || !shared_ ? 0 : left_.copy(started_, place);
    }
    /// Called when the query has visited all of its leaves.
    HWY_INLINE void finish(Query& query, Stats stats) {
        if constexpr (requires { query.finish_later(resolution_, stats); }) {
            query.finish_later(resolution_, stats);
        } else if constexpr (requires { query.finish(stats); }) {
            query.finish(stats);
        }
    }
    /// Called after the last ray.
    HWY_INLINE void finish_all(Stats stats) { resolution_.flush(stats); }

  private:
    static constexpr std::size_t kRays = RayRecords::kRays;
    /// Number of results to prefetch ahead.
    static constexpr std::size_t kSoon = 16;

    /// Removes the first of `bits`; the index of the ray.
    HWY_INLINE std::size_t take(std::uint32_t& bits) {
        const std::size_t i = first_ + static_cast<std::size_t>(std::countr_zero(bits));
        bits &= bits - 1;
        hwy::Prefetch(&results_[std::min(i + kSoon, results_.size() - 1)]);
        return i;
    }
    HWY_NOINLINE bool start_alone(void* place, std::size_t i) {
        return (new (place) Query(scene_, given_[i - first_], results_[i]))->valid;
    }
    /// Turns to the next rays; false if there are none.
    HWY_NOINLINE bool fill() {
        first_ = next_;
        const std::size_t count = std::min(kRays, rays_.size() - first_);
        if (count == 0) return false;
        next_ += count;
        const std::uint32_t waiting = unfinished(count);
        if (HWY_LIKELY(rays_.size() - next_ >= kRays)) rays_.prefetch<kRays>(next_);
        if constexpr (RayRecords::kSupported) {
            if (HWY_LIKELY(count == kRays)) {
                prepare(waiting);
                if ((prepared_ | others_) != 0) take_rays(count);
                return true;
            }
        }
        take_rays(count);
        others_ = waiting;
        return true;
    }
    /// Sets `prepared_` and `others_` for sixteen rays.
    HWY_INLINE void prepare(std::uint32_t waiting) {
        const FrameSlack& slack = scene_.layout->frame.slack;
        RayRows rays;
        rays.load(frame_, Query::slab_slack(scene_.layout->frame), tree_box_, rays_, first_);
        others_ = waiting & ~rays.prepared & ~rays.left;
        const std::uint32_t all = waiting & rays.prepared;
        prepared_ = all;
        if (all == 0) return;
        if (HWY_LIKELY(root_ != nullptr)) {
            RayRows::F entry;
            prepared_ = all & bits_of(rays.meet(root_box_, 0, entry));
            shared_ = prepared_ != 0 && shares_ && trials_.due();
            if constexpr (kShares) {
                if (shared_) {
                    share(rays);
                    if (prepared_ != 0) records_.store(rays, slack);
                    return;
                }
            }
            if constexpr (kLimits) {
                limited_ = 0;
                if (shared_) return limit(rays);
            }
            const auto none = [](std::size_t, std::uint32_t) { return 0u; };
            if (prepared_ != 0) prepared_ = records_.enter(rays, *root_, prepared_, 0, none);
            skip(all & ~prepared_);
        }
        if (prepared_ != 0) records_.store(rays, slack);
    }
    /// Tests the prepared rays against the leaves of the root, and ends those that meet nothing
    /// before what they hit there.
    HWY_INLINE void limit(RayRows& rays) {
        const std::uint32_t all = prepared_;
        SharedNearest nearest(scene_, rays);
        prepared_ = records_.enter(rays, *root_, all, first_leaves_,
                                   [&](std::size_t slot, std::uint32_t met)
                                       HWY_ATTR { return nearest.visit(root_->child[slot], met); });
        limited_ = nearest.found();
        trials_.tried(4 * std::popcount(limited_) >= std::popcount(all));
        std::uint32_t done = limited_ & ~prepared_;
        if ((prepared_ | done) == 0) return;
        records_.store(rays, scene_.layout->frame.slack);
        if (limited_ == 0) return;
        nearest.store(nearest_lo_, nearest_place_);
        if (done == 0) return;
        take_rays(kRays);
        for (; done != 0; done &= done - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(done));
            const std::uint32_t place = nearest_of(i);
            resolution_.add(given_[i], records_[i].filter, results_[first_ + i], block_of(place),
                            place % kBlockWidth, stats_);
        }
    }
    [[nodiscard]] HWY_INLINE std::uint32_t nearest_of(std::size_t ray) const {
        return std::bit_cast<std::uint32_t>(nearest_place_[ray]);
    }
    [[nodiscard]] HWY_INLINE const TriangleBlock& block_of(std::uint32_t place) const {
        return scene_.layout->triangles[place / kBlockWidth];
    }
    /// Takes the prepared rays through the tree together; those that are left to the stream.
    HWY_INLINE void share(const RayRows& rays) {
        const int all = std::popcount(prepared_);
        SharedDescent descent(scene_, prefetch_table_, rays, left_);
        const std::uint32_t hit = descent.run(scene_.layout->tree.root, prepared_);
        for (std::uint32_t rest = hit; rest != 0; rest &= rest - 1) {
            results_[first_ + static_cast<std::size_t>(std::countr_zero(rest))] = true;
        }
        prepared_ &= left_.rays() & ~hit;
        trials_.tried(4 * std::popcount(prepared_) <= 3 * all);
    }
    /// Bits of those of the rays from first_ on that are to be traced.
    [[nodiscard]] HWY_INLINE std::uint32_t unfinished(std::size_t count) const {
        if constexpr (std::is_same_v<Result, bool>) {
            std::uint32_t waiting = 0;
            for (std::size_t i = 0; i < count; ++i) {
                waiting |= std::uint32_t{!results_[first_ + i]} << i;
            }
            return waiting;
        } else {
            return (1u << count) - 1;
        }
    }
    HWY_INLINE void take_rays(std::size_t count) {
        const RayColumns* const columns = rays_.columns();
        if (columns == nullptr) {
            given_ = rays_.array() + first_;
            return;
        }
        given_ = of_columns_;
        const std::size_t first = rays_.first() + first_;
        if (HWY_LIKELY(count == kRays))
            return HWY_NAMESPACE::take_rays(*columns, first, of_columns_);
        for (std::size_t i = 0; i < count; ++i) of_columns_[i] = columns->ray(first + i);
    }
    /// Counts the rays that meet no child of the root.
    HWY_INLINE void skip(std::uint32_t missed) {
        if (!Stats::kCounts || missed == 0) return;
        const auto count = static_cast<std::uint64_t>(std::popcount(missed));
        stats_.nodes(count);
        stats_.boxes(count * root_->child_count());
    }

    const WideBvhScene& scene_;
    const PrefetchTable& prefetch_table_;
    GivenRays rays_;
    const Ray* given_ = nullptr;  ///< those from first_ on
    std::span<Result> results_;
    LaneFrame frame_;
    const WideNodeOf<W>* root_ = nullptr;
    float root_box_[6][1] = {};  ///< as planes of a node
    TreeBox tree_box_;           ///< rays that leave it are done; of rays that are counted, none
    [[no_unique_address]] Stats stats_;
    std::size_t first_ = 0, next_ = 0;
    std::uint32_t prepared_ = 0, others_ = 0;  ///< bits of the rays from first_ on
    RayRecords records_;
    std::uint32_t first_leaves_ = 0;  ///< bits of the children of the root that are leaves
    std::uint32_t limited_ = 0;       ///< bits of the rays that have a nearest triangle there
    alignas(64) float nearest_lo_[kRays], nearest_place_[kRays];  ///< see SharedNearest
    static constexpr std::size_t kAlone = kRays;
    bool shares_ = false;  ///< whether rays may go together
    bool shared_ = false;  ///< whether those from first_ on did
    SharedTrials trials_;
    std::size_t started_ = kAlone;  ///< the last ray that started
    LeftSubtrees left_;
    Ray of_columns_[kRays];
    BatchResolution resolution_;
};

/// Whether a batch visits most nodes and leaves several times, so that all but the first visits
/// find them in the caches. A ray visits some ten.
template <std::size_t W>
HWY_INLINE bool stays_in_caches(const WideBvhLayout& layout, std::size_t rays) {
    const std::size_t leaves = layout.triangles.size() + layout.indices.size() +
                               layout.spheres.size() + layout.frustums.size() +
                               layout.others.size();
    return nodes_of<W>(layout.tree).size() + leaves <= 4 * rays;
}

template <class Query, std::size_t W, class Result, class Stats>
HWY_NOINLINE void run_batch(const WideBvhScene& scene, const GivenRays& rays,
                            std::span<Result> results, Stats stats) {
    const WideBvhLayout& layout = *scene.layout;
    const NodeRef root = layout.tree.root;
    const WideNodeOf<W>* nodes = nodes_of<W>(layout.tree).data();
    const PrefetchTable prefetch_table = prefetch_table_of<W>(layout);
    BatchSource<Query, W, Result, Stats> source(scene, prefetch_table, rays, results, stats);
    const bool fetches = !stays_in_caches<W>(layout, rays.size());
    traverse_sorted<Query>(nodes, root, prefetch_table, fetches, source, stats);
    source.finish_all(stats);
}

/// The filter of the last occluders for several rays, two of them at a time. Nothing branches on
/// what it finds.
template <class Query>
HWY_INLINE void filter_recent(const BoxBlock& block, Query* const* queries, std::size_t count,
                              FilteredShapes* found) {
    const auto in_float = [](const Query& query) HWY_ATTR {
        return query.filter.edge_slack < std::numeric_limits<float>::infinity();
    };
    const auto at = [&](std::size_t i) HWY_ATTR {
        const Query& query = *queries[i];
        return RayAtBlock<BoxBlock>{block, query.filter, query.slabs.s_min, query.slabs.s_max,
                                    found[i]};
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (kPairsRays && i + 1 < count && in_float(*queries[i]) && in_float(*queries[i + 1])) {
            (void)shape_candidates(at(i), at(i + 1));
            ++i;
            continue;
        }
        const RayAtBlock<BoxBlock> one = at(i);
        (void)shape_candidates<true>(block, one.ray, one.s_min, one.s_max, found[i]);
    }
}

/// Rays one by one, each against the flat shapes that occluded the last ones first
/// (`scene.recent`).
template <class Query, std::size_t W, class Stats>
HWY_INLINE void run_singly(const WideBvhScene& scene, std::span<const Ray> rays,
                           std::span<bool> results, Stats stats) {
    constexpr std::size_t kTogether = RecentOccluders::kTogether;
    RecentOccluders& recent = *scene.recent;
    alignas(64) std::byte places[kTogether][(sizeof(Query) + 63) / 64 * 64];
    FilteredShapes found[kTogether];
    for (std::size_t first = 0, end = 0; first < rays.size(); first = end) {
        Query* queries[kTogether];
        bool follows[kTogether];
        std::size_t count = 0;
        end = std::min(first + (recent.empty() ? 1 : kTogether), rays.size());
        for (std::size_t i = first; i < end; ++i) {
            if (results[i]) continue;
            follows[count] = begins_near_last(scene.layout->frame, rays[i]);
            queries[count] = new (places[count]) Query(scene, rays[i], results[i]);
            count += queries[count]->valid;
        }
        if (count == 0) continue;
        const auto tried = static_cast<std::uint32_t>(count);
        if (recent.worth_trying(tried)) {
            filter_recent(recent.block(), queries, count, found);
            std::size_t left = 0;
            for (std::size_t n = 0; n < count; ++n) {
                const bool hit = queries[n]->take_recent(recent, found[n], stats);
                queries[left] = queries[n];
                follows[left] = follows[n];
                left += !hit;
            }
            recent.tried(tried, tried - static_cast<std::uint32_t>(left));
            count = left;
        }
        for (std::size_t n = 0; n < count; ++n) {
            Query& query = *queries[n];
            run<W>(query, follows[n], stats);
            if (query.sure_block != nullptr) recent.add(*query.sure_block, query.sure_lane);
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
