/// The kernels of the wide BVH aggregate (wide_bvh_kernels.h) for one node width, one triangle
/// test, and with or without counting.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_INL_H_
#endif

#include <algorithm>
#include <span>

#include "alhazen/aggregates/wide_bvh/coherent_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/dispatch-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

HWY_INLINE bool is_found(const Hit& hit) {
    return hit.found();
}
HWY_INLINE bool is_found(bool occluded) {
    return occluded;
}

/// As trace_one, for every ray.
template <std::size_t W, class Query, class Result>
HWY_NOINLINE bool trace_any(const WideBvhScene& scene, const Ray& ray, Result& result) {
    result = Result{};
    const bool follows = begins_near_last(scene.layout->frame, ray);
    Query query(scene, ray, result);
    run<W>(query, follows, NoStats{});
    return is_found(result);
}

/// The bytes of nodes up to which most of a tree, whose leaves take several times as much, stays in
/// the caches.
inline constexpr std::size_t kMostInCaches = std::size_t{6} << 20;

/// Continues a ray that follows no other in a larger tree. In a function of its own: what it does
/// more would slow other rays.
template <std::size_t W, class Query>
HWY_NOINLINE void traverse_far(const WideNodeOf<W>* nodes, NodeRef next, NodeStack<W>& stack,
                               std::size_t height, Query& query) {
    (void)traverse_from<true, true>(nodes, next, stack, height, query.slabs, Follows::Nothing,
                                    query, NoStats{});
}

/// Sets `result`, of any value before, to that of the query, and returns whether anything is hit.
/// Many rays meet no child of the root: they need no query, and are not prepared for leaves.
template <std::size_t W, class Query, class Result>
HWY_INLINE bool trace_one(const WideBvhScene& scene, const Ray& ray, Result& result) {
    const WideBvhLayout& layout = *scene.layout;
    const NodeRef root = layout.tree.root;
    SlabLanes lanes;
    NearbyRay nearby;
    if (HWY_UNLIKELY(root.is_leaf()) ||
        HWY_UNLIKELY(
            !start_nearby(layout.frame, Query::slab_slack(layout.frame), ray, lanes, nearby))) {
        return trace_any<W, Query>(scene, ray, result);
    }
    const auto& tree_nodes = nodes_of<W>(layout.tree);
    const WideNodeOf<W>* nodes = tree_nodes.data();
    const WideNodeOf<W>& node = nodes[root.index()];
    HWY_ALIGN float range[4];
    store_lanes(lanes.range, range);
    Lanes<float, W> entries;
    const LaneMask<float, W> met = intersect_children(node, lanes, range[0], range[1], entries);
    const std::uint32_t bits = bits_of(met);
    result = Result{};
    if (bits == 0) return false;
    // Before the first jump on the children: what follows one that was not foreseen begins late.
    Query query(scene, ray, result, lanes, range[1]);
    query.prepare_leaves(ray, nearby);
    Follows follows = begins_near_last(layout.frame, ray) ? Follows::Origin : Follows::Nothing;
    if constexpr (!Query::kOrdered) {
        const bool same_way = goes_as_last(nearby);
        if (follows == Follows::Origin && same_way) follows = Follows::Way;
    }
    NodeStack<W> stack;
    std::size_t height = 0;
    const NodeRef next = next_child<Query::kOrdered, false>(
        nodes, node, stack, height, entries, met, bits, lanes.near.octant, follows, query);
    if constexpr (Query::kOrdered) {
        if (follows == Follows::Nothing && tree_nodes.size() * sizeof(node) > kMostInCaches &&
            !next.is_leaf()) {
            traverse_far(nodes, next, stack, height, query);
            query.finish(NoStats{});
            return is_found(result);
        }
    }
    (void)traverse_from<Query::kOrdered>(nodes, next, stack, height, query.slabs, follows, query,
                                         NoStats{});
    query.finish(NoStats{});
    return is_found(result);
}

/// `W` children per node. `Stats` is CountingStats, which adds to the statistics of a query, or
/// NoStats, which ignores them.
template <std::size_t W, class TriangleTest, class Stats>
struct Kernels {
    using Closest = ClosestQuery<TriangleTest>;
    using Occluded = OccludedQuery<TriangleTest>;

