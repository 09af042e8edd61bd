/// The queries of the wide BVH aggregate on the leaves: the filter on a block, then exact
/// resolution of the primitives that pass it.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The traversals of accel/wide_bvh
/// call these queries; every result is that of the scalar tests.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#endif

#include <hwy/cache_control.h>

#include <array>
#include <bit>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/batch_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/leaves/nearest_triangles-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/ray_records-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_tests-inl.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/shapes/core/first_hit.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A query of one ray. `Query`, the kind of query, derives from it (CRTP) and has
/// - `kOrdered`: children are visited nearest first, else in the order of the tree
/// - `kFirstOnly`: the first crossing with a shape suffices
/// - `bool triangles(block, found, stats)`: processes what the test finds in a block
/// - `bool shape(id, stats)`: tests any other primitive through the table
/// - `bool accept(id, hit)`: a primitive is hit
/// The functions return true to stop. `Test` is a triangle test (triangle_tests-inl.h).
template <class Query, class Test>
struct LeafQuery {
    static constexpr bool kExact = Test::kExact;

    SlabRay slabs;
    TriangleFilterRay filter;
    Ray ray;
    LocalParameter parameter;
    const WideBvhScene& scene;
    const TriangleBlock* blocks;  ///< null: leaves hold indices
    float s_max;
    bool valid;  ///< false: the ray cannot be traced

    HWY_INLINE LeafQuery(const WideBvhScene& s, const Ray& r)
        : ray(r), scene(s), blocks(s.layout->is_indexed() ? nullptr : s.layout->triangles.data()) {
        // From the caller's ray: loading lanes of the copy would stall until its stores complete.
        const LocalFrame& frame = s.layout->frame;
        valid =
            make_ray(frame, Test::slab_slack(frame), r, slabs, [&](const AxisLanes& axes) HWY_ATTR {
                make_triangle_filter_ray(slabs, axes, filter);
                parameter = axes.parameter;
            });
        s_max = slabs.s_max;
    }
    HWY_INLINE LeafQuery(const WideBvhScene& s, const PreparedRay& r)
        : slabs(r.record.slabs),
          filter(r.record.filter),
          ray(r.ray),
          parameter{s.layout->frame.scale, 0.0},
          scene(s),
          blocks(s.layout->is_indexed() ? nullptr : s.layout->triangles.data()),
          s_max(r.record.slabs.s_max),
          valid(true) {}

    /// Of a ray that is prepared for nodes. `prepare_leaves` does the rest.
    HWY_INLINE LeafQuery(const WideBvhScene& s, const Ray& r, const SlabLanes& prepared)
        : ray(r),
          parameter{s.layout->frame.scale, 0.0},
          scene(s),
          blocks(s.layout->is_indexed() ? nullptr : s.layout->triangles.data()),
          s_max(first_lane(spread<1, 2>(prepared.range))),
          valid(true) {
        store_slab_ray(prepared, slabs);
    }
    /// `r`: the caller's ray; loading lanes of the copy would stall until its stores complete.
    HWY_INLINE void prepare_leaves(const Ray& r, const NearbyRay& nearby) {
        AxisLanes axes;
        finish_nearby(scene.layout->frame, r, nearby, axes);
        make_triangle_filter_ray(slabs, axes, filter);
    }

    [[nodiscard]] static HWY_INLINE decltype(auto) slab_slack(const LocalFrame& frame) {
        return Test::slab_slack(frame);
    }

