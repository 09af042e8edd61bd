/// The test of a block of spheres, in double.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_SCENE_SPHERE_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SCENE_SPHERE_BLOCK_INL_H_
#undef ALHAZEN_SCENE_SPHERE_BLOCK_INL_H_
#else
#define ALHAZEN_SCENE_SPHERE_BLOCK_INL_H_
#endif

#include "alhazen/geometry/ray.h"
#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/scene/leaf_blocks.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace sphere_lanes {

#include "alhazen/geometry/sphere_roots_formula-inl.h"

}  // namespace sphere_lanes

/// Bits of the spheres that the ray meets in its range, as `Sphere::intersect` decides it. A call:
/// one copy per target costs nothing that could be measured, and compiles in a fraction of the
/// time.
HWY_NOINLINE inline std::uint32_t sphere_candidates(const SphereBlock& block, const Ray& ray) {
    const Doubles dx(ray.direction.x), dy(ray.direction.y), dz(ray.direction.z);
    const Doubles length_squared(dot(ray.direction, ray.direction));
    const Doubles fx = Doubles(ray.origin.x) - load_lanes(block.center[0]);
    const Doubles fy = Doubles(ray.origin.y) - load_lanes(block.center[1]);
    const Doubles fz = Doubles(ray.origin.z) - load_lanes(block.center[2]);
    const Doubles radius = load_lanes(block.radius);
    const auto line = sphere_lanes::sphere_line(dx, dy, dz, length_squared, fx, fy, fz, radius);
    const std::uint32_t missed = bits_of(line.discriminant < Doubles(0.0));
    // Most blocks are missed altogether: their roots are not worth the square roots.
    if ((block.lanes & ~missed) == 0) return 0;
    const auto roots = sphere_lanes::sphere_roots(line, length_squared, fx, fy, fz, radius);
    const Doubles first(ray.t_min), last(ray.t_max);
    const std::uint32_t met = bits_of((first <= roots.t_near) & (roots.t_near <= last)) |
                              bits_of((first <= roots.t_far) & (roots.t_far <= last));
    return block.lanes & met & ~missed;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
