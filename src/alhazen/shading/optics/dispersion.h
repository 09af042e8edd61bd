#pragma once
/// Index of refraction by wavelength: Sellmeier's formula, an Abbe number, or a named material.
///
/// Source: Sellmeier, "Zur Erklaerung der abnormen Farbenfolge im Spectrum einiger Substanzen",
/// Annalen der Physik 219, 1871; Cauchy, "Memoire sur la dispersion de la lumiere", 1836; the table
/// of materials: dispersion.cpp.
/// Conventions: wavelengths in nanometres, in vacuum; poles of Sellmeier's terms in square
/// micrometres, as catalogues give them. Lines of Fraunhofer: F 486.13, d 587.56, C 656.27 nm.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace alhazen {

inline constexpr double kLineF = 486.1327, kLineD = 587.5618, kLineC = 656.2725;

/// n^2 = 1 + sum over i of strength[i] l^2 / (l^2 - pole[i]), l in micrometres.
struct Sellmeier {
    std::array<double, 4> strength{}, pole{};

    [[nodiscard]] double index(double nm) const;
    friend bool operator==(const Sellmeier&, const Sellmeier&) = default;
};

/// How the index of a material depends on the wavelength.
struct Dispersion {
    /// Above 0: the Abbe number (n_d - 1) / (n_F - n_C) of Cauchy's n = a + b / l^2 through the
    /// material's index at line d. 0: `sellmeier` applies.
    double abbe = 0;
    Sellmeier sellmeier;
    std::string name;  ///< in the table of glasses; empty: given by the numbers

    /// `index_d`: the material's index at line d; used with `abbe` only.
    [[nodiscard]] double index(double index_d, double nm) const;
    friend bool operator==(const Dispersion&, const Dispersion&) = default;
};

/// A clear material with a name.
struct NamedGlass {
    std::string_view name;
    Sellmeier sellmeier;
};
/// Sorted by name.
[[nodiscard]] std::span<const NamedGlass> named_glasses();
/// Finds a glass by name, case-insensitively; null if there is none.
[[nodiscard]] const NamedGlass* find_glass(std::string_view name);

}  // namespace alhazen
