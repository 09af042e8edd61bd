#pragma once
/// Reflectance of a film of about a wavelength's thickness, coloured by interference.
///
/// Source: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of
/// Varying Iridescence", SIGGRAPH 2017, equations 3 to 13 and the fit of the sensitivities of its
/// supplemental material; Khronos, KHR_materials_iridescence (the base by its reflectance).
/// Differs: the lower side uses Schlick's formula, and polarisations are not separated; the Airy
/// series is truncated after the second term, as there; negative results are clamped to 0.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Reflectance at `cosine` (0..1) outside, in air. `base`: reflectance below the film at normal
/// incidence, 0..1; `thickness_nm` >= 0. At thickness 0 the result is Schlick's formula for the
/// base.
[[nodiscard]] Rgb thin_film_reflectance(double cosine, double film_index, double thickness_nm,
                                        const Rgb& base);
/// The same at one wavelength, with all terms of the series; at normal incidence Airy's
/// reflectance, down to thickness 0.
[[nodiscard]] double thin_film_reflectance_at(double nm, double cosine, double film_index,
                                              double thickness_nm, double base);

}  // namespace alhazen
