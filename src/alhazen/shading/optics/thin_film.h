#pragma once
/// Reflection of a film thinner than the light is long: the two sides interfere and give colours.
///
/// Source: Belcour and Barla, "A Practical Extension to Microfacet Theory for the Modeling of
/// Varying Iridescence", SIGGRAPH 2017, equations 3 to 13 and the fit of the sensitivities of its
/// supplemental material; Khronos, KHR_materials_iridescence (the base by its reflectance).
/// Differs: the lower side by Schlick's formula, and polarisations are not kept apart; terms of the
/// Airy series up to the second, as there; negative results are cut off.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// Reflectance at `cosine` (0..1) outside, in air. `base`: of what is below the film, at normal
/// incidence, 0..1; `thickness_nm` >= 0. A film of no thickness gives the base by Schlick's
/// formula.
[[nodiscard]] Rgb thin_film_reflectance(double cosine, double film_index, double thickness_nm,
                                        const Rgb& base);
/// The same at one wavelength, with all terms of the series.
[[nodiscard]] double thin_film_reflectance_at(double nm, double cosine, double film_index,
                                              double thickness_nm, double base);

}  // namespace alhazen
