#include "alhazen/shapes/quadrics/sphere_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/quadrics/sphere_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

static_assert(kRayLanes == kLaneCount);

#include "alhazen/geometry/sphere_roots_formula-inl.h"

void sphere_hits(const RayLanes& rays, const Sphere& sphere, SphereHitLanes& out) {
    const Doubles dx = load_lanes(rays.direction[0]), dy = load_lanes(rays.direction[1]),
                  dz = load_lanes(rays.direction[2]);
    const Doubles fx = load_lanes(rays.origin[0]) - Doubles(sphere.center.x),
                  fy = load_lanes(rays.origin[1]) - Doubles(sphere.center.y),
                  fz = load_lanes(rays.origin[2]) - Doubles(sphere.center.z);
    const Doubles a = dx * dx + dy * dy + dz * dz, radius(sphere.radius);
    const SphereLine<Doubles> line = sphere_line(dx, dy, dz, a, fx, fy, fz, radius);
    const std::uint32_t met = bits_of(line.discriminant >= Doubles(0.0));
    out.hit = out.unsure = 0;
    if (met == 0) return;
    const SphereRoots<Doubles> roots = sphere_roots(line, a, fx, fy, fz, radius);
    const Doubles entry = roots.t_near, exit = roots.t_far;
    const Doubles far(kFarRoot), zero(0.0);
    // As `are_plain_roots`.
    const std::uint32_t plain =
        bits_of((entry <= exit) & (entry > Doubles(-kFarRoot)) & (exit < far)) &
        bits_of((entry < zero) | (entry > zero)) & bits_of((exit < zero) | (exit > zero));
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const std::uint32_t enters = bits_of((t_min <= entry) & (entry <= t_max));
    const std::uint32_t leaves = bits_of((t_min <= exit) & (exit <= t_max));
    out.unsure = met & ~plain;
    out.hit = met & plain & (enters | leaves);
    store_lanes(entry, out.t);
    const std::uint32_t only_leaves = out.hit & ~enters;
    if (only_leaves == 0) return;
    HWY_ALIGN double exits[kRayLanes];
    store_lanes(exit, exits);
    for (std::size_t i = 0; i < kRayLanes; ++i) {
        if ((only_leaves >> i & 1) != 0) out.t[i] = exits[i];
    }
}

}  // namespace

SphereHitsKernel sphere_hits_of_target() {
    return &sphere_hits;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(sphere_hits_of_target);

SphereHitsKernel sphere_hits_kernel() {
    // Called for every eight rays: the dispatch is cached.
    return ALHAZEN_KERNEL(sphere_hits_of_target)();
}

}  // namespace alhazen
#endif
