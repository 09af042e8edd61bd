/// Exact resolution of the primitives that pass a filter: the test in double, for one pair of a ray
/// and a primitive or eight pairs in lanes, without a call into code for another instruction set.
///
/// The formulas and their order are those of geometry/watertight_triangle.h and
/// geometry/sphere_roots.h, so the bits are those of the scalar tests. Cases in doubt (an edge
/// function that is zero, a triangle seen nearly edge on, a root that is zero) are left to the
/// scalar tests.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_EXACT_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_EXACT_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_EXACT_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_EXACT_RESOLUTION_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace exact {

#include "alhazen/geometry/fast_min_max-inl.h"
#include "alhazen/geometry/sphere_roots_formula-inl.h"
#include "alhazen/geometry/watertight_triangle_formulas-inl.h"

}  // namespace exact

enum class Verdict { Missed, Hit, Unsure };

/// `intersect_triangle` for one ray. `axis` is the order of axes of RayShear. Precondition: exactly
/// one component of the direction, the third of `axis`, has the largest magnitude. Corners are
/// [corner][axis in that order].
HWY_INLINE Verdict resolve_triangle(const Ray& ray, const std::uint32_t (&axis)[3],
                                    const double (&corner)[3][3], ShapeHit& hit) {
    const auto at = [&](const Vec3& v, std::size_t k) { return (&v.x)[axis[k]]; };
    const double dx = at(ray.direction, 0), dy = at(ray.direction, 1), dz = at(ray.direction, 2);
    if (!(std::abs(dz) > std::abs(dx) && std::abs(dz) > std::abs(dy))) return Verdict::Unsure;
    const double ox = at(ray.origin, 0), oy = at(ray.origin, 1), oz = at(ray.origin, 2);
    const double sx = dx / dz, sy = dy / dz, sz = 1.0 / dz;
    exact::ShearedVertex<double> p[3];
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        p[i] = exact::sheared<double>(corner[i][0], corner[i][1], corner[i][2], ox, oy, oz, sx, sy);
    }
    const exact::TriangleEdges<double> edges(p[0], p[1], p[2]);
    // edges.nonzero() as one comparison: which side of the triangle is seen is not predictable.
    if (!(exact::max_lanes(edges.least, -edges.most) > 0.0)) {
        return edges.missed() ? Verdict::Missed : Verdict::Unsure;
    }
    if (!edges.well_conditioned()) return Verdict::Unsure;
    const auto s = exact::solve_triangle(edges.u, edges.v, edges.w, p[0].z, p[1].z, p[2].z, sz);
    if (!ray.covers(s.t)) return Verdict::Missed;
    hit = {s.t, s.u, s.v, 0};
    return Verdict::Hit;
}

/// The sphere of a used lane: from the block, which is at hand, where that holds it unrounded.
HWY_INLINE Sphere sphere_of(const WideBvhScene& scene, const SphereBlock& block, std::size_t lane) {
    const BlockId id = block.ids[lane];
    if (HWY_LIKELY(id.exact())) return block.sphere(lane, scene.layout->frame);
    return std::get<ShapeColumn<Sphere>>(scene.table->columns)
        .shapes[static_cast<std::uint32_t>(id.id()) - scene.table->first(column_of<Sphere>())];
}

/// The sphere of a lane of FrustumBlock::balls.
HWY_INLINE const Sphere& sphere_of(const WideBvhScene& scene, const FrustumBlock& block,
                                   std::size_t lane) {
    return shape_of<Sphere>(*scene.table, block.ids[lane].id());
}

/// Fetches what the test in double of a waiting shape will read.
template <class Block>
HWY_INLINE void expect_shape(const WideBvhScene&, const Block&, std::size_t) {}
HWY_INLINE void expect_shape(const WideBvhScene& scene, const FrustumBlock& block,
                             std::size_t lane) {
    const PrimitiveId id = block.ids[lane].id();
    if ((block.balls >> lane & 1) != 0) return hwy::Prefetch(&shape_of<Sphere>(*scene.table, id));
    const Cylinder& cylinder = shape_of<Cylinder>(*scene.table, id);
    hwy::Prefetch(&cylinder.capped);
    hwy::Prefetch(&cylinder.frustum.center);
    hwy::Prefetch(&cylinder.frustum.x_axis);
    hwy::Prefetch(&cylinder.frustum.bounding_radius_squared);
}
HWY_INLINE void expect_shape(const WideBvhScene& scene, const BoxBlock& block, std::size_t lane) {
    const PrimitiveId id = block.ids[lane].id();
    if (!is_bare<Polygon>(*scene.table, id)) return;
    const Polygon& polygon = shape_of<Polygon>(*scene.table, id);
    hwy::Prefetch(&polygon);
    hwy::Prefetch(&polygon.normal);
    hwy::Prefetch(&polygon.cells);
}