    /// Has the first block of a leaf of triangles come into the caches.
    HWY_INLINE void fetch(NodeRef ref) const {
        if (static_cast<LeafType>(ref.kind()) != LeafType::Triangles || blocks == nullptr) return;
        const auto* block = reinterpret_cast<const char*>(blocks + ref.offset());
        HWY_UNROLL(5)
        for (std::size_t i = 0; i < sizeof(TriangleBlock); i += 64) hwy::Prefetch(block + i);
    }
    template <class Stats>
    HWY_INLINE bool visit(NodeRef ref, Stats stats) {
        const std::uint32_t count = ref.count();
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles: {
                if (HWY_UNLIKELY(blocks == nullptr)) return visit_indices(ref, stats);
                const TriangleBlock* block = blocks + ref.offset();
                for (const TriangleBlock* end = block + count; block < end; ++block) {
                    stats.primitives(used_lanes(*block));
                    if (visit_block(*block, stats)) return true;
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
    /// As `visit`, for the first block of a leaf and several rays in turn: it is only filtered, and
    /// `settle` does the rest in a step of its own. Branches on the filter's result are then
    /// decided at once, where they would wait for it, and a wrong guess discards little work.
    template <class Stats>
    HWY_INLINE bool filter_block(NodeRef ref, Stats stats) {
        switch (static_cast<LeafType>(ref.kind())) {
            case LeafType::Triangles:
                return filter_triangle_block(ref, stats);
            case LeafType::Spheres:
                return filter_later(scene.layout->spheres[ref.offset()], stats);
            case LeafType::Frustums:
                return filter_later(scene.layout->frustums[ref.offset()], stats);
            case LeafType::Others:
                return filter_later(scene.layout->others[ref.offset()], stats);
        }
        return true;
    }
    /// Whether `filter_blocks` is faster than `filter_block` for each.
    static constexpr bool kPairs = Test::kExact && kPairsTriangles;
    /// As `filter_block` for two queries and a leaf each. False, without effect, if not both leaves
    /// hold blocks of triangles.
    template <class Stats>
    static HWY_INLINE bool filter_blocks(LeafQuery& a, NodeRef of_a, LeafQuery& b, NodeRef of_b,
                                         Stats stats) {
        const auto holds_triangles = [](NodeRef ref) {
            return static_cast<LeafType>(ref.kind()) == LeafType::Triangles;
        };
        if (HWY_UNLIKELY(!holds_triangles(of_a) || !holds_triangles(of_b) || a.blocks == nullptr)) {
            return false;
        }
        const TriangleBlock &x = a.blocks[of_a.offset()], &y = a.blocks[of_b.offset()];
        stats.primitives(used_lanes(x));
        stats.primitives(used_lanes(y));
        filter_two({x, a.filter, a.slabs.s_min, a.s_max, a.later_.triangles},
                   {y, b.filter, b.slabs.s_min, b.s_max, b.later_.triangles});
        a.later_.set(x);
        b.later_.set(y);
        return true;
    }
    template <class Stats>
    HWY_INLINE bool settle(Stats stats) {
        return later_.settle([&](const auto& block, const FilteredShapes& found, std::uint32_t rest)
                                 HWY_ATTR { return visit_found(block, found, rest, stats); },
                             [&](const TriangleBlock& block, const FilteredTriangles& found)
                                 HWY_ATTR {
                                     if constexpr (Test::kExact) {
                                         return query().triangles(block, found, stats);
                                     }
                                     return false;
                                 });
    }
    /// Whether `settle` has anything to do.
    [[nodiscard]] HWY_INLINE bool waits() const { return later_.waits(); }

    /// Computed only for the few tests that need it.
    [[nodiscard]] HWY_INLINE RayShear shear() const { return RayShear(ray.direction); }
    [[nodiscard]] HWY_INLINE std::uint32_t triangle(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - scene.table->first(kTriangleKind);
    }

    /// The exact test of a lane. Precondition: the lane is used.
    HWY_INLINE bool hits_triangle(const TriangleBlock& block, std::size_t lane,
                                  ShapeHit& hit) const {
        const Verdict verdict = decide_triangle(block, lane, hit);
        if (HWY_LIKELY(verdict != Verdict::Unsure)) return verdict == Verdict::Hit;
        return hits_triangle_scalar(block.ids[lane].id(), hit);
    }
    /// The same, but for cases in doubt.
    HWY_INLINE Verdict decide_triangle(const TriangleBlock& block, std::size_t lane,
                                       ShapeHit& hit) const {
        if (HWY_UNLIKELY(!block.ids[lane].exact())) return Verdict::Unsure;
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
        return resolve_triangle(ray, axis, corner, hit);
    }
    /// The exact test with the corners of the mesh, in all cases.
    HWY_NOINLINE bool hits_triangle_scalar(PrimitiveId id, ShapeHit& hit) const {
        const std::array<const Vec3*, 3> vertices = scene.table->corner_positions(triangle(id));
        const std::uint32_t axis[3] = {filter.kx, filter.ky, filter.kz};
        double corner[3][3];
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) corner[i][k] = (&vertices[i]->x)[axis[k]];
        }
        const Verdict verdict = resolve_triangle(ray, axis, corner, hit);
        if (HWY_LIKELY(verdict != Verdict::Unsure)) return verdict == Verdict::Hit;
        return intersect_triangle(ray, shear(), *vertices[0], *vertices[1], *vertices[2], hit);
    }

  protected:
    /// Tests the shapes that wait.
    template <class Stats>
    HWY_INLINE void finish_shapes(Stats stats) {
        (void)query().waiting.take_all(
            [&](const auto& block, std::uint32_t lane, std::uint32_t, float lo) HWY_ATTR {
                if (lo > s_max) {
                    stats.primitives(1);
                    return false;
                }
                return visit_lane(block, lane, stats);
            });
    }

  private:
    FilteredLater later_;

    HWY_INLINE Query& query() { return static_cast<Query&>(*this); }

    template <class Stats>
    HWY_INLINE bool visit_block(const TriangleBlock& block, Stats stats) {
        // The ray is out of the range of float (LocalRay::regular).
        if (!Test::kExact && HWY_UNLIKELY(parameter.scale == 0)) {
            return visit_block_in_double(block, stats);
        }
        typename Test::Found found;
        return Test::find(block, filter, slabs.s_min, s_max, found) &&
               query().triangles(block, found, stats);
    }
    template <class Stats>
    HWY_NOINLINE bool visit_block_in_double(const TriangleBlock& block, Stats stats) {
        const std::uint32_t used = used_lanes(block);
        for (std::size_t lane = 0; lane < used; ++lane) {
            const PrimitiveId id = block.ids[lane].id();
            ShapeHit hit;
            if (!scene.sees(id) || !hits_triangle_scalar(id, hit)) continue;
            stats.primitive_hits(1);
            if (query().accept(block.ids[lane], hit)) return true;
        }
        return false;
    }

    template <class Stats>
    HWY_INLINE bool filter_triangle_block(NodeRef ref, Stats stats) {
        if (HWY_UNLIKELY(blocks == nullptr)) return visit_index_block(ref, stats);
        const TriangleBlock& block = blocks[ref.offset()];
        stats.primitives(used_lanes(block));
        if constexpr (Test::kExact) {
            (void)filter_triangles<true>(block, filter, slabs.s_min, s_max, later_.triangles);
            later_.set(block);
            return false;
        } else {
            return visit_block(block, stats);
        }
    }
    /// Leaves what the filter finds to `settle`.
    template <class Block, class Stats>
    HWY_INLINE bool filter_later(const Block& block, Stats stats) {
        later_.set(block, filter_shapes<true>(block, later_.found, stats));
        return false;
    }
    template <class Block, class Stats>
    HWY_INLINE bool visit_shapes(const Block* block, std::uint32_t count, Stats stats) {
        for (const Block* end = block + count; block < end; ++block) {
            FilteredShapes found;
            const std::uint32_t rest = filter_shapes<false>(*block, found, stats);
            if (rest != 0 && visit_found(*block, found, rest, stats)) return true;
        }
        return false;
    }
    template <bool kAtOnce, class Block, class Stats>
    HWY_INLINE std::uint32_t filter_shapes(const Block& block, FilteredShapes& found, Stats stats) {
        const std::uint32_t rest =
            shape_candidates<kAtOnce>(block, filter, slabs.s_min, s_max, found);
        // The query counts the shapes that it tests.
        stats.primitives(filtered_out(block, rest));
        return rest;
    }
    /// What the filter of a block left.
    template <class Block, class Stats>
    HWY_INLINE bool visit_found(const Block& block, const FilteredShapes& found, std::uint32_t rest,
                                Stats stats) {
        if constexpr (Query::kFirstOnly) {
            if (query().take_sure(block, found, stats)) return true;
        }
        const std::uint32_t may_wait = Query::kFirstOnly ? block.may_be_sure() : 0;
        while (rest != 0) {
            auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if constexpr (Query::kOrdered) {
                // The nearest first: its hit may lie before the others.
                for (std::uint32_t others = rest & (rest - 1); others != 0; others &= others - 1) {
                    const auto other = static_cast<std::size_t>(std::countr_zero(others));
                    if (found.lo[other] < found.lo[lane]) lane = other;
                }
            }
            rest &= ~(1u << lane);
            const BlockId id = block.ids[lane];
            if (found.lo[lane] > s_max || !id.used()) {
                stats.primitives(1);
                continue;
            }
            if constexpr (Query::kFirstOnly) {
                // Those that are not sure and begin with the ray are mostly what it leaves.
                const bool waits = (found.sure >> lane & 1) != 0 || found.lo[lane] <= slabs.s_min;
                if (waits && (may_wait >> lane & 1) != 0 &&
                    query().waiting.add(block, lane, 1, found.lo[lane])) {
                    expect_shape(scene, block, lane);
                    continue;
                }
            }
            if (visit_lane(block, lane, stats)) return true;
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const SphereBlock& block, std::size_t lane, Stats stats) {
        return visit_sphere(block, lane, stats);
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const FrustumBlock& block, std::size_t lane, Stats stats) {
        if ((block.balls >> lane & 1) != 0) return visit_sphere(block, lane, stats);
        if constexpr (Query::kFirstOnly) {
            if ((block.certain >> lane & 1) != 0) {
                return visit_first<Cylinder>(block.ids[lane], stats);
            }
        }
        return query().shape(block.ids[lane], stats);
    }
    template <class Stats>
    HWY_INLINE bool visit_lane(const BoxBlock& block, std::size_t lane, Stats stats) {
        const BlockId id = block.ids[lane];
        if constexpr (Query::kFirstOnly) {
            if (is_bare<Polygon>(*scene.table, id.id())) return visit_first<Polygon>(id, stats);
        }
        return query().shape(id, stats);
    }

    /// The first crossing with a shape of a known kind without a placement. The kinds that most
    /// blocks hold are tested without the table's search for their column.
    template <class S, class Stats>
    HWY_NOINLINE bool visit_first(BlockId id, Stats stats) {
        if (!scene.sees(id.id())) return false;
        stats.primitives(1);
        ShapeHit hit;
        if (!find_first_hit(shape_of<S>(*scene.table, id.id()), ray, hit)) return false;
        stats.primitive_hits(1);
        return query().accept(id, hit);
    }

    /// The first crossing with a sphere, or both.
    template <class Block, class Stats>
    HWY_NOINLINE bool visit_sphere(const Block& block, std::size_t lane, Stats stats) {
        const BlockId id = block.ids[lane];
        if (!scene.sees(id.id())) return false;
        SphereCrossings met;
        const Verdict verdict = resolve_sphere(ray, sphere_of(scene, block, lane), met);
        if (HWY_UNLIKELY(verdict == Verdict::Unsure)) return query().shape(id, stats);
        stats.primitives(1);
        if (verdict == Verdict::Missed) return false;
        stats.primitive_hits(1);
        if (query().accept(id, {met.t[0], 0, 0, 0})) return true;
        return !Query::kFirstOnly && met.count == 2 && query().accept(id, {met.t[1], 0, 0, 0});
    }

    /// Indexed triangles are all tested in double, eight at a time.
    template <class Stats>
    HWY_NOINLINE bool visit_indices(NodeRef ref, Stats stats) {
        const IndexBlock* first = &scene.layout->indices[ref.offset()];
        for (std::uint32_t i = 0; i < ref.count(); ++i) {
            if (visit_indices(first[i], stats)) return true;
        }
        return false;
    }
    template <class Stats>
    HWY_NOINLINE bool visit_index_block(NodeRef ref, Stats stats) {
        return visit_indices(scene.layout->indices[ref.offset()], stats);
    }
    template <class Stats>
    HWY_INLINE bool visit_indices(const IndexBlock& block, Stats stats) {
        const std::uint32_t used = used_lanes(block);
        stats.primitives(used);
        TrianglePairs<> pairs{};
        for (std::size_t lane = 0; lane < used; ++lane) {
            const auto [a, b, c] = scene.table->triangle_vertices(triangle(block.ids[lane].id()));
            pairs.set(lane, ray, {a, b, c});
        }
        return pairs.resolve((1u << used) - 1, scene.layout->frame.inverse_scale,
                             [&](std::size_t lane, ShapeHit& hit) HWY_ATTR {
                                 return hits_triangle_scalar(block.ids[lane].id(), hit);
                             },
                             [&](std::size_t lane, const ShapeHit& hit) HWY_ATTR {
                                 const BlockId id = block.ids[lane];
                                 if (!scene.sees(id.id())) return false;
                                 stats.primitive_hits(1);
                                 return query().accept(id, hit);
                             });
    }
};

/// The closest hit. Each sure triangle lowers s_max. Other candidates wait: most of them are the
/// triangle that the ray leaves, which it misses.
template <class Test>
struct ClosestQuery : LeafQuery<ClosestQuery<Test>, Test> {
    using Base = LeafQuery<ClosestQuery<Test>, Test>;
    using Base::ray, Base::s_max, Base::scene, Base::parameter;
    static constexpr bool kOrdered = true;
    static constexpr bool kFirstOnly = true;

    Hit& best;
    RayCandidates candidates;
    WaitingShapes<8> waiting;

    /// `found` may hold an earlier hit.
    template <class GivenRay, class... Prepared>
    HWY_INLINE ClosestQuery(const WideBvhScene& s, const GivenRay& r, Hit& found,
                            const Prepared&... prepared)
        : Base(s, r, prepared...), best(found) {
        if (!best.found()) return;
        ray.t_max = best.t;
        shrink();
    }

    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const FilteredTriangles& found,
                              Stats stats) {
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            // Written so that NaN is a candidate.
            if (!block.ids[lane].used() || found.lo[lane] > s_max) continue;
            if (!scene.sees(block.ids[lane].id())) continue;
            while (HWY_UNLIKELY(!candidates.add(block, lane, found.lo[lane]))) {
                finish(stats);
                shrink();
            }
            if ((found.sure >> lane & 1) != 0 && found.hi[lane] < s_max) s_max = found.hi[lane];
        }
        return false;
    }
    /// As `visit`; lowers `limit`, which is s_max in every lane, as well.
    template <class Stats>
    HWY_INLINE void visit_within(NodeRef ref, Floats& limit, Stats stats) requires Test::kExact {
        if (HWY_UNLIKELY(static_cast<LeafType>(ref.kind()) != LeafType::Triangles ||
                         this->blocks == nullptr || !scene.sees_all())) {
            (void)this->visit(ref, stats);
            limit = Floats(s_max);
            return;
        }
        const TriangleBlock* block = this->blocks + ref.offset();
        for (const TriangleBlock* end = block + ref.count(); block < end; ++block) {
            stats.primitives(used_lanes(*block));
            visit_near(*block, limit, stats);
        }
    }
    /// The nearest of a block is the hit.
    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const FloatTriangles& found,
                              Stats stats) {
        HWY_ALIGN float s[kLaneCount], v[kLaneCount], w[kLaneCount], det[kLaneCount];
        store_lanes(found.s, s);
        std::size_t nearest = kLaneCount;
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (!block.ids[lane].used() || !(s[lane] <= s_max)) continue;
            if (!scene.sees(block.ids[lane].id())) continue;
            s_max = s[lane] + 0.0f;  // the stack compares bits: no -0
            nearest = lane;
        }
        if (nearest == kLaneCount) return false;
        stats.primitive_hits(1);
        store_lanes(found.ev, v);
        store_lanes(found.ew, w);
        store_lanes(found.det, det);
        best = Hit{};
        best.t = (static_cast<double>(s_max) + parameter.shift) / parameter.scale;
        best.u = static_cast<double>(v[nearest] / det[nearest]);
        best.v = static_cast<double>(w[nearest] / det[nearest]);
        best.primitive = block.ids[nearest].id();
        ray.t_max = best.t;
        return false;
    }
    /// Sure shapes limit the search, and wait.
    template <class Block, class Stats>
    HWY_INLINE bool take_sure(const Block& block, const FilteredShapes& found, Stats) {
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (found.hi[lane] < s_max && scene.sees(block.ids[lane].id())) s_max = found.hi[lane];
        }
        return false;
    }
    template <class Stats>
    HWY_INLINE bool shape(BlockId id, Stats stats) {
        const double last = ray.t_max;
        scene.table->closest(id.id(), ray, kUnusedShear, best, stats, scene.mask);
        // Most shapes are missed, and converting t to the float parameter is slow.
        if (ray.t_max != last) shrink();
        return false;
    }
    HWY_INLINE bool accept(BlockId id, const ShapeHit& hit) {
        offer_hit(hit, id.id(), ray, best);
        shrink();
        return false;
    }
    /// Resolves the candidates. s_max is that of the last but one hit.
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        this->finish_shapes(stats);
        candidates.take_all(s_max,
                            [&](const TriangleBlock& block, std::size_t lane, bool last) HWY_ATTR {
                                resolve(block, lane, stats);
                                if (!last) shrink();
                            });
    }
    /// As `finish`, in lanes together with candidates of other rays.
    template <class Stats>
    HWY_INLINE void finish_later(BatchResolution& resolution, Stats stats) {
        this->finish_shapes(stats);
        candidates.take_all(
            s_max, [&](const TriangleBlock& block, std::size_t lane, bool)
                       HWY_ATTR { resolution.add(ray, this->filter, best, block, lane, stats); });
    }

  private:
    template <class Stats>
    HWY_INLINE void visit_near(const TriangleBlock& block, Floats& limit, Stats stats) {
        NearTriangles found;
        find_near_triangles(block, this->filter, this->slabs.s_min, limit, found);
        if (found.candidates == 0) return;
        s_max = first_lane(limit);
        for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            // Written so that NaN is a candidate.
            if (!block.ids[lane].used() || found.lo[lane] > s_max) continue;
            while (HWY_UNLIKELY(!candidates.add(block, lane, found.lo[lane]))) {
                finish(stats);
                shrink();
                limit = Floats(s_max);
            }
        }
    }
    template <class Stats>
    HWY_NOINLINE void resolve(const TriangleBlock& block, std::size_t lane, Stats stats) {
        // Out of memory, as no address of it is taken.
        ShapeHit hit;
        const Verdict verdict = this->decide_triangle(block, lane, hit);
        if (HWY_UNLIKELY(verdict == Verdict::Unsure)) return resolve_scalar(block.ids[lane], stats);
        if (verdict == Verdict::Missed) return;
        stats.primitive_hits(1);
        offer_hit(hit, block.ids[lane].id(), ray, best);
    }
    template <class Stats>
    HWY_NOINLINE void resolve_scalar(BlockId id, Stats stats) {
        ShapeHit hit;
        if (!this->hits_triangle_scalar(id.id(), hit)) return;
        stats.primitive_hits(1);
        offer_hit(hit, id.id(), ray, best);
    }
    HWY_INLINE void shrink() {
        const float s = parameter.above(ray.t_max);
        if (s < s_max) s_max = s;
    }
};

