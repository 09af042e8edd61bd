#pragma once
/// The curves of a solid of planes, spheres, cylinders and cones without tessellation: where its
/// faces meet, and its outlines.
///
/// Source: Levin, "A Parametric Algorithm for Drawing Pictures of Solid Objects Composed of Quadric
/// Surfaces", Communications of the ACM 19, 1976 (the curve of two quadrics by the lines of a ruled
/// one).
/// Differs: lines, circles and ellipses are found in closed form; other curves become lines between
/// points that lie on both faces up to rounding. Which parts of a curve are edges follows from the
/// neighbourhoods of 256 of its points (solid_faces.h) and bisection between them.
/// Complexity: pairs of faces of leaves whose boxes meet.

#include <vector>

#include "alhazen/session/technical/feature_curves.h"
#include "alhazen/session/technical/solid_faces.h"

namespace alhazen {

/// Adds the curves. Returns false, and adds none, if two spheres of different placements meet in a
/// curve without closed form.
[[nodiscard]] bool add_solid_curves(const FacedSolid& solid, const BeamApex& eye,
                                    std::vector<FeatureCurve>& curves);

/// Adds the curves in which the surfaces of two solids of different objects cross, as silhouettes.
/// `both` is their union, with the leaves of `one` first. Edges of one of them are no such curves.
/// Adds none where `add_solid_curves` would return false.
void add_crossing_curves(const FacedSolid& both, const FacedSolid& one, const FacedSolid& other,
                         const BeamApex& eye, std::vector<FeatureCurve>& curves);

}  // namespace alhazen
