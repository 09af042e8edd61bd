#pragma once
/// Checks of common fields of patches.

#include <cstdint>
#include <span>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

/// Checks that degrees are from 1 to kMaxPatchDegree.
void check_patch_degrees(FieldChecks& checks, std::uint32_t degree_u, std::uint32_t degree_v);
/// Checks that points are finite and that there are as many weights as points, or none, each from
/// 1e-6 to 1e6.
void check_control_points(FieldChecks& checks, std::span<const Vec3> points,
                          std::span<const double> weights);

}  // namespace alhazen
