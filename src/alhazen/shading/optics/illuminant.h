#pragma once
/// Light sources by spectrum: black bodies and standard illuminants.
///
/// Source: Planck, "Ueber das Gesetz der Energieverteilung im Normalspectrum", Annalen der Physik
/// 309, 1901; CIE 15:2004, "Colorimetry", tables of A and D65.
/// Conventions: relative spectra, scaled to luminance 1; colours are linear sRGB.

#include <cstdint>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

enum class IlluminantKind : std::uint8_t { BlackBody, A, D65, E };

struct Illuminant {
    IlluminantKind kind = IlluminantKind::D65;
    double kelvin = 0;  ///< temperature of a black body
    double scale = 1;   ///< luminance

    friend bool operator==(const Illuminant&, const Illuminant&) = default;
};

}  // namespace alhazen
