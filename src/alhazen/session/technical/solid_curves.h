#pragma once
/// The curves of a solid of planes, spheres, cylinders and cones: where its faces meet, and its
/// outlines. No triangles.
///
/// Source: Levin, "A Parametric Algorithm for Drawing Pictures of Solid Objects Composed of Quadric
/// Surfaces", Communications of the ACM 19, 1976 (the curve of two quadrics by the lines of a ruled
/// one).
/// Differs: lines, circles and ellipses are found as such; other curves become lines between points
/// that lie on both faces to rounding. Which parts of a curve are edges follows from the wheel of
/// solid around its points (solid_faces.h), at 256 of them and by halving between.
/// Complexity: pairs of faces of leaves whose boxes meet.

#include <vector>

#include "alhazen/session/technical/feature_curves.h"
#include "alhazen/session/technical/solid_faces.h"

namespace alhazen {

/// Adds the curves; false, and none added, where two spheres of different placements meet in a
/// curve that has no such form.
[[nodiscard]] bool add_solid_curves(const FacedSolid& solid, const BeamApex& eye,
                                    std::vector<FeatureCurve>& curves);

}  // namespace alhazen
