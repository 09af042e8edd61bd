/// The queries of the wide BVH aggregate on the leaves: the filter on a block, then exact
/// resolution of the primitives that pass.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The traversals of accel/wide_bvh
/// take these queries; every result is that of the scalar tests.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#endif

#include <bit>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"
#include "alhazen/aggregates/wide_bvh/sphere_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/triangle_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/primitives/unused_shear.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The common part of queries on one ray. `Derived` offers
/// `bool block(triangle_block, stats)`, `bool other(id, stats)` and `bool crossing(id, hit)`, for a
/// primitive that is hit, true to stop; `DistanceBound slab_slack(frame)`, the slack of
/// its slab test; and `kFirstCrossings`: the first crossing with a shape suffices.
template <class Derived>
struct LeafQuery {
    SlabRay slabs;
    TriangleFilterRay filter;
    Ray ray;
    const Ray* source;  ///< the caller's
    LocalParameter parameter;
    const WideBvhScene& scene;
    float s_max;
    bool valid;  ///< false: the ray cannot be traced

    HWY_INLINE LeafQuery(const WideBvhScene& s, const Ray& r) : ray(r), source(&r), scene(s) {
        // From the caller's ray: loading lanes of the copy would stall until its stores complete.
        const LocalFrame& frame = s.layout->frame;
        valid = make_ray(frame, Derived::slab_slack(frame), r, slabs,
                         [&](const LocalRay& local) HWY_ATTR {
                             make_triangle_filter_ray(slabs, local, filter);
                             parameter = local.parameter;
                         });
        s_max = slabs.s_max;
    }

    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, Stats stats) {
        Derived& query = static_cast<Derived&>(*this);
        const std::uint32_t count = ref.count();
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles: {
                if (HWY_UNLIKELY(scene.layout->is_indexed())) return visit_indices(ref, stats);
                const TriangleBlock* blocks = &scene.layout->triangles[ref.offset()];
                for (std::uint32_t i = 0; i < count; ++i) {
                    stats.primitives(used_lanes(blocks[i]));
                    if (query.block(blocks[i], stats)) return true;
                }
                return false;
            }
            case LeafType::Spheres:
                return visit_shapes(&scene.layout->spheres[ref.offset()], count, stats);
            case LeafType::Frustums:
                return visit_shapes(&scene.layout->frustums[ref.offset()], count, stats);
            case LeafType::Others:
                return visit_shapes(&scene.layout->others[ref.offset()], count, stats);
        }
        return true;
    }

    /// Computed for the few tests that need it.
    [[nodiscard]] HWY_INLINE RayShear shear() const { return RayShear(ray.direction); }
    [[nodiscard]] HWY_INLINE std::uint32_t triangle(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - scene.table->first(kTriangleKind);
    }

  private:
    template <class Block, class Stats>
    HWY_INLINE bool visit_shapes(const Block* blocks, std::uint32_t count, Stats stats) {
        for (const Block* end = blocks + count; blocks < end; ++blocks) {
            FilteredShapes found;
            std::uint32_t rest = shape_candidates(*blocks, filter, slabs.s_min, s_max, found);
            // The query counts those that it tests.
            stats.primitives(used_lanes(*blocks) - static_cast<std::uint32_t>(std::popcount(rest)));
            for (; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                const BlockId id = blocks->ids[lane];
                if (found.lo[lane] > s_max || !id.used()) {
                    stats.primitives(1);
                    continue;
                }
                if constexpr (std::is_same_v<Block, SphereBlock>) {
                    if (visit_sphere(id, stats)) return true;
                } else {
                    if (static_cast<Derived&>(*this).other(id, stats)) return true;
                }
            }
        }
        return false;
    }

    /// Most queries need only the first crossing with a sphere.
    template <class Stats>
    HWY_NOINLINE bool visit_sphere(BlockId id, Stats stats) {
        Derived& query = static_cast<Derived&>(*this);
        if constexpr (!Derived::kFirstCrossings) return query.other(id, stats);
        if (!scene.sees(id.id())) return false;
        const auto& spheres = std::get<ShapeColumn<Sphere>>(scene.table->columns).shapes;
        ShapeHit hit;
        const std::uint32_t place =
            static_cast<std::uint32_t>(id.id()) - scene.table->first(column_of<Sphere>());
        const PlainVerdict verdict = intersect_plain(ray, spheres[place], hit);
        if (HWY_UNLIKELY(verdict == PlainVerdict::Unsure)) return query.other(id, stats);
        stats.primitives(1);
        if (verdict == PlainVerdict::Missed) return false;
        stats.primitive_hits(1);
        return query.crossing(id, hit);
    }

    /// Indexed triangles: all are tested in double, eight at a time.
    template <class Stats>
    HWY_NOINLINE bool visit_indices(NodeRef ref, Stats stats) {
        const IndexBlock* blocks = &scene.layout->indices[ref.offset()];
        for (std::uint32_t i = 0; i < ref.count(); ++i) {
            if (visit_indices(blocks[i], stats)) return true;
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool visit_indices(const IndexBlock& block, Stats stats) {
        const std::uint32_t used = used_lanes(block);
        stats.primitives(used);
        TrianglePairs pairs{};
        for (std::size_t lane = 0; lane < used; ++lane) {
            const auto [a, b, c] = scene.table->triangle_vertices(triangle(block.ids[lane].id()));
            pairs.set(lane, ray, {a, b, c});
        }
        const TrianglePairs::Verdict verdict = pairs.resolve();
        for (std::uint32_t rest = (verdict.hit | verdict.unsure) & ((1u << used) - 1); rest != 0;
             rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const BlockId id = block.ids[lane];
            if (!scene.sees(id.id())) continue;
            ShapeHit hit = pairs.hit(lane);
            if ((verdict.unsure >> lane & 1) != 0) {
                const auto [a, b, c] = scene.table->triangle_vertices(triangle(id.id()));
                if (!intersect_triangle(ray, shear(), a, b, c, hit)) continue;
            }
            stats.primitive_hits(1);
            if (static_cast<Derived&>(*this).crossing(id, hit)) return true;
        }
        return false;
    }
};

/// Queries with exact hits: the filter, then exact resolution. `Derived` offers `bool
/// triangles(block, found, stats)`.
template <class Derived>
struct RobustQuery : LeafQuery<Derived> {
    using Base = LeafQuery<Derived>;
    using Base::filter, Base::ray, Base::s_max, Base::scene, Base::slabs;

    HWY_INLINE RobustQuery(const WideBvhScene& s, const Ray& r) : Base(s, r) {}

    static HWY_INLINE const DistanceBound& slab_slack(const LocalFrame& frame) {
        return frame.slack.slab;
    }
    template <class Stats>
    HWY_INLINE bool block(const TriangleBlock& triangles, Stats stats) {
        FilteredTriangles found;
        return filter_triangles(triangles, filter, slabs.s_min, s_max, found) &&
               static_cast<Derived&>(*this).triangles(triangles, found, stats);
    }
    /// The test in double of a lane in use.
    HWY_INLINE bool hits_triangle(const TriangleBlock& block, std::size_t lane,
                                  ShapeHit& hit) const {
        const BlockId id = block.ids[lane];
        if (HWY_LIKELY(id.exact())) {
            const LocalFrame& frame = scene.layout->frame;
            const std::uint32_t axis[3] = {filter.kx, filter.ky, filter.kz};
            double corner[3][3];
            HWY_UNROLL(3)
            for (std::size_t k = 0; k < 3; ++k) {
                const double center = (&frame.center.x)[axis[k]];
                for (std::size_t i = 0; i < 3; ++i) {
                    const auto x = static_cast<double>(block.vertex[i][axis[k]][lane]);
                    corner[i][k] = frame.inverse_scale * x + center;
                }
            }
            const PlainVerdict verdict = intersect_plain(ray, axis, corner, hit);
            if (HWY_LIKELY(verdict != PlainVerdict::Unsure)) return verdict == PlainVerdict::Hit;
        }
        return hits_triangle_scalar(id, hit);
    }

  private:
    HWY_NOINLINE bool hits_triangle_scalar(BlockId id, ShapeHit& hit) const {
        const auto [a, b, c] = scene.table->triangle_vertices(this->triangle(id.id()));
        return intersect_triangle(ray, this->shear(), a, b, c, hit);
    }
};

/// The closest hit. Triangles that pass the filter go to a candidate queue; each sure one ends the
/// search behind it; exact resolution of the few that remain follows at the end. Triangles in doubt
/// are mostly the one that the ray leaves, which is missed: not worth an interruption.
struct ClosestQuery : RobustQuery<ClosestQuery> {
    static constexpr bool kOrdered = true;
    static constexpr bool kFirstCrossings = true;
    static constexpr std::uint32_t kMaxCandidates = 8;

    Hit& best;
    std::uint32_t candidate_count = 0;
    struct {
        const TriangleBlock* block;
        std::uint32_t lane;
        float lo;
        [[nodiscard]] BlockId id() const { return block->ids[lane]; }
    } candidates[kMaxCandidates];

    /// `found` may hold an earlier hit.
    HWY_INLINE ClosestQuery(const WideBvhScene& s, const Ray& r, Hit& found)
        : RobustQuery(s, r), best(found) {
        if (!best.found()) return;
        ray.t_max = best.t;
        shrink();
    }

    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const FilteredTriangles& found,
                              Stats stats) {
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
            // Written so that a NaN is not passed over.
            if (!block.ids[lane].used() || found.lo[lane] > s_max) continue;
            if (!scene.sees(block.ids[lane].id())) continue;
            if (candidate_count == kMaxCandidates) finish(stats);
            candidates[candidate_count++] = {&block, lane, found.lo[lane]};
            if ((found.sure >> lane & 1) != 0 && found.hi[lane] < s_max) s_max = found.hi[lane];
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool other(BlockId id, Stats stats) {
        const double last = ray.t_max;
        scene.table->closest(id.id(), ray, kUnusedShear, best, stats, scene.mask);
        // Most are missed, and converting t to the float parameter is slow.
        if (ray.t_max != last) shrink();
        return false;
    }
    HWY_INLINE bool crossing(BlockId id, const ShapeHit& hit) {
        offer(hit, id.id(), ray, best);
        shrink();
        return false;
    }
    /// Resolves the candidates.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        for (std::uint32_t i = 0; i < candidate_count; ++i) {
            if (candidates[i].lo > s_max) continue;
            resolve(*candidates[i].block, candidates[i].lane, stats);
        }
        candidate_count = 0;
    }
    /// As `finish`, in lanes with candidates of other rays.
    template <class Stats>
    HWY_INLINE void finish_later(TriangleResolution& resolution, Stats stats) {
        for (std::uint32_t i = 0; i < candidate_count; ++i) {
            if (candidates[i].lo > s_max) continue;
            resolution.add(*source, best, *candidates[i].block, candidates[i].lane, stats);
        }
    }

  private:
    /// Exact resolution.
    template <class Stats>
    HWY_NOINLINE void resolve(const TriangleBlock& block, std::size_t lane, Stats stats) {
        ShapeHit hit;
        if (!this->hits_triangle(block, lane, hit)) return;
        stats.primitive_hits(1);
        crossing(block.ids[lane], hit);
    }
    HWY_INLINE void shrink() {
        const float s = parameter.above(ray.t_max);
        if (s < s_max) s_max = s;
    }
};

