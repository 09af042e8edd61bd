#pragma once
/// Reflectance of smooth boundaries.
///
/// Source: Born and Wolf, "Principles of Optics", 7th edition, 1999, sections 1.5.2 (dielectrics)
/// and 14.2 (metals); Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering",
/// Eurographics 1994.
/// Conventions: cosines are to the normal on the side of the ray, 0..1 (clamped). Light is
/// unpolarised; polarization.h has the polarised case.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Reflectance of a boundary to a medium whose index is `1 / eta` times that of the ray's own; 1
/// beyond the critical angle. `cosine_behind`: cosine of the refracted ray, 0 if there is none.
[[nodiscard]] double dielectric_reflectance(double cosine, double eta, double& cosine_behind);
[[nodiscard]] double dielectric_reflectance(double cosine, double eta);

/// Reflectance of a conductor with index `n + i k` relative to the medium of the ray.
[[nodiscard]] double conductor_reflectance(double cosine, double n, double k);

/// Reflectance at normal incidence for the relative index `n` (or 1 / n).
[[nodiscard]] double normal_reflectance_of(double n);

/// (1 - cosine)^5.
[[nodiscard]] double schlick_weight(double cosine);

}  // namespace alhazen