/// True if there is any hit.
template <class Test>
struct OccludedQuery : LeafQuery<OccludedQuery<Test>, Test> {
    using Base = LeafQuery<OccludedQuery<Test>, Test>;
    using Base::ray, Base::scene;
    static constexpr bool kOrdered = false;
    static constexpr bool kFirstOnly = true;
    bool& occluded;
    WaitingShapes<8> waiting;
    const BoxBlock* sure_block = nullptr;  ///< of a flat shape that occludes the ray; or null
    std::size_t sure_lane = 0;

    template <class GivenRay, class... Prepared>
    HWY_INLINE OccludedQuery(const WideBvhScene& s, const GivenRay& r, bool& result,
                             const Prepared&... prepared)
        : Base(s, r, prepared...), occluded(result) {}

    template <class Stats>
    HWY_INLINE bool triangles(const TriangleBlock& block, const typename Test::Found& found,
                              Stats stats) {
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const BlockId id = block.ids[static_cast<std::size_t>(std::countr_zero(rest))];
            if (!id.used() || !scene.sees(id.id())) continue;
            stats.primitive_hits(1);
            return occluded = true;
        }
        if constexpr (Test::kExact) {
            for (std::uint32_t rest = found.candidates; rest != 0; rest &= rest - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
                ShapeHit hit;
                if (!block.ids[lane].used() || !scene.sees(block.ids[lane].id())) continue;
                if (!this->hits_triangle(block, lane, hit)) continue;
                stats.primitive_hits(1);
                return occluded = true;
            }
        }
        return false;
    }
    HWY_INLINE bool accept(BlockId, const ShapeHit&) { return occluded = true; }
    /// A sure shape is the answer.
    template <class Block, class Stats>
    HWY_INLINE bool take_sure(const Block& block, const FilteredShapes& found, Stats stats) {
        for (std::uint32_t rest = found.sure; rest != 0; rest &= rest - 1) {
            const BlockId id = block.ids[static_cast<std::size_t>(std::countr_zero(rest))];
            if (!id.used() || !scene.sees(id.id())) continue;
            stats.primitives(1);
            stats.primitive_hits(1);
            if constexpr (std::is_same_v<Block, BoxBlock>) {
                sure_block = &block;
                sure_lane = static_cast<std::size_t>(std::countr_zero(rest));
            }
            return occluded = true;
        }
        return false;
    }
    /// Whether a flat shape that occluded a ray of the batch before certainly does. `found`: what
    /// the filter of their block finds.
    template <class Stats>
    HWY_INLINE bool take_recent(RecentOccluders& recent, const FilteredShapes& found, Stats stats) {
        if (take_sure(recent.block(), found, stats)) {
            recent.keep(sure_lane);
            return true;
        }
        stats.primitives(used_lanes(recent.block()));
        return false;
    }
    template <class Stats>
    HWY_INLINE void finish(Stats stats) {
        if (!occluded) this->finish_shapes(stats);
    }
    template <class Stats>
    HWY_INLINE bool shape(BlockId id, Stats stats) {
        return occluded = scene.table->occluded(id.id(), ray, kUnusedShear, stats, scene.mask);
    }
};

