#pragma once
/// The rounding of a test along an axis that is relative to the coordinates along all axes.
///
/// Conventions: internal to shapes/. A test that projects points onto axes across the ray, or moves
/// the ray's origin along it, rounds so. Others round along each axis relative to the coordinates
/// along that axis, which primitives/surface.cpp adds.

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

/// The part of ShapeSurface::error for `roundings` of the largest coordinate `reach`, along all
/// axes.
inline Vec3 mixed_rounding(int roundings, double reach) {
    const double error = gamma_bound(roundings) * reach;
    return {error, error, error};
}

/// The same for the test of a patch with this largest coordinate. It rounds by less than 2^-46 of
/// |p| + |o|, for points p of the patch and the ray's origin o, along and across the ray. Along the
/// normal this is less than 2^-46 sqrt(2) times 2 sqrt(3) `reach`. Where the line is within
/// rounding of the surface, twice as much was seen. 32 times the result
/// (`LeavingRays::kErrorsAway`) is three times as much.
inline Vec3 patch_test_rounding(double reach) {
    return mixed_rounding(64, reach);
}

}  // namespace alhazen
