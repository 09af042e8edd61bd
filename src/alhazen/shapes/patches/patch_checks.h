#pragma once
/// Checks of the fields that patches have in common.

#include <cstdint>
#include <span>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

/// Degrees from 1 to kMaxPatchDegree.
void check_patch_degrees(FieldChecks& checks, std::uint32_t degree_u, std::uint32_t degree_v);
/// Finite points; as many weights as points or none, each from 1e-6 to 1e6.
void check_control_points(FieldChecks& checks, std::span<const Vec3> points,
                          std::span<const double> weights);

}  // namespace alhazen
