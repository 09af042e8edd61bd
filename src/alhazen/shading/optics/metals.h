#pragma once
/// Named metals, with their complex indices of refraction at red, green and blue.
///
/// Source: Johnson and Christy, "Optical Constants of the Noble Metals", Phys. Rev. B 6, 1972
/// (copper, gold, silver) and "Optical Constants of Transition Metals", Phys. Rev. B 9, 1974
/// (chromium, iron, nickel, titanium); Rakic, "Algorithm for the Determination of Intrinsic Optical
/// Constants of Metal Films", Applied Optics 34, 1995 (aluminium); the tables of them in
/// Polyanskiy, refractiveindex.info (public domain). Linearly interpolated at 611.4, 549.1 and
/// 464.3 nm, the dominant wavelengths of the primaries of sRGB, and rounded to three digits.
/// Differs: three wavelengths stand for three channels, in place of integrals of the spectrum: up to
/// 11 % of a channel of gold's reflectance, 6 % of copper's.

#include <optional>
#include <span>
#include <string_view>

#include "alhazen/imaging/image/rgb.h"

namespace alhazen {

struct MetalAtWave {
    double nm, index, extinction;
};

struct Metal {
    std::string_view name;
    Rgb index, extinction;
    std::span<const MetalAtWave>
        by_wave;  ///< as measured, ascending; from below 382 to above 780 nm
};

/// Sorted by name.
[[nodiscard]] std::span<const Metal> metals();
/// Linear between the wavelengths of the table, constant beyond.
[[nodiscard]] MetalAtWave constants_at(const Metal& metal, double nm);
[[nodiscard]] const Metal* find_metal(std::string_view name);

}  // namespace alhazen
