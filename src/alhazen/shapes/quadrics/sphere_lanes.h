#pragma once
/// The first crossings of eight rays with a sphere, side by side in lanes.
///
/// Source: geometry/sphere_roots.h, the same formulas. Differs: what is not plain
/// (fast_min_max-inl.h) is left to the scalar text. Conventions: internal to this folder. Bit i of
/// a set stands for lane i. Every target gives the bits of the scalar text.

#include <cstdint>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/geometry/sphere_roots.h"
#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen {

struct alignas(64) SphereHitLanes {
    double t[kRayLanes];  ///< of the lanes that hit
    std::uint32_t hit;
    std::uint32_t unsure;  ///< ask the scalar text
};

using SphereHitsKernel = void (*)(const RayLanes&, const Sphere&, SphereHitLanes&);

/// For the best instruction set of this machine, or the one that is forced (simd/targets.h).
[[nodiscard]] SphereHitsKernel sphere_hits_kernel();

}  // namespace alhazen
