#pragma once
/// The spectra of illuminants, and their colours.
///
/// Source: optics/illuminant.h.

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/optics/illuminant.h"

namespace alhazen {

/// In the scale of white light (color_matching.h): the luminance is Illuminant::scale.
[[nodiscard]] double radiance_of(const Illuminant& illuminant, double nm);

/// What is seen of it. Channels that lie below 0 (of what is redder than sRGB can say) are.
[[nodiscard]] Rgb color_of(const Illuminant& illuminant);

}  // namespace alhazen
