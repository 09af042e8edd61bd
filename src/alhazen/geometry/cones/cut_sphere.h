#pragma once
/// The part of a cone that a sphere covers which the surface at the start of the cone cuts.
///
/// The lines of the cone start on a plane. Those within the circle in which the plane cuts the
/// sphere start inside of it and are left out; of the others those are covered that meet the part
/// in front of the plane, whose outline is an arc of the sphere's contour and one of the circle.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 3, has whole spheres only.
/// Conventions: as in cone_coverage.h. Arcs are polygons of the same area; the error is below 2e-3.
/// Complexity: O(1); no allocation once the scratch memory has grown.

#include <optional>

#include "alhazen/geometry/cones/cone_coverage.h"

namespace alhazen {

struct ConeSphere {
    Vec3 center;
    double radius = 0;
};
/// Where the lines of a cone start.
struct ConePlane {
    Vec3 point;
    Vec3 normal;  ///< unit vector, towards the cone
};

/// True if the plane cuts the sphere.
[[nodiscard]] bool is_cut(const ConeSphere& sphere, const ConePlane& start);

/// The part of the lines that start outside the sphere which meets it. Nothing if all lines start
/// inside. Precondition: is_cut. `whole`: the coverage by the whole sphere.
[[nodiscard]] std::optional<ConeCover> cut_cover(const ConeRay& cone, const ConeMap& map,
                                                 const ConeSphere& sphere, const ConePlane& start,
                                                 const ConeCover& whole, double z_max,
                                                 ConeScratch& scratch);

}  // namespace alhazen
