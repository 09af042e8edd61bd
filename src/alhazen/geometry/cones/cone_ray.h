#pragma once
/// A cone around a ray: a centre line, a radius at its start and the growth of the radius.
///
/// Represents all cones of the library: the cones of pixels, which `cone_tracing` follows, and the
/// footprints of rays (RayCone), their small-angle case.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 2.
/// Differs: stores radius and growth instead of an apex, so that parallel and converging cones are
/// included. The virtual apex lies `radius / spread` behind the start, or in front of it if the
/// cone converges.
/// Conventions: `axis` is a unit vector. `spread` is the tangent of half the angle at the apex,
/// negative if the cone converges.

#include <cmath>

#include "alhazen/geometry/ray_cone.h"
#include "alhazen/math/vec.h"

namespace alhazen {

struct ConeRay {
    Vec3 origin;
    Vec3 axis{0, 0, 1};
    double radius = 0;
    double spread = 0;

    /// Negative beyond the focus of a converging cone.
    [[nodiscard]] double radius_at(double t) const { return radius + spread * t; }
    [[nodiscard]] Vec3 at(double t) const { return origin + t * axis; }
    /// The virtual apex. Precondition: the cone is not parallel.
    [[nodiscard]] Vec3 apex() const { return at(-radius / spread); }
    /// The diameter and its growth, which the lookup of a texture needs.
    [[nodiscard]] RayCone footprint() const { return {2.0 * radius, 2.0 * spread}; }
};

}  // namespace alhazen