/// Whether there is any hit.
struct OccludedQuery : RobustQuery<OccludedQuery> {
    static constexpr bool kOrdered = false;
    static constexpr bool kFirstCrossings = true;
    bool& occluded;

    HWY_INLINE OccludedQuery(const WideBvhScene& s, const Ray& r, bool& result)
        : RobustQuery(s, r), occluded(result) {}

    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const FilteredTriangles& found,
                              Stats stats) {
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const BlockId id = block.ids[static_cast<std::size_t>(std::countr_zero(rest))];
            if (!id.used() || !scene.sees(id.id())) continue;
            stats.primitive_hits(1);
            return occluded = true;
        }
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            ShapeHit hit;
            if (!block.ids[lane].used() || !scene.sees(block.ids[lane].id())) continue;
            if (!this->hits_triangle(block, lane, hit)) continue;
            stats.primitive_hits(1);
            return occluded = true;
        }
        return false;
    }
    HWY_INLINE bool crossing(BlockId, const ShapeHit&) { return occluded = true; }
    template <class Stats>
    HWY_INLINE bool other(BlockId id, Stats stats) {
        return occluded = scene.table->occluded(id.id(), ray, kUnusedShear, stats, scene.mask);
    }
};

/// All hits; with `kStopAtOpaque` up to the first opaque one.
template <bool kStopAtOpaque>
struct CollectQuery : RobustQuery<CollectQuery<kStopAtOpaque>> {
    using Base = RobustQuery<CollectQuery<kStopAtOpaque>>;
    using Base::ray, Base::scene, Base::shear;
    static constexpr bool kOrdered = false;
    static constexpr bool kFirstCrossings = false;
    std::vector<Hit>& hits;

