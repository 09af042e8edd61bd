#pragma once
/// How much light a smooth boundary reflects.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, sections 1.5.2 (dielectrics)
/// and 14.2 (metals); Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering",
/// Eurographics 1994.
/// Conventions: cosines are to the normal on the side of the ray, 0..1 (outside of it: clamped).
/// Light is unpolarised before and taken as unpolarised after; polarization.h knows better.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Share reflected where a ray goes on in a medium whose index is `1 / eta` times that of its own;
/// 1 beyond the critical angle. `cosine_behind`: of the refracted ray, 0 where there is none.
[[nodiscard]] double dielectric_reflectance(double cosine, double eta, double& cosine_behind);
[[nodiscard]] double dielectric_reflectance(double cosine, double eta);

/// Of a conductor with index `n + i k` relative to the medium of the ray.
[[nodiscard]] double conductor_reflectance(double cosine, double n, double k);

/// At normal incidence, of relative index `n` (or 1 / n).
[[nodiscard]] double normal_reflectance_of(double n);

/// (1 - cosine)^5.
[[nodiscard]] double schlick_weight(double cosine);

}  // namespace alhazen
