#pragma once
/// Colour matching: linear sRGB of light by wavelength.
///
/// Source: CIE 15:2004, "Colorimetry" (the observer of 1931, illuminant D65); IEC 61966-2-1, 1999
/// (sRGB).
/// Differs: each channel is scaled, by less than 0.1 %, so that D65 is exactly white.
/// Conventions: wavelengths in nanometres; the response is 0 outside the range below. Spectra of
/// light are relative to that of white: 1 at 560 nm.

#include <array>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

inline constexpr double kShortestWave = 380.0, kLongestWave = 780.0;

/// Spectrum of D65, the light whose colour is (1, 1, 1).
[[nodiscard]] double white_light(double nm);
/// Colour response: its integral times a spectrum of light is the colour. Some channels are
/// negative.
[[nodiscard]] Rgb response(double nm);
/// Luminance response; the luminance of white is 1.
[[nodiscard]] double luminance_response(double nm);
/// The luminance of a colour.
[[nodiscard]] inline double luminance_of(const Rgb& color) {
    return 0.2126729 * color.r + 0.7151522 * color.g + 0.0721750 * color.b;
}

/// A wavelength sampled by `u` in [0, 1), with the density of the sum of the absolute channels of
/// white light's response.
struct DrawnWave {
    double nm = 0;
    double white = 0;  ///< white_light
    Rgb color;         ///< response over the density (per nanometre)
};
[[nodiscard]] DrawnWave draw_wave(double u);
/// Four wavelengths at equal distances, a quarter each, in the CDF of that density.
struct DrawnWaves {
    Spectrum nm, white;
    std::array<Rgb, Spectrum::kCount> color;
};
[[nodiscard]] DrawnWaves draw_waves(double u);

}  // namespace alhazen
