/// Single-precision queries: faster, may err at edges.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, without
/// the fallback that makes it watertight at vertices. Boxes have no slack.
/// Conventions: included once per target (see simd/lanes-inl.h). Spheres and all other primitives
/// are tested in double. Parameters of hits carry the rounding of float.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_FAST_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_FAST_QUERIES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_FAST_QUERIES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_FAST_QUERIES_INL_H_
#endif

#include "alhazen/aggregates/wide_bvh/leaf_queries-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Edge functions and parameters of the triangles of a block, and bits of those that are hit.
struct FastTriangles {
    Floats eu, ev, ew, det, s;
    std::uint32_t hit;
};

HWY_INLINE FastTriangles test_triangles(const TriangleBlock& block, const TriangleFilterRay& ray,
                                        float s_min, float s_max) {
    const ShearedCorners v = sheared_corners(block, ray);
    FastTriangles r;
    r.eu = edge_of(v.corner[1], v.corner[2]);
    r.ev = edge_of(v.corner[2], v.corner[0]);
    r.ew = edge_of(v.corner[0], v.corner[1]);
    const Floats zero(0.0f);
    const Floats least = min_lanes(min_lanes(r.eu, r.ev), r.ew);
    const Floats most = max_lanes(max_lanes(r.eu, r.ev), r.ew);
    r.hit = bits_of((least >= zero) | (most <= zero));
    if (r.hit == 0) return r;
    r.det = r.eu + r.ev + r.ew;
    r.s = mul_add(r.eu, v.corner[0].z, mul_add(r.ev, v.corner[1].z, r.ew * v.corner[2].z)) *
          Floats(ray.sz) / r.det;
    // A NaN (a triangle seen edge on) is not a hit.
    r.hit &= bits_of((r.s >= Floats(s_min)) & (r.s <= Floats(s_max)));
    return r;
}

template <class Derived>
struct FastQuery : LeafQuery<Derived> {
    HWY_INLINE FastQuery(const WideBvhScene& s, const Ray& r) : LeafQuery<Derived>(s, r) {}

    static HWY_INLINE DistanceBound slab_slack(const LocalFrame&) { return {0.0f, 0.0f}; }

    /// The ray does not fit into float (LocalRay::regular): its triangles are tested in double.
    [[nodiscard]] HWY_INLINE bool is_beyond_float() const { return this->parameter.scale == 0; }
    template <class Stats>
    HWY_NOINLINE bool block_in_double(const TriangleBlock& triangles, Stats stats) {
        const std::uint32_t used = used_lanes(triangles);
        for (std::size_t lane = 0; lane < used; ++lane) {
            const BlockId id = triangles.ids[lane];
            if (!this->scene.sees(id.id())) continue;
            const auto [a, b, c] = this->scene.table->triangle_vertices(this->triangle(id.id()));
            ShapeHit hit;
            if (!intersect_triangle(this->ray, this->shear(), a, b, c, hit)) continue;
            stats.primitive_hits(1);
            if (static_cast<Derived&>(*this).crossing(id, hit)) return true;
        }
        return false;
    }
};

struct FastClosestQuery : FastQuery<FastClosestQuery> {
    static constexpr bool kOrdered = true;
    static constexpr bool kFirstCrossings = true;
    Hit& best;

    HWY_INLINE FastClosestQuery(const WideBvhScene& s, const Ray& r, Hit& found)
        : FastQuery(s, r), best(found) {
        if (!best.found()) return;
        ray.t_max = best.t;
        shrink();
    }

    template <class Stats>
    HWY_INLINE bool block(const TriangleBlock& triangles, Stats stats) {
        if (HWY_UNLIKELY(is_beyond_float())) return block_in_double(triangles, stats);
        const FastTriangles found = test_triangles(triangles, filter, slabs.s_min, s_max);
        std::uint32_t rest = found.hit;
        if (rest == 0) return false;
        HWY_ALIGN float s[kLaneCount], v[kLaneCount], w[kLaneCount], det[kLaneCount];
        store_lanes(found.s, s);
        std::size_t nearest = kLaneCount;
        for (; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (!triangles.ids[lane].used() || !(s[lane] <= s_max)) continue;
            if (!scene.sees(triangles.ids[lane].id())) continue;
            s_max = s[lane];
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
        best.primitive = triangles.ids[nearest].id();
        ray.t_max = best.t;
        return false;
    }
    HWY_INLINE bool crossing(BlockId id, const ShapeHit& hit) {
        offer(hit, id.id(), ray, best);
        shrink();
        return false;
    }
    template <class Stats>
    HWY_INLINE bool other(BlockId id, Stats stats) {
        scene.table->closest(id.id(), ray, this->shear(), best, stats, scene.mask);
        shrink();
        return false;
    }

  private:
    HWY_INLINE void shrink() {
        const float s = parameter.above(ray.t_max);
        if (s < s_max) s_max = s;
    }
};

struct FastOccludedQuery : FastQuery<FastOccludedQuery> {
    static constexpr bool kOrdered = false;
    static constexpr bool kFirstCrossings = true;
    bool& occluded;

    HWY_INLINE FastOccludedQuery(const WideBvhScene& s, const Ray& r, bool& result)
        : FastQuery(s, r), occluded(result) {}

    template <class Stats>
    HWY_INLINE bool block(const TriangleBlock& triangles, Stats stats) {
        if (HWY_UNLIKELY(is_beyond_float())) return block_in_double(triangles, stats);
        std::uint32_t rest = test_triangles(triangles, filter, slabs.s_min, s_max).hit;
        for (; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            if (!triangles.ids[lane].used() || !scene.sees(triangles.ids[lane].id())) continue;
            stats.primitive_hits(1);
            return occluded = true;
        }
        return false;
    }
    HWY_INLINE bool crossing(BlockId, const ShapeHit&) { return occluded = true; }
    template <class Stats>
    HWY_INLINE bool other(BlockId id, Stats stats) {
        return occluded = scene.table->occluded(id.id(), ray, this->shear(), stats, scene.mask);
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
