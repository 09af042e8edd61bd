#pragma once
/// A ray that is a cone: a centre line, a radius where it starts and the growth of the radius.
///
/// Every cone of the library is one of these: the cone of a pixel, which `cone_tracing` follows,
/// and the footprints of single rays (RayCone), which are its small-angle case.
///
/// Source: Amanatides, "Ray Tracing with Cones", SIGGRAPH 1984, section 2.
/// Differs: radius and growth instead of an apex, so that parallel and converging cones are cones
/// too. The apex is virtual: `radius / spread` behind the start, in front of it where the cone
/// converges.
/// Conventions: `axis` is unit. `spread` is the tangent of half the angle at the apex, negative
/// where the cone converges.

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
    /// Of a cone that is not parallel.
    [[nodiscard]] Vec3 apex() const { return at(-radius / spread); }
    /// The diameter and its growth: all that the lookup of a texture needs.
    [[nodiscard]] RayCone footprint() const { return {2.0 * radius, 2.0 * spread}; }
};

}  // namespace alhazen
