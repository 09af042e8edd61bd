/// Exact resolution of the triangles that pass the filter, in double, eight rays at a time.
///
/// Formulas and their order are those of geometry/watertight_triangle.h: lanes give the bits of the
/// scalar test. Lanes in doubt (a zero among the edge functions, a triangle seen nearly edge on)
/// are left to the scalar test. Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_RESOLUTION_INL_H_
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace triangle_lanes {

#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

}  // namespace triangle_lanes

enum class PlainVerdict { Missed, Hit, Unsure };

/// `intersect_triangle` for one ray, except for the cases in doubt, without a call into code for
/// another instruction set. `axis` is the order of axes of RayShear for a direction whose largest
/// component is the third of them and no other; corners are [corner][axis in that order].
HWY_INLINE PlainVerdict intersect_plain(const Ray& ray, const std::uint32_t (&axis)[3],
                                        const double (&corner)[3][3], ShapeHit& hit) {
    using triangle_lanes::edge_function;
    const auto at = [&](const Vec3& v, std::size_t k) { return (&v.x)[axis[k]]; };
    const double dx = at(ray.direction, 0), dy = at(ray.direction, 1), dz = at(ray.direction, 2);
    if (!(std::abs(dz) > std::abs(dx) && std::abs(dz) > std::abs(dy))) return PlainVerdict::Unsure;
    const double ox = at(ray.origin, 0), oy = at(ray.origin, 1), oz = at(ray.origin, 2);
    const double sx = dx / dz, sy = dy / dz, sz = 1.0 / dz;
    triangle_lanes::ShearedVertex<double> p[3];
    double reach = 0;
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = triangle_lanes::sheared<double>(corner[i][0], corner[i][1], corner[i][2], ox, oy, oz,
                                               sx, sy);
        reach = std::max(reach, std::max(std::abs(p[i].x), std::abs(p[i].y)));
    }
    const double eu = edge_function(p[1], p[2]);
    const double ev = edge_function(p[2], p[0]);
    const double ew = edge_function(p[0], p[1]);
    const double least = std::min(std::min(eu, ev), ew), most = std::max(std::max(eu, ev), ew);
    // Written so that a NaN and a zero are not plain.
    if (!(least > 0.0 || most < 0.0)) {
        return least < 0.0 && most > 0.0 ? PlainVerdict::Missed : PlainVerdict::Unsure;
    }
    if (!(std::abs(eu + ev + ew) > 0x1p-8 * reach * reach)) return PlainVerdict::Unsure;
    const auto s = triangle_lanes::solve_triangle(eu, ev, ew, p[0].z, p[1].z, p[2].z, sz);
    if (!ray.covers(s.t)) return PlainVerdict::Missed;
    hit = {s.t, s.u, s.v, 0};
    return PlainVerdict::Hit;
}

/// Eight rays, each with a triangle of its own; [..][lane].
struct TrianglePairs {
    alignas(64) double vertex[3][3][kLaneCount];  ///< [corner][axis], axes as in RayShear
    alignas(64) double origin[3][kLaneCount], direction[3][kLaneCount];
    alignas(64) double t_min[kLaneCount], t_max[kLaneCount];
    alignas(64) double t[kLaneCount], u[kLaneCount], v[kLaneCount];  ///< results

    HWY_INLINE void set(std::size_t lane, const Ray& ray, const Vec3 (&corners)[3]) {
        const int kz = dominant_axis(ray.direction);
        const int axis[3] = {kz == 2 ? 0 : kz + 1, kz == 0 ? 2 : kz - 1, kz};
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            origin[k][lane] = ray.origin[axis[k]];
            direction[k][lane] = ray.direction[axis[k]];
            for (std::size_t i = 0; i < 3; ++i) vertex[i][k][lane] = corners[i][axis[k]];
        }
        t_min[lane] = ray.t_min;
        t_max[lane] = ray.t_max;
    }

    [[nodiscard]] ShapeHit hit(std::size_t lane) const { return {t[lane], u[lane], v[lane], 0}; }

    struct Verdict {
        std::uint32_t hit, unsure;
    };
    /// Tests all lanes.
    HWY_INLINE Verdict resolve() {
        using triangle_lanes::edge_function;
        using D = Doubles;
        const D dz = load_lanes(direction[2]);
        const D sx = load_lanes(direction[0]) / dz, sy = load_lanes(direction[1]) / dz;
        const D sz = D(1.0) / dz;
        triangle_lanes::ShearedVertex<D> p[3];
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = triangle_lanes::sheared(load_lanes(vertex[i][0]), load_lanes(vertex[i][1]),
                                           load_lanes(vertex[i][2]), load_lanes(origin[0]),
                                           load_lanes(origin[1]), load_lanes(origin[2]), sx, sy);
        }
        const D eu = edge_function(p[1], p[2]);
        const D ev = edge_function(p[2], p[0]);
        const D ew = edge_function(p[0], p[1]);
        const D zero(0.0);
        const std::uint32_t missed = bits_of(((eu < zero) | (ev < zero) | (ew < zero)) &
                                             ((eu > zero) | (ev > zero) | (ew > zero)));
        const D least = min_lanes(min_lanes(abs(eu), abs(ev)), abs(ew));
        const D reach = max_lanes(max_lanes(reach_of(p[0]), reach_of(p[1])), reach_of(p[2]));
        // Written so that a NaN is not plain.
        const std::uint32_t plain =
            bits_of((least > zero) & (abs(eu + ev + ew) > D(0x1p-8) * reach * reach));
        const auto s = triangle_lanes::solve_triangle(eu, ev, ew, p[0].z, p[1].z, p[2].z, sz);
        const std::uint32_t covered =
            bits_of((load_lanes(t_min) <= s.t) & (s.t <= load_lanes(t_max)));
        store_lanes(s.t, t);
        store_lanes(s.u, u);
        store_lanes(s.v, v);
        return {plain & covered & ~missed, ~plain & ~missed & kAllLanes};
    }

  private:
    static HWY_INLINE Doubles reach_of(const triangle_lanes::ShearedVertex<Doubles>& p) {
        return max_lanes(abs(p.x), abs(p.y));
    }
};

