#pragma once
/// What the eye makes of light by wavelength, as linear sRGB.
///
/// Source: CIE 15:2004, "Colorimetry" (the observer of 1931, illuminant D65); IEC 61966-2-1, 1999
/// (sRGB).
/// Differs: each channel is scaled, by less than 0.1 %, so that D65 is exactly white.
/// Conventions: wavelengths in nanometres; outside the range below nothing is seen. Spectra of
/// light are relative to that of white: 1 at 560 nm.

#include <array>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

inline constexpr double kShortestWave = 380.0, kLongestWave = 780.0;

/// D65: the light whose colour is (1, 1, 1).
[[nodiscard]] double white_light(double nm);
/// The integral of this, times the spectrum of light, is its colour. Some channels are below 0.
[[nodiscard]] Rgb response(double nm);
/// The same for the luminance: of white 1.
[[nodiscard]] double luminance_response(double nm);

/// A wavelength as `u` in [0, 1) chooses it, by how much of white light is seen there.
struct DrawnWave {
    double nm = 0;
    double white = 0;  ///< white_light
    Rgb color;         ///< response over the density, by nanometre, of the choice
};
[[nodiscard]] DrawnWave draw_wave(double u);
/// Four, each a quarter further on in that distribution than the one before.
struct DrawnWaves {
    Spectrum nm, white;
    std::array<Rgb, Spectrum::kCount> color;
};
[[nodiscard]] DrawnWaves draw_waves(double u);

}  // namespace alhazen
