#pragma once
/// Bounds of the first and second derivatives of rational Bezier patches, from their control
/// points.
///
/// Source: Filip, Magedson and Markot, "Surface algorithms using bounds on derivatives", Computer
/// Aided Geometric Design 3(4), 1986. Differs: rational patches, by the quotient rule about the
/// middle of the control points' box, and by the control points of the derivatives' numerators,
/// where terms of the quotient rule may cancel; the smaller counts.
/// Conventions: derivatives are by the parameters of the unit square; bounds are of lengths.

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

/// Bounds of the derivatives of a patch over its unit square.
struct PatchDerivativeBounds {
    double uu = 0, uv = 0, vv = 0;
};
[[nodiscard]] PatchDerivativeBounds second_derivative_bounds(const BezierNet& net);
/// Bounds of the derivatives by u and v.
[[nodiscard]] Vec2 first_derivative_bounds(const BezierNet& net);

}  // namespace alhazen
