#pragma once
/// A point of a rational Bezier patch with its first derivatives, in one pass over the net; the
/// evaluation of Newton's method.
///
/// Source: Farin, "Curves and Surfaces for CAGD", 5th ed., Morgan Kaufmann, 2002, sections 4.1
/// (Bernstein polynomials) and 13.5 (derivatives of rational curves).
/// Differs: `derivatives_at` (bezier_net.h) finds the same by de Casteljau's algorithm, more
/// slowly; the results agree to rounding. Conventions: u and v may lie slightly outside [0, 1].

#include "alhazen/shapes/patches/bezier_net.h"

namespace alhazen {

struct PatchValue {
    Vec3 point, du, dv;
    double weight = 1;
};

/// The homogeneous point and its derivatives.
struct HomogeneousValue {
    HomogeneousPoint s, s_u, s_v;
};

/// Bernstein polynomials of a degree, and their derivatives, at t.
void bernstein_values(int degree, double t, double* values, double* derivatives);

/// Precondition: the weight is positive at (u, v).
[[nodiscard]] PatchValue patch_value(BezierView net, double u, double v);
/// The same for weight * (point - origin), a polynomial in u and v.
[[nodiscard]] PatchValue weighted_value(BezierView net, const Vec3& origin, double u, double v);

}  // namespace alhazen
