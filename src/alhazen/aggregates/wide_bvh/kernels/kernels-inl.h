/// The kernels of the wide BVH aggregate (wide_bvh_kernels.h) for one node width, one triangle
/// test, and with or without counting.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_KERNELS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_KERNELS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_KERNELS_KERNELS_INL_H_
#endif

#include <algorithm>
#include <span>

#include "alhazen/aggregates/wide_bvh/kernels/dispatch-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/coherent_queries-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// As trace_one, for every ray.
template <std::size_t W, class Query>
HWY_NOINLINE bool trace_any(const WideBvhScene& scene, const Ray& ray, Hit* hit) {
    const bool follows = begins_near_last(scene.layout->frame, ray);
    if constexpr (Query::kOrdered) {
        *hit = Hit{};
        Query query(scene, ray, *hit);
        run<W>(query, follows, NoStats{});
        return hit->found();
    } else {
        bool occluded = false;
        Query query(scene, ray, occluded);
        run<W>(query, follows, NoStats{});
        return occluded;
    }
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

/// Whether a ray begins with WideBvhScene::largest_leaf, whose address does not depend on what the
/// test of the root finds: its triangles are tested at the same time. Any-hit queries keep their
/// order; of the others those do that begin in its box, or all if it is the best for any hit.
template <std::size_t W, class Query>
HWY_INLINE bool takes_largest_leaf(const WideBvhScene& scene, const SlabLanes& lanes,
                                   std::uint32_t bits, const Lanes<float, W>& entries) {
    if ((bits & scene.largest_leaf_slot) == 0) return false;
    if (scene.largest_leaf_slot == 1) return true;
    if constexpr (!Query::kOrdered) return false;
    const auto begun = entries <= spread<0, W>(lanes.range);
    return (bits_of(begun) & scene.largest_leaf_slot) != 0;
}

/// Pushes the children of the root of `bits`, which may be none, without a jump on their number;
/// the height of the stack.
template <bool kOrdered, std::size_t W>
HWY_INLINE std::size_t push_others(NodeStack<W>& stack, const WideNodeOf<W>& root,
                                   const Lanes<float, W>& entries, std::uint32_t bits,
                                   std::uint32_t octant) {
    std::size_t height = 0;
    if constexpr (kOrdered) {
        // Entries are not negative: the others are left before they are entered.
        const auto exits =
            select_lanes(lanes_of_bits<float, W>(bits), entries, Lanes<float, W>(-1.0f));
        height = stack.template push<true>(0, root, entries, exits, octant);
    } else {
        stack.push_at_once(height, root, bits);
    }
    return height;
}

/// Visits the children of the root that a query meets, `bits`, and what follows. `Result`: Hit or
/// bool, as the query finds.
template <std::size_t W, class Query, class Result>
HWY_INLINE void trace_children(const WideBvhScene& scene, const Ray& ray, const SlabLanes& lanes,
                               const NearbyRay& nearby, std::uint32_t bits,
                               const Lanes<float, W>& entries, Result& result) {
    const WideBvhLayout& layout = *scene.layout;
    const auto& tree_nodes = nodes_of<W>(layout.tree);
    const WideNodeOf<W>* nodes = tree_nodes.data();
    const WideNodeOf<W>& node = nodes[layout.tree.root.index()];
    // Before the first jump on the children: what follows one that was not foreseen begins late.
    Query query(scene, ray, result, lanes);
    query.prepare_leaves(ray, nearby);
    Follows follows = begins_near_last(layout.frame, ray) ? Follows::Origin : Follows::Nothing;
    if constexpr (!Query::kOrdered) {
        const bool same_way = goes_as_last(nearby);
        if (follows == Follows::Origin && same_way) follows = Follows::Way;
    }
    NodeStack<W> stack;
    std::size_t height = 0;
    NodeRef next;
    const bool begins_in_leaf = takes_largest_leaf<W, Query>(scene, lanes, bits, entries);
    if (begins_in_leaf) {
        const std::uint32_t others = bits & ~scene.largest_leaf_slot;
        height = push_others<Query::kOrdered>(stack, node, entries, others, lanes.near.octant);
        next = NodeRef::from_bits(scene.largest_leaf);
    } else {
        next = next_child<Query::kOrdered, false>(nodes, node, stack, height, entries,
                                                  lanes_of_bits<float, W>(bits), bits,
                                                  lanes.near.octant, follows, query);
    }
    if constexpr (Query::kOrdered) {
        if (follows == Follows::Nothing && tree_nodes.size() * sizeof(node) > kMostInCaches &&
            (begins_in_leaf || !next.is_leaf())) {
            traverse_far(nodes, next, stack, height, query);
            query.finish(NoStats{});
            return;
        }
    }
    (void)traverse_from<Query::kOrdered>(nodes, next, stack, height, query.slabs, follows, query,
                                         NoStats{});
    query.finish(NoStats{});
}

/// The rest of trace_one for a ray that meets children of the root, `bits`. In a function of its
/// own, which takes lanes in registers: those that meet none need no stack.
template <std::size_t W, class Query>
HWY_NOINLINE bool trace_on(const WideBvhScene& scene, const Ray& ray, Hit* hit, std::uint32_t bits,
                           std::uint32_t octant, Lanes<float, W> entries, AxesTwice reciprocal,
                           AxesTwice near_offset, AxesTwice far_offset, Lanes<float, 2> range,
                           AxisLanes::F origin, AxisLanes::F direction, float reach) {
    const SlabLanes lanes{reciprocal, near_offset, far_offset, range, kNearRows[octant]};
    const NearbyRay nearby{origin, direction, reach};
    // Written so that NaN fails.
    const bool valid = ray.t_min <= ray.t_max;
    if constexpr (Query::kOrdered) {
        *hit = Hit{};
        if (HWY_UNLIKELY(!valid)) return false;
        trace_children<W, Query>(scene, ray, lanes, nearby, bits, entries, *hit);
        return hit->found();
    } else {
        if (HWY_UNLIKELY(!valid)) return false;
        bool occluded = false;
        trace_children<W, Query>(scene, ray, lanes, nearby, bits, entries, occluded);
        return occluded;
    }
}

/// Sets `hit`, of any value before, for closest hits, and returns whether anything is hit. Many
/// rays meet no child of the root: they need no query, and are not prepared for leaves.
template <std::size_t W, class Query>
HWY_INLINE bool trace_one(const WideBvhScene& scene, const Ray& ray, Hit* hit) {
    const WideBvhLayout& layout = *scene.layout;
    const NodeRef root = layout.tree.root;
    SlabLanes lanes;
    NearbyRay nearby;
    if (HWY_UNLIKELY(root.is_leaf()) ||
        HWY_UNLIKELY(
            !start_nearby(layout.frame, Query::slab_slack(layout.frame), ray, lanes, nearby))) {
        return trace_any<W, Query>(scene, ray, hit);
    }
    Lanes<float, W> entries;
    const std::uint32_t bits =
        bits_of(intersect_children(nodes_of<W>(layout.tree)[root.index()], lanes, entries));
    if (bits != 0) {
        // Variables of their own: as members, GCC gives them a place in memory.
        const AxesTwice reciprocal = lanes.reciprocal, near_offset = lanes.near_offset,
                        far_offset = lanes.far_offset;
        const Lanes<float, 2> range = lanes.range;
        const AxisLanes::F origin = nearby.origin, direction = nearby.direction;
        return trace_on<W, Query>(scene, ray, hit, bits, lanes.near.octant, entries, reciprocal,
                                  near_offset, far_offset, range, origin, direction, nearby.reach);
    }
    if constexpr (Query::kOrdered) *hit = Hit{};
    return false;
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
            return trace_one<W, Closest>(scene, ray, &hit);
        }
    }
    static bool occluded(const WideBvhScene& scene, const Ray& ray, TraversalStats* stats) {
        if constexpr (Stats::kCounts) {
            bool result = false;
            const bool follows = begins_near_last(scene.layout->frame, ray);
            Occluded query(scene, ray, result);
            run<W>(query, follows, policy(stats));
            return result;
        } else {
            return trace_one<W, Occluded>(scene, ray, nullptr);
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
                                                  policy(stats), otherwise, otherwise);
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
        const auto apart = [&](std::size_t first, std::size_t count) {
            occluded_batch(scene, rays.subspan(first, count), result.subspan(first, count), stats);
        };
        run_coherent<OccludedPacket, OccludedLanes>(scene, rays, result, OcclusionSink{result},
                                                    policy(stats), otherwise, apart);
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
        const auto apart = [&](std::size_t first, std::size_t count) {
            occluded_column_stream(scene, rays.part(first, count), result.subspan(first, count),
                                   stats);
        };
        run_lanes<OccludedLanes, !Stats::kCounts>(scene, GivenRays(rays), OcclusionSink{result},
                                                  policy(stats), otherwise, apart);
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
