#pragma once
/// The index of refraction by wavelength: by Sellmeier's formula, by Abbe's number, or of a
/// material by name.
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
    /// Above 0: Cauchy's n = a + b / l^2 through the index of the material at line d, with this
    /// number of Abbe, (n_d - 1) / (n_F - n_C). 0: `sellmeier`.
    double abbe = 0;
    Sellmeier sellmeier;
    std::string name;  ///< of the table of glasses; empty: by the numbers

    /// `index_d`: of the material at line d; heeded with `abbe` alone.
    [[nodiscard]] double index(double index_d, double nm) const;
    friend bool operator==(const Dispersion&, const Dispersion&) = default;
};

/// A clear material by name.
struct NamedGlass {
    std::string_view name;
    Sellmeier sellmeier;
};
/// In the order of their names.
[[nodiscard]] std::span<const NamedGlass> named_glasses();
/// Without regard to case; null: there is none of this name.
[[nodiscard]] const NamedGlass* find_glass(std::string_view name);

}  // namespace alhazen