/// All hits; with `stops_at_opaque`, those up to the first opaque one found.
struct CollectQuery : LeafQuery<CollectQuery, FilteredTriangleTest> {
    static constexpr bool kOrdered = false;
    static constexpr bool kFirstOnly = false;
    std::vector<Hit>& hits;
    bool stops_at_opaque;

    HWY_INLINE CollectQuery(const WideBvhScene& s, const Ray& r, std::vector<Hit>& found,
                            bool stops)
        : LeafQuery(s, r), hits(found), stops_at_opaque(stops) {}

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
            if (accept(id, hit)) return true;
        }
        return false;
    }
    HWY_INLINE bool accept(BlockId id, const ShapeHit& hit) {
        if (stops_at_opaque) {
            if (id.opaque()) return true;
            const auto effect = scene.table->shadow_effect(id.id(), ray);
            if (effect == PrimitiveTable::ShadowEffect::Blocks) return true;
            if (effect == PrimitiveTable::ShadowEffect::None) return false;
        }
        append_hit(hits, hit, id.id());
        return false;
    }
    template <class Stats>
    HWY_INLINE bool shape(BlockId id, Stats stats) {
        if (stops_at_opaque) {
            if (id.opaque()) {
                return scene.table->occluded(id.id(), ray, kUnusedShear, stats, scene.mask);
            }
            return scene.table->shadowed(id.id(), ray, kUnusedShear, hits, stats, scene.mask);
        }
        scene.table->all_hits(id.id(), ray, kUnusedShear, hits, stats, scene.mask);
        return false;
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
