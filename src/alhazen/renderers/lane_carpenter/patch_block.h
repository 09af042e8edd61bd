#pragma once
/// Surface points of a patch for up to eight samples at once, in lanes.
///
/// Source: the steps of set_patch_surface (patch_surface.h).
/// Conventions: every lane has the bits of set_patch_surface, on every target.
/// Complexity: linear in the control points.

#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/ray.h"
#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// Threshold of a step of Newton's method relative to the point's error: after a shorter step the
/// normal is that of the point before the step.
inline constexpr double kShortStep = 1.0 / 4;

struct alignas(64) PatchBlock {
    static constexpr std::size_t kMost = 8;

    // Input. Lanes from `count` on are ignored.
    double u[kMost] = {}, v[kMost] = {};  ///< parameters; corrected by find_patch_points
    double error[kMost] = {};             ///< bounds of the distance of the points from the patch
    const Ray* rays = nullptr;            ///< [count] eye rays
    std::size_t count = 0;

    // Output.
    std::uint32_t regular = 0;  ///< bit of each lane whose normal is valid
    alignas(64) double point[3][kMost] = {}, normal[3][kMost] = {};  ///< [axis]; normals are unit
    double du[3][kMost] = {}, dv[3][kMost] = {};

    [[nodiscard]] static Vec3 vector(const double (&lanes)[3][kMost], std::size_t lane) {
        return {lanes[0][lane], lanes[1][lane], lanes[2][lane]};
    }
};

/// Computes the points where the eye rays of a block meet a patch. `polynomial`: all weights are 1.
void find_patch_points(const BezierNet& net, bool polynomial, PatchBlock& block);

}  // namespace alhazen
