#pragma once
/// A colour map from dark blue over red to pale yellow, whose lightness grows evenly, so that the
/// order of values stays visible in greyscale.
///
/// Source: B. Ottosson, "A perceptual color space for image processing", 2020 (Oklab).
/// Differs: uses its own path through the space: lightness linear from 0.16 to 0.97, hue from 280
/// to 465 degrees, the largest chroma in sRGB up to 0.19.

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

/// The colour at `t`, clamped to [0, 1], as sRGB display values. NaN gives the colour of 0.
[[nodiscard]] Rgb heat_color(double t);

}  // namespace alhazen
