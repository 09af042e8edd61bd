/// Exact resolution of the candidates of a batch, eight pairs of a ray and a triangle at a time, or
/// sixteen.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_BATCH_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_BATCH_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_BATCH_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_BATCH_RESOLUTION_INL_H_
#endif

#include <hwy/cache_control.h>

#include "alhazen/aggregates/wide_bvh/exact_resolution-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Collects pairs of a ray and a triangle, and offers hits to the best hit of the ray. Vertices
/// that the block does not hold exactly are fetched from the mesh in two steps, eight triangles at
/// a time.
class BatchResolution {
  public:
    HWY_INLINE explicit BatchResolution(const WideBvhScene& scene) : scene_(scene) {}

    /// `filter` is that of the ray.
    template <class Stats>
    HWY_INLINE void add(const Ray& ray, const TriangleFilterRay& filter, Hit& best,
                        const TriangleBlock& block, std::size_t lane, Stats stats) {
        const BlockId id = block.ids[lane];
        if (HWY_LIKELY(id.exact())) {
            pairs_.set(count_, ray, {filter.kx, filter.ky, filter.kz}, scene_.layout->frame, block,
                       lane);
            pair_[count_].set(ray, best, id.id());
            return added(stats);
        }
        hwy::Prefetch(scene_.table->triangle_corners(triangle(id.id())));
        fetching_[fetching_count_++].set(ray, best, id.id());
        if (fetching_count_ == kLaneCount) fetch(stats);
    }
    /// Resolves the pairs added so far.
    template <class Stats>
    HWY_NOINLINE void flush(Stats stats) {
        fetch(stats);
        fetch(stats);
        if (count_ > 0) resolve(stats);
    }

  private:
    /// Sixteen where a register holds eight doubles.
    static constexpr std::size_t kPairs = kParts<double, 16> == 2 ? 16 : kLaneCount;

    struct Pair {
        Ray ray;
        Hit* best;
        PrimitiveId id;

        // Member by member: a copy of the whole would wait for the stores that built it.
        HWY_INLINE void set(const Ray& r, Hit& hit, PrimitiveId triangle) {
            ray = r;
            best = &hit;
            id = triangle;
        }
    };

    [[nodiscard]] HWY_INLINE std::uint32_t triangle(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - scene_.table->first(kTriangleKind);
    }

    /// Adds the triangles whose vertices have been prefetched, and prefetches the next ones.
    template <class Stats>
    HWY_NOINLINE void fetch(Stats stats) {
        for (std::size_t i = 0; i < fetched_count_; ++i) {
            const auto [a, b, c] = scene_.table->triangle_vertices(triangle(fetched_[i].id));
            pairs_.set(count_, fetched_[i].ray, {a, b, c});
            pair_[count_] = fetched_[i];
            added(stats);
        }
        for (std::size_t i = 0; i < fetching_count_; ++i) {
            fetched_[i] = fetching_[i];
            for (const Vec3* corner : scene_.table->corner_positions(triangle(fetching_[i].id))) {
                hwy::Prefetch(corner);
                hwy::Prefetch(&corner->z);
            }
        }
        fetched_count_ = fetching_count_;
        fetching_count_ = 0;
    }

    /// The lane of `count_` and its pair have been set.
    template <class Stats>
    HWY_INLINE void added(Stats stats) {
        if (++count_ == kPairs) resolve(stats);
    }

    template <class Stats>
    HWY_NOINLINE void resolve(Stats stats) {
        // Lanes beyond the count hold earlier pairs or zeros.
        pairs_.resolve((1u << count_) - 1, scene_.layout->frame.inverse_scale,
                       [&](std::size_t lane, ShapeHit& hit)
                           HWY_ATTR { return resolve_scalar(pair_[lane], hit); },
                       [&](std::size_t lane, const ShapeHit& hit) HWY_ATTR {
                           stats.primitive_hits(1);
                           Pair& pair = pair_[lane];
                           offer_hit(hit, pair.id, pair.ray, *pair.best);
                           return false;
                       });
        count_ = 0;
    }
    HWY_NOINLINE bool resolve_scalar(const Pair& pair, ShapeHit& hit) const {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(pair.id));
        return intersect_triangle(pair.ray, RayShear(pair.ray.direction), a, b, c, hit);
    }

    const WideBvhScene& scene_;
    std::size_t count_ = 0, fetching_count_ = 0, fetched_count_ = 0;
    TrianglePairs<kPairs> pairs_{};
    Pair pair_[kPairs], fetching_[kLaneCount], fetched_[kLaneCount];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