struct SphereCrossings {
    double t[2];
    std::uint32_t count = 0;
};

/// The crossings of a ray with a sphere, with the bits of Sphere::intersect.
HWY_INLINE Verdict resolve_sphere(const Ray& ray, const Sphere& sphere, SphereCrossings& met) {
    using exact::FastMinMaxDouble;
    const Vec3& d = ray.direction;
    const Vec3 f = ray.origin - sphere.center;
    const FastMinMaxDouble dx{d.x}, dy{d.y}, dz{d.z}, fx{f.x}, fy{f.y}, fz{f.z};
    const FastMinMaxDouble a{length_squared(d)}, radius{sphere.radius};
    const auto line = exact::sphere_line(dx, dy, dz, a, fx, fy, fz, radius);
    if (!(line.discriminant.x >= 0.0)) return Verdict::Missed;
    const auto roots = exact::sphere_roots(line, a, fx, fy, fz, radius);
    const double entry = roots.t_near.x, exit = roots.t_far.x;
    if (!exact::are_plain_roots(entry, exit)) return Verdict::Unsure;
    if (ray.covers(entry)) met.t[met.count++] = entry;
    if (ray.covers(exit)) met.t[met.count++] = exit;
    return met.count == 0 ? Verdict::Missed : Verdict::Hit;
}

/// N rays in lanes, each with a triangle of its own. Axes as in RayShear.
template <std::size_t N>
struct PairLanes {
    using Reals = Lanes<double, N>;
    Reals vertex[3][3];  ///< [corner][axis]
    Reals origin[3], direction[3], t_min, t_max;
};

/// The results of the test in double for them.
template <std::size_t N>
struct PairVerdicts {
    std::uint32_t hit, unsure;
    alignas(64) double t[N], u[N], v[N];

    HWY_INLINE void test(const PairLanes<N>& pairs) {
        using D = typename PairLanes<N>::Reals;
        const D dz = pairs.direction[2];
        const D sx = pairs.direction[0] / dz, sy = pairs.direction[1] / dz;
        const D sz = D(1.0) / dz;
        exact::ShearedVertex<D> p[3];
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            p[i] = exact::sheared(pairs.vertex[i][0], pairs.vertex[i][1], pairs.vertex[i][2],
                                  pairs.origin[0], pairs.origin[1], pairs.origin[2], sx, sy);
        }
        const exact::TriangleEdges<D> edges(p[0], p[1], p[2]);
        const std::uint32_t missed = bits_of(edges.missed());
        const std::uint32_t plain = bits_of(edges.nonzero() & edges.well_conditioned());
        const auto s = exact::solve_triangle(edges.u, edges.v, edges.w, p[0].z, p[1].z, p[2].z, sz);
        const std::uint32_t covered = bits_of((pairs.t_min <= s.t) & (s.t <= pairs.t_max));
        store_lanes(s.t, t);
        store_lanes(s.u, u);
        store_lanes(s.v, v);
        hit = plain & covered & ~missed;
        unsure = ~plain & ~missed & ((1u << N) - 1);
    }

    /// Calls `accept(lane, hit)` for the lanes of `used` that hit until it returns true; returns
    /// whether it did. `scalar(lane, hit)` is the scalar test, for lanes in doubt and those not in
    /// `set_up`, whose ray is not stored along its dominant axis.
    template <class Scalar, class Accept>
    HWY_INLINE bool take(std::uint32_t used, std::uint32_t set_up, Scalar&& scalar,
                         Accept&& accept) const {
        const std::uint32_t alone = (unsure | ~set_up) & used;
        for (std::uint32_t rest = (hit & used) | alone; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            ShapeHit found{t[lane], u[lane], v[lane], 0};
            if ((alone >> lane & 1) != 0 && !scalar(lane, found)) continue;
            if (accept(lane, found)) return true;
        }
        return false;
    }
};

