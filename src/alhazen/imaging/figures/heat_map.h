#pragma once
/// Colours for numbers: dark blue over red to pale yellow, lightness growing evenly, so that more
/// looks like more, in grey too.
///
/// Source: B. Ottosson, "A perceptual color space for image processing", 2020 (Oklab).
/// Differs: nothing; the path through the space is our own: lightness 0.16 to 0.97 in a straight
/// line, hue from 280 to 465 degrees, as colourful as sRGB allows, but at most 0.19.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// The colour at `t`, clamped to [0, 1], as sRGB display values. NaN gives the colour of 0.
[[nodiscard]] Rgb heat_color(double t);

}  // namespace alhazen
