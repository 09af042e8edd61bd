#pragma once
/// The surfaces of spheres and of the sides of cylinders and cones in lanes, a shape for each lane
/// (shapes/core/lane_surfaces.h).
///
/// Source: sphere.cpp, frustum.cpp, the same operations in the same order.
/// Conventions: lanes that the functions do not return are left to the scalar code.

#include "alhazen/shapes/core/lane_surfaces.h"
#include "alhazen/shapes/quadrics/frustum.h"
#include "alhazen/shapes/quadrics/sphere.h"

namespace alhazen {

struct alignas(64) SphereLanes {
    double center[3][kSurfaceLanes], radius[kSurfaceLanes];

    void set(std::size_t lane, const Sphere& sphere) {
        for (int k = 0; k < 3; ++k) center[k][lane] = sphere.center[k];
        radius[lane] = sphere.radius;
    }
};
struct alignas(64) FrustumLanes {
    double center[3][kSurfaceLanes], axis[3][kSurfaceLanes];
    double half_height[kSurfaceLanes], middle_radius[kSurfaceLanes], slope[kSurfaceLanes];

    void set(std::size_t lane, const Frustum& frustum) {
        for (int k = 0; k < 3; ++k) {
            center[k][lane] = frustum.center[k];
            axis[k][lane] = frustum.axis[k];
        }
        half_height[lane] = frustum.half_height;
        middle_radius[lane] = frustum.middle_radius;
        slope[lane] = frustum.slope;
    }
};

/// Return the lanes of `wanted` that they set.
[[nodiscard]] std::uint32_t sphere_surfaces(const SphereLanes& spheres, std::uint32_t wanted,
                                            LaneSurfaces& lanes);
[[nodiscard]] std::uint32_t side_surfaces(const FrustumLanes& frusta, std::uint32_t wanted,
                                          LaneSurfaces& lanes);

}  // namespace alhazen
