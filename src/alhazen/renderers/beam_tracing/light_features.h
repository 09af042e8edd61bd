#pragma once
/// Points of a plane around which the shading by a light may change within a small area, so that a
/// grid of samples can miss it.
///
/// Conventions: world space. The points are the foot of the perpendicular from a light at a point,
/// the point where the plane mirrors the light to the eye, those where the axis of a spot and rays
/// of its cones meet the plane, and that of the axis of a profile.

#include <vector>

#include "alhazen/geometry/facets/beam_projection.h"
#include "alhazen/shading/lights/light.h"

namespace alhazen {

/// Adds the points of `plane`, whose normal is a unit vector; `eye` may be at infinity.
void add_light_features(const Light& light, const FacetPlane& plane, const BeamApex& eye,
                        std::vector<Vec3>& points);

}  // namespace alhazen
