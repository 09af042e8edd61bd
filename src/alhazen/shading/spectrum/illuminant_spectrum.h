#pragma once
/// The spectra of illuminants, and their colours.
///
/// Source: optics/illuminant.h.

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/optics/illuminant.h"

namespace alhazen {

/// Spectral radiance relative to white light (color_matching.h); the luminance is
/// Illuminant::scale.
[[nodiscard]] double radiance_of(const Illuminant& illuminant, double nm);

/// Linear sRGB colour. Channels below 0 (lights outside the gamut, redder than sRGB) are kept.
[[nodiscard]] Rgb color_of(const Illuminant& illuminant);
/// A colour without negative channels, of the same luminance; `color_of` if that has none.
[[nodiscard]] Rgb color_in_gamut(const Illuminant& illuminant);

}  // namespace alhazen
