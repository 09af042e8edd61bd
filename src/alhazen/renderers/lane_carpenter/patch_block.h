#pragma once
/// Surfaces of a patch at up to eight samples at once, in lanes.
///
/// Source: the steps of set_patch_surface (patch_surface.h).
/// Conventions: every lane has the bits of set_patch_surface, on every target.
/// Complexity: linear in the control points.

#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// A point whose step of Newton's method is no longer than this share of its error is not found
/// again: the normal is that of the point before the step.
inline constexpr double kShortStep = 1.0 / 4;

struct alignas(64) PatchBlock {
    static constexpr std::size_t kMost = 8;

    // What is given. Lanes from `count` on may hold anything.
    double u[kMost] = {}, v[kMost] = {};  ///< parameters; corrected by find_patch_points
    double error[kMost] = {};             ///< bounds of the distance of the points from the patch
    const Ray* rays = nullptr;            ///< [count] eye rays
    std::size_t count = 0;

    // What is found.
    std::uint32_t regular = 0;  ///< bit of each lane whose normal is known
    alignas(64) double point[3][kMost] = {}, normal[3][kMost] = {};  ///< [axis]; normals are unit
    double du[3][kMost] = {}, dv[3][kMost] = {};

    [[nodiscard]] static Vec3 vector(const double (&lanes)[3][kMost], std::size_t lane) {
        return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
    }
};

/// Finds the points of a patch that the eye rays of a block meet. `polynomial`: all weights are 1.
void find_patch_points(const BezierNet& net, bool polynomial, PatchBlock& block);

}  // namespace alhazen