/// Collects pairs of a ray and a triangle, and offers hits to the best of the ray. Vertices that
/// are not in the block are fetched from the mesh in two steps, eight triangles at a time.
class TriangleResolution {
  public:
    HWY_INLINE explicit TriangleResolution(const WideBvhScene& scene) : scene_(scene) {}

    template <class Stats>
    HWY_INLINE void add(const Ray& ray, Hit& best, const TriangleBlock& block, std::size_t lane,
                        Stats stats) {
        const BlockId id = block.ids[lane];
        if (HWY_LIKELY(id.exact())) {
            const LocalFrame& frame = scene_.layout->frame;
            const Vec3 corners[3] = {frame.world(block.corner(0, lane)),
                                     frame.world(block.corner(1, lane)),
                                     frame.world(block.corner(2, lane))};
            return place({&ray, &best, id.id()}, corners, stats);
        }
        hwy::Prefetch(scene_.table->triangle_corners(triangle(id.id())));
        fetching_[fetching_count_++] = {&ray, &best, id.id()};
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
    struct Pair {
        const Ray* ray;
        Hit* best;
        PrimitiveId id;
    };

    [[nodiscard]] HWY_INLINE std::uint32_t triangle(PrimitiveId id) const {
        return static_cast<std::uint32_t>(id) - scene_.table->first(kTriangleKind);
    }

    /// Places the triangles whose vertices have been fetched, and fetches the next ones.
    template <class Stats>
    HWY_NOINLINE void fetch(Stats stats) {
        for (std::size_t i = 0; i < fetched_count_; ++i) {
            const auto [a, b, c] = scene_.table->triangle_vertices(triangle(fetched_[i].id));
            place(fetched_[i], {a, b, c}, stats);
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

    template <class Stats>
    HWY_INLINE void place(const Pair& pair, const Vec3 (&corners)[3], Stats stats) {
        pairs_.set(count_, *pair.ray, corners);
        pair_[count_] = pair;
        if (++count_ == kLaneCount) resolve(stats);
    }

    template <class Stats>
    HWY_NOINLINE void resolve(Stats stats) {
        // Lanes beyond the count hold what was there before, or zeros.
        const TrianglePairs::Verdict verdict = pairs_.resolve();
        const std::uint32_t used = (1u << count_) - 1;
        for (std::uint32_t rest = (verdict.hit | verdict.unsure) & used; rest != 0;
             rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const Pair& pair = pair_[lane];
            ShapeHit hit = pairs_.hit(lane);
            if ((verdict.unsure >> lane & 1) != 0 && !resolve_scalar(pair, hit)) continue;
            stats.primitive_hits(1);
            Ray ray = *pair.ray;
            offer(hit, pair.id, ray, *pair.best);
        }
        count_ = 0;
    }
    HWY_NOINLINE bool resolve_scalar(const Pair& pair, ShapeHit& hit) const {
        const auto [a, b, c] = scene_.table->triangle_vertices(triangle(pair.id));
        return intersect_triangle(*pair.ray, RayShear(pair.ray->direction), a, b, c, hit);
    }

    const WideBvhScene& scene_;
    std::size_t count_ = 0, fetching_count_ = 0, fetched_count_ = 0;
    TrianglePairs pairs_{};
    Pair pair_[kLaneCount], fetching_[kLaneCount], fetched_[kLaneCount];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
