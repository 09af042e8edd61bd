#pragma once
/// What the four numbers of a Spectrum stand for along a path, and how colours become those
/// numbers and they a colour.
///
/// Conventions: colours are linear sRGB.

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

class Wavelengths {
  public:
    /// The channels of colours.
    Wavelengths() = default;

    /// Of a surface or a filter.
    [[nodiscard]] Spectrum reflectance(const Rgb& color) const { return channels(color); }
    /// Of a light, whose white is that of the picture.
    [[nodiscard]] Spectrum emission(const Rgb& color) const { return channels(color); }
    /// Coefficients of Beer's law, of any size.
    [[nodiscard]] Spectrum absorption(const Rgb& color) const { return channels(color); }

    /// Of a metal, at the wavelengths that stand for the channels.
    [[nodiscard]] Spectrum optical_constant(const Rgb& value) const { return channels(value); }

    /// The colour that light adds to the picture.
    [[nodiscard]] Rgb color(const Spectrum& light) const { return {light.a, light.b, light.c}; }

  private:
    [[nodiscard]] static Spectrum channels(const Rgb& c) { return {c.r, c.g, c.b, c.b}; }
};

/// For what knows of no path.
inline const Wavelengths kColorChannels;

}  // namespace alhazen
