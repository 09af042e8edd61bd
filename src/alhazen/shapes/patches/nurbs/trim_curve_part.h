#pragma once
/// The part of a trimming curve between two parameters, by insertion of knots.
///
/// Source: Boehm, "Inserting New Knots into B-Spline Curves", Computer-Aided Design 1980.

#include "alhazen/shapes/patches/nurbs/nurbs_surface.h"

namespace alhazen {

/// The part [from, to] of a curve, reversed if from > to. Preconditions: valid knots, and a range
/// within them.
[[nodiscard]] TrimCurve trim_curve_part(TrimCurve curve, double from, double to);

}  // namespace alhazen