    HWY_INLINE CollectQuery(const WideBvhScene& s, const Ray& r, std::vector<Hit>& found)
        : Base(s, r), hits(found) {}

    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const FilteredTriangles& found,
                              Stats stats) {
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const BlockId id = block.ids[lane];
            ShapeHit hit;
            if (!id.used() || !scene.sees(id.id())) continue;
            if (!this->hits_triangle(block, lane, hit)) continue;
            stats.primitive_hits(1);
            if (crossing(id, hit)) return true;
        }
        return false;
    }
    HWY_INLINE bool crossing(BlockId id, const ShapeHit& hit) {
        if (kStopAtOpaque) {
            if (id.opaque()) return true;
            const auto effect = scene.table->shadow_effect(id.id(), ray);
            if (effect == PrimitiveTable::ShadowEffect::Blocks) return true;
            if (effect == PrimitiveTable::ShadowEffect::None) return false;
        }
        append_hit(hits, hit, id.id());
        return false;
    }
    template <class Stats>
    HWY_INLINE bool other(BlockId id, Stats stats) {
        if (kStopAtOpaque && id.opaque()) {
            return scene.table->occluded(id.id(), ray, this->shear(), stats, scene.mask);
        }
        if (kStopAtOpaque)
            return scene.table->shadowed(id.id(), ray, this->shear(), hits, stats, scene.mask);
        scene.table->all_hits(id.id(), ray, this->shear(), hits, stats, scene.mask);
        return false;
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
