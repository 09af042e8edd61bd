#pragma once
/// The part of the shading equation that needs no further rays but shadow rays; shared by the
/// renderers.
///
/// Source: UW CSE 457, "Ray Tracing" lecture and Trace project: I = ke + sum_j [ ka ILa_j + Ashadow
/// Adist IL_j Bj (kd (N.L) + ks (N.H)^ns) ]; Whitted 1980; Phong 1975; Blinn 1977. Differs: what
/// formats do otherwise is read from ShadingConventions.

#include "alhazen/scene/scene.h"
#include "alhazen/scene/surface.h"

namespace alhazen {

/// A hit made ready for shading: everything turned to the side the ray came from.
struct ShadingPoint {
    Surface surface;
    MaterialSample material;
    bool inside = false;   ///< the ray came through the inside of something transparent
    bool entering = true;  ///< the ray met the outside (by the geometric normal)
    Vec3 geometric;        ///< unit geometric normal towards the ray's origin
    Vec3 normal;           ///< unit shading normal, turned towards the ray's origin
    Vec3 view;             ///< unit, towards the ray's origin
};

[[nodiscard]] MaterialSample material_at(const Scene& scene, const Surface& surface);

/// `ray.direction` must be unit. Whether the ray came through the inside is known from its history,
/// not from the normal: an open surface has a back but no inside.
[[nodiscard]] ShadingPoint shading_point(const Scene& scene, const Ray& ray, const Hit& hit,
                                         bool inside);

/// Emission and the ambient terms of all lights.
[[nodiscard]] Rgb unshadowed_terms(const Scene& scene, const ShadingPoint& point);

/// kd (N.L) + ks highlight for a light in unit direction `to_light` with N.L = `cosine` > 0.
[[nodiscard]] Rgb reflected_fraction(const ShadingConventions& conventions,
                                     const ShadingPoint& point, const Vec3& to_light,
                                     double cosine);

}  // namespace alhazen
