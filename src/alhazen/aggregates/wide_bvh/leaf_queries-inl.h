/// The queries of one ray: the closest hit, any hit, all hits.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAF_QUERIES_INL_H_
#endif

#include <bit>
#include <type_traits>

#include "alhazen/aggregates/wide_bvh/batch_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/candidate_queue-inl.h"
#include "alhazen/aggregates/wide_bvh/leaf_query-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/nearest_triangles-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"
#include "alhazen/primitives/unused_shear.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

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
