#pragma once
/// The first crossings of eight rays with a sphere, in lanes.
///
/// Source: geometry/sphere_roots.h, the same formulas.
/// Differs: values outside the fast min/max range (fast_min_max-inl.h) are left to the scalar code.
/// Conventions: internal to this folder. Bit i of a set stands for lane i. Every target returns the
/// bits of the scalar code.

#include <cstdint>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen {

struct alignas(64) SphereHitLanes {
    double t[kRayLanes];  ///< for the lanes that hit
    std::uint32_t hit;
    std::uint32_t unsure;  ///< lanes left to the scalar code
};

using SphereHitsKernel = void (*)(const RayLanes&, const Sphere&, SphereHitLanes&);

/// For the best instruction set of this machine, or the forced one (simd/targets.h).
[[nodiscard]] SphereHitsKernel sphere_hits_kernel();

}  // namespace alhazen