/// N arbitrary rays, each with its own triangle; [..][lane].
template <std::size_t N = kLaneCount>
class TrianglePairs {
  public:
    /// A triangle of any vertices.
    HWY_INLINE void set(std::size_t lane, const Ray& ray, const Vec3 (&corners)[3]) {
        const auto kz = static_cast<std::uint32_t>(dominant_axis(ray.direction));
        const std::uint32_t axis[3] = {kz == 2 ? 0 : kz + 1, kz == 0 ? 2 : kz - 1, kz};
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t i = 0; i < 3; ++i) {
                vertex_[i][k][lane] = corners[i][static_cast<int>(axis[k])];
            }
        }
        in_block_ &= ~(1u << lane);
        set_ray(lane, ray, axis);
    }
    /// A triangle that its block holds unrounded. `axis`: the order of axes of the ray's filter.
    HWY_INLINE void set(std::size_t lane, const Ray& ray, const std::uint32_t (&axis)[3],
                        const LocalFrame& frame, const TriangleBlock& block,
                        std::size_t block_lane) {
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            HWY_UNROLL(3)
            for (std::size_t i = 0; i < 3; ++i) {
                local_[i][k][lane] = block.vertex[i][axis[k]][block_lane];
            }
            center_[k][lane] = (&frame.center.x)[axis[k]];
        }
        in_block_ |= 1u << lane;
        set_ray(lane, ray, axis);
    }

    /// Tests the lanes of `used`: see PairVerdicts::take.
    template <class Scalar, class Accept>
    HWY_INLINE bool resolve(std::uint32_t used, double inverse_scale, Scalar&& scalar,
                            Accept&& accept) {
        PairVerdicts<N> verdicts;
        const std::uint32_t set_up = test(inverse_scale, verdicts);
        return verdicts.take(used, set_up, scalar, accept);
    }

  private:
    using Reals = Lanes<double, N>;

    HWY_INLINE void set_ray(std::size_t lane, const Ray& ray, const std::uint32_t (&axis)[3]) {
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k][lane] = (&ray.origin.x)[axis[k]];
            direction_[k][lane] = (&ray.direction.x)[axis[k]];
        }
        t_min_[lane] = ray.t_min;
        t_max_[lane] = ray.t_max;
    }
    /// Returns the lanes whose third axis is the dominant one.
    HWY_NOINLINE HWY_FLATTEN std::uint32_t test(double inverse_scale,
                                                PairVerdicts<N>& verdicts) const {
        PairLanes<N> pairs;
        for (std::size_t k = 0; k < 3; ++k) {
            const Reals center = load_lanes<N>(center_[k]);
            for (std::size_t i = 0; i < 3; ++i) {
                // As LocalFrame::world.
                pairs.vertex[i][k] =
                    Reals(inverse_scale) * as_doubles(load_lanes<N>(local_[i][k])) + center;
            }
            pairs.origin[k] = load_lanes<N>(origin_[k]);
            pairs.direction[k] = load_lanes<N>(direction_[k]);
        }
        if (in_block_ != (1u << N) - 1) {
            const auto in_block = lanes_of_bits<double, N>(in_block_);
            for (std::size_t k = 0; k < 3; ++k) {
                for (std::size_t i = 0; i < 3; ++i) {
                    pairs.vertex[i][k] =
                        select_lanes(in_block, pairs.vertex[i][k], load_lanes<N>(vertex_[i][k]));
                }
            }
        }
        pairs.t_min = load_lanes<N>(t_min_);
        pairs.t_max = load_lanes<N>(t_max_);
        verdicts.test(pairs);
        const Reals most = abs(pairs.direction[2]);
        return bits_of((most > abs(pairs.direction[0])) & (most > abs(pairs.direction[1])));
    }

    std::uint32_t in_block_ = 0;          ///< bits of the lanes of `local_`
    alignas(64) float local_[3][3][N];    ///< [corner][axis], in the local frame
    alignas(64) double vertex_[3][3][N];  ///< [corner][axis], axes as in RayShear
    alignas(64) double center_[3][N];     ///< of the local frame
    alignas(64) double origin_[3][N], direction_[3][N];
    alignas(64) double t_min_[N], t_max_[N];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