    static void closest(const WideBvhScene& scene, const Ray& ray, Hit& best,
                        TraversalStats* stats) {
        const bool follows = begins_near_last(scene.layout->frame, ray);
        Closest query(scene, ray, best);
        run<W>(query, follows, policy(stats));
    }
    static bool closest_of_one(const WideBvhScene& scene, const Ray& ray, Hit& hit,
                               TraversalStats* stats) {
        if constexpr (Stats::kCounts) {
            hit = Hit{};
            closest(scene, ray, hit, stats);
            return hit.found();
        } else {
            return trace_one<W, Closest>(scene, ray, hit);
        }
    }
    static bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
        bool result = false;
        if constexpr (Stats::kCounts) {
            const bool follows = begins_near_last(scene.layout->frame, ray);
            Occluded query(scene, ray, result);
            run<W>(query, follows, policy(stats));
            return result;
        } else {
            return trace_one<W, Occluded>(scene, ray, result);
        }
    }
    static bool all_hits(const WideBvhScene& scene, const Ray& ray, std::vector<Hit>& hits,
                         TraversalStats* stats) {
        return collect(scene, ray, hits, false, stats);
    }
    static bool shadowed(const WideBvhScene& scene, const Ray& ray, std::vector<Hit>& hits,
                         TraversalStats* stats) {
        return collect(scene, ray, hits, true, stats);
    }
    static void closest_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                              std::span<Hit> best, TraversalStats* stats) {
        run_batch<Closest, W>(scene, GivenRays(rays), best, policy(stats));
    }
    static void closest_column_stream(const WideBvhScene& scene, const RayColumns& rays,
                                      std::span<Hit> best, TraversalStats* stats) {
        run_batch<Closest, W>(scene, GivenRays(rays), best, policy(stats));
    }
    static void occluded_column_stream(const WideBvhScene& scene, const RayColumns& rays,
                                       std::span<bool> occluded, TraversalStats* stats) {
        run_batch<Occluded, W>(scene, GivenRays(rays), occluded, policy(stats));
    }
    static void occluded_batch(const WideBvhScene& scene, std::span<const Ray> rays,
                               std::span<bool> occluded, TraversalStats* stats) {
        if (scene.recent != nullptr) {
            return run_singly<Occluded, W>(scene, rays, occluded, policy(stats));
        }
        run_batch<Occluded, W>(scene, GivenRays(rays), occluded, policy(stats));
    }
    /// Rays in no packet are traced one by one if they are few or the tree is small.
    static void closest_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                                 std::span<Hit> best, bool unset, TraversalStats* stats) {
        const auto otherwise = [&](std::size_t first, std::size_t count) {
            if (streams_coherent(scene, count)) {
                return closest_batch(scene, rays.subspan(first, count), best.subspan(first, count),
                                     stats);
            }
            for (std::size_t i = first; i < first + count; ++i) {
                closest(scene, rays[i], best[i], stats);
            }
        };
        run_coherent<ClosestPacket, ClosestLanes>(scene, rays, best, HitArraySink{best, unset},
                                                  policy(stats), otherwise);
    }
    static void occluded_coherent(const WideBvhScene& scene, std::span<const Ray> rays,
                                  std::span<bool> result, TraversalStats* stats) {
        const auto otherwise = [&](std::size_t first, std::size_t count) {
            if (streams_coherent(scene, count)) {
                return occluded_batch(scene, rays.subspan(first, count),
                                      result.subspan(first, count), stats);
            }
            for (std::size_t i = first; i < first + count; ++i) {
                if (!result[i]) result[i] = occluded(scene, rays[i], stats);
            }
        };
        run_coherent<OccludedPacket, OccludedLanes>(scene, rays, result, OcclusionSink{result},
                                                    policy(stats), otherwise);
    }
    static bool closest_columns([[maybe_unused]] const WideBvhScene& scene,
                                [[maybe_unused]] const RayColumns& rays,
                                [[maybe_unused]] const HitColumns& hits,
                                [[maybe_unused]] TraversalStats* stats) {
        if constexpr (kParts<float, 16> <= kMostLaneRegisters) {
            if (!has_lane_packets<false>(scene)) return false;
            const auto otherwise = [&](std::size_t i, std::size_t) {
                Hit hit;
                closest(scene, rays.ray(i), hit, stats);
                hits.set(i, hit);
            };
            run_lanes<ClosestLanes>(scene, GivenRays(rays), HitColumnsSink{hits}, policy(stats),
                                    otherwise);
            return true;
        }
        return false;
    }
    static bool occluded_columns(const WideBvhScene& scene, const RayColumns& rays,
                                 std::span<bool> result, TraversalStats* stats) {
        if (!has_lane_packets<true>(scene)) return false;
        std::fill(result.begin(), result.end(), false);
        const auto otherwise = [&](std::size_t i, std::size_t) {
            result[i] = occluded(scene, rays.ray(i), stats);
        };
        run_lanes<OccludedLanes>(scene, GivenRays(rays), OcclusionSink{result}, policy(stats),
                                 otherwise);
        return true;
    }

    /// Packets exist for nodes of 8 and exact tests only. The collecting queries are exact in both
    /// precisions: with FloatTriangleTest they are null, and the exact kernels serve instead.
    static constexpr WideBvhKernels table() {
        WideBvhKernels kernels{};
        kernels.closest_of_one = &closest_of_one;
        kernels.closest = &closest;
        kernels.occluded = &occluded;
        kernels.closest_batch = &closest_batch;
        kernels.occluded_batch = &occluded_batch;
        kernels.closest_column_stream = &closest_column_stream;
        kernels.occluded_column_stream = &occluded_column_stream;
        if constexpr (TriangleTest::kExact) {
            kernels.all_hits = &all_hits;
            kernels.shadowed = &shadowed;
            if constexpr (W == 8) {
                kernels.closest_coherent = &closest_coherent;
                kernels.occluded_coherent = &occluded_coherent;
                kernels.closest_columns = &closest_columns;
                kernels.occluded_columns = &occluded_columns;
            }
        }
        return kernels;
    }

  private:
    /// One traversal for both queries halves the compilation.
    static HWY_NOINLINE bool collect(const WideBvhScene& scene, const Ray& ray,
                                     std::vector<Hit>& hits, bool stops_at_opaque,
                                     TraversalStats* stats) {
        CollectQuery query(scene, ray, hits, stops_at_opaque);
        return run<W>(query, begins_near_last(scene.layout->frame, ray), policy(stats));
    }
    static HWY_INLINE Stats policy([[maybe_unused]] TraversalStats* stats) {
        if constexpr (Stats::kCounts) {
            return Stats{stats};
        } else {
            return Stats{};
        }
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
