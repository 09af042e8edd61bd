/// Exact resolution of a sphere that passes the filter, in double, without a call into code for
/// another instruction set.
///
/// Formulas and their order are those of geometry/sphere_roots.h: the bits are those of the test of
/// the shape. Cases in doubt are left to that test.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_SPHERE_RESOLUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_SPHERE_RESOLUTION_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_SPHERE_RESOLUTION_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_SPHERE_RESOLUTION_INL_H_
#endif

#include <cmath>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_bounds.h"
#include "alhazen/aggregates/wide_bvh/triangle_resolution-inl.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/quadrics/sphere.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace sphere_numbers {

#include "alhazen/geometry/fast_min_max-inl.h"
#include "alhazen/geometry/sphere_roots_formula-inl.h"

}  // namespace sphere_numbers

/// The first crossing of a ray with a sphere, as Sphere::intersect finds it.
HWY_INLINE PlainVerdict intersect_plain(const Ray& ray, const Sphere& sphere, ShapeHit& hit) {
    using sphere_numbers::FastMinMaxDouble;
    const Vec3& d = ray.direction;
    const Vec3 f = ray.origin - sphere.center;
    const FastMinMaxDouble dx{d.x}, dy{d.y}, dz{d.z}, fx{f.x}, fy{f.y}, fz{f.z};
    const FastMinMaxDouble a{length_squared(d)}, radius{sphere.radius};
    const auto line = sphere_numbers::sphere_line(dx, dy, dz, a, fx, fy, fz, radius);
    if (!(line.discriminant.x >= 0.0)) return PlainVerdict::Missed;
    const auto roots = sphere_numbers::sphere_roots(line, a, fx, fy, fz, radius);
    const double entry = roots.t_near.x, exit = roots.t_far.x;
    if (!sphere_numbers::are_plain_roots(entry, exit)) return PlainVerdict::Unsure;
    if (ray.covers(entry)) {
        hit = {entry, 0, 0, 0};
    } else if (ray.covers(exit)) {
        hit = {exit, 0, 0, 0};
    } else {
        return PlainVerdict::Missed;
    }
    return PlainVerdict::Hit;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
