/// A single ray of a lane packet, prepared for nodes and leaves from the packet's rows.
///
/// Source: slab_ray.h, triangle_filter.h and shape_filters.h, whose bounds apply; errors that
/// depend on the ray are those of the farthest ray of the packet.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LONE_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LONE_RAY_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LONE_RAY_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LONE_RAY_INL_H_
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The i-th ray of a packet, for filters.
HWY_INLINE void make_lone_filter_ray(const LanePacket& packet, std::size_t i,
                                     TriangleFilterRay& filter) {
    filter.kx = packet.kx;
    filter.ky = packet.ky;
    filter.kz = packet.kz;
    filter.origin[0] = packet.origin[packet.kx][i];
    filter.origin[1] = packet.origin[packet.ky][i];
    filter.origin[2] = packet.origin[packet.kz][i];
    filter.sx = packet.slope[0][i];
    filter.sy = packet.slope[1][i];
    filter.sz = packet.reciprocal[packet.kz][i];
    filter.edge_slack = packet.edge_slack;
    filter.edge_slack_min = packet.edge_slack_min;
    filter.near_error = packet.near_error;
    filter.s_slack = packet.place_error * std::abs(filter.sz);
    filter.sure_min = packet.sure_min[i];
    filter.sure_max = packet.sure_max[i];
}

/// The query that `traverse` takes. `Leaves` has `triangles(lane, block number, found, s_max,
/// stats)`, `sphere(lane, id, sphere, s_max, stats)`, `first_of(lane, id, shape, s_max, stats)` for
/// shapes of a known kind without a placement, for all other primitives `shape(lane, id, s_max,
/// stats)`, and `sure(lane, hi, s_max, stats)` for a shape that is certainly hit up to `hi`.
/// These may lower `s_max`, and return true to stop.
template <class Leaves>
struct LoneRay {
    SlabRay slabs;
    TriangleFilterRay filter;
    const WideBvhScene& scene;
    Leaves& leaves;
    std::size_t lane;
    float s_max;

    /// Precondition: the packet's set is that of the ray.
    HWY_INLINE LoneRay(const WideBvhScene& s, const LanePacket& packet, std::size_t i, Leaves& l)
        : scene(s), leaves(l), lane(i), s_max(packet.s_max[i]) {
        std::size_t octant = 0;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            slabs.reciprocal[k] = packet.reciprocal[k][i];
            slabs.near_offset[k] = packet.near_offset[k][i];
            slabs.far_offset[k] = packet.far_offset[k][i];
            octant |= std::size_t{packet.near_row[k] != k} << k;
        }
        slabs.s_min = packet.s_min[i];
        slabs.s_max = s_max;
        slabs.near = kNearRows[octant];
        make_lone_filter_ray(packet, i, filter);
    }

    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, Stats stats) {
        const std::uint32_t count = ref.count();
        const WideBvhLayout& layout = *scene.layout;
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                for (std::uint32_t i = 0; i < count; ++i) {
                    if (visit_block(ref.offset() + i, stats)) return true;
                }
                return false;
            case LeafType::Spheres:
                return visit_shapes(&layout.spheres[ref.offset()], count, stats);
            case LeafType::Frustums:
                return visit_shapes(&layout.frustums[ref.offset()], count, stats);
            case LeafType::Others:
                return visit_shapes(&layout.others[ref.offset()], count, stats);
        }
        return true;
    }

    /// Tests the shapes that wait; after the traversal, unless that was stopped.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        (void)waiting.take_all([&](const auto& block, std::uint32_t i, std::uint32_t, float lo)
                                   HWY_ATTR {
                                       if (lo > s_max) {
                                           stats.primitives(1);
                                           return false;
                                       }
                                       return visit_lane(block, i, stats);
                                   });
    }

    /// A block of triangles.
    template <class Stats>
    HWY_INLINE bool visit_block(std::uint32_t number, Stats stats) {
        const TriangleBlock& block = scene.layout->triangles[number];
        stats.primitives(used_lanes(block));
        FilteredTriangles found;
        return filter_triangles(block, filter, slabs.s_min, s_max, found) &&
               leaves.triangles(lane, number, found, s_max, stats);
    }

  private:
    template <class Block, class Stats>
    HWY_INLINE bool visit_shapes(const Block* blocks, std::uint32_t count, Stats stats) {
        for (const Block* end = blocks + count; blocks < end; ++blocks) {
            FilteredShapes found;
            const std::uint32_t rest =
                shape_candidates<false>(*blocks, filter, slabs.s_min, s_max, found);
            // The shapes that are tested are counted there.
            stats.primitives(filtered_out(*blocks, rest));
            if (rest != 0 && visit_found(*blocks, found, rest, stats)) return true;
        }
        return false;
    }
    template <class Block, class Stats>
    HWY_INLINE bool visit_found(const Block& block, const FilteredShapes& found, std::uint32_t rest,
                                Stats stats) {
        for (std::uint32_t sure = found.sure; sure != 0; sure &= sure - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(sure));
            if (!block.ids[i].used() || !scene.sees(block.ids[i].id())) continue;
            if (leaves.sure(lane, found.hi[i], s_max, stats)) return true;
        }
        const std::uint32_t may_wait = block.may_be_sure();
        for (; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            if (found.lo[i] > s_max || !block.ids[i].used()) {
                stats.primitives(1);
                continue;
            }
            // As in LeafQuery.
            const bool waits = (found.sure >> i & 1) != 0 || found.lo[i] <= slabs.s_min;
            if (waits && (may_wait >> i & 1) != 0 && waiting.add(block, i, 1, found.lo[i])) {
                expect_shape(scene, block, i);
                continue;
            }
            if (visit_lane(block, i, stats)) return true;
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const SphereBlock& block, std::size_t i, Stats stats) {
        const PrimitiveId id = block.ids[i].id();
        return scene.sees(id) && leaves.sphere(lane, id, sphere_of(scene, block, i), s_max, stats);
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const FrustumBlock& block, std::size_t i, Stats stats) {
        const PrimitiveId id = block.ids[i].id();
        if ((block.balls >> i & 1) != 0) {
            return scene.sees(id) &&
                   leaves.sphere(lane, id, sphere_of(scene, block, i), s_max, stats);
        }
        if ((block.certain >> i & 1) != 0) return visit_first<Cylinder>(id, stats);
        return leaves.shape(lane, id, s_max, stats);
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const BoxBlock& block, std::size_t i, Stats stats) {
        const PrimitiveId id = block.ids[i].id();
        if (is_bare<Polygon>(*scene.table, id)) return visit_first<Polygon>(id, stats);
        return leaves.shape(lane, id, s_max, stats);
    }
    template <class S, class Stats>
    HWY_INLINE bool visit_first(PrimitiveId id, Stats stats) {
        return scene.sees(id) &&
               leaves.first_of(lane, id, shape_of<S>(*scene.table, id), s_max, stats);
    }

    WaitingShapes<8> waiting;
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
