#pragma once
/// Division of a rational Bezier curve into chords within a tolerance.
///
/// Source: Lane and Riesenfeld, "A Theoretical Development for the Computer Generation and Display
/// of Piecewise Polynomial Surfaces", IEEE PAMI 2(1), 1980 (halving until the control polygon is
/// flat).
/// Conventions: the division depends only on the control points and the tolerance, in either
/// direction: two patches that share a boundary curve divide it at the same points, bit for bit.

#include <cstdint>
#include <span>
#include <vector>

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// A point of a division; `parameter` is exact (dyadic).
struct CurveDivisionPoint {
    double parameter = 0;
    Vec3 point;
};

/// Points from parameter 0 to 1, at least two. Each chord is within `tolerance` of its part of the
/// curve, except for parts of length 2^-20, which are not divided further.
[[nodiscard]] std::vector<CurveDivisionPoint> divided_curve(std::span<const HomogeneousPoint> curve,
                                                            double tolerance);

}  // namespace alhazen
