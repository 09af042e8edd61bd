#pragma once
/// The Fresnel term of a reflecting lobe: a closed variant.
///
/// Source: those of the alternatives (optics/fresnel.h, optics/thin_film.h); Schlick 1994.

#include <variant>

#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// f0 + (f90 - f0) (1 - cosine)^5. With both 1: an ideal mirror.
struct SchlickTerm {
    Spectrum f0{1, 1, 1, 1}, f90{1, 1, 1, 1};
};
/// Reflectance 1 at every angle: the weight of the lobe holds the reflectance. `normal` is that
/// weight; polarisation is that of a clear body with this reflectance at normal incidence.
struct ConstantTerm {
    Spectrum normal{1, 1, 1, 1};
};
/// Exact, for a complex index relative to the outer medium.
struct ConductorTerm {
    Spectrum index, extinction;
};
/// Exact, for lobes without transmission. `eta`: index outside over inside.
struct DielectricTerm {
    double eta = 1;
};
/// A thin film on a fraction `share` of a base with Schlick's reflectance.
struct FilmTerm {
    SchlickTerm base;
    double share = 1, index = 1.3, thickness_nm = 400;
    Spectrum nm;  ///< the wavelengths; 0: colour channels
};

using FresnelTerm =
    std::variant<SchlickTerm, ConductorTerm, DielectricTerm, FilmTerm, ConstantTerm>;

/// Reflectance at this cosine to the normal of the microfacet.
[[nodiscard]] Spectrum reflectance(const FresnelTerm& term, double cosine);

/// A Schlick term fitted to `term` for views at `cosine`; exact for a Schlick term.
[[nodiscard]] SchlickTerm schlick_fit(const FresnelTerm& term, double cosine);

/// Cosine-weighted mean of the reflectance over the hemisphere.
[[nodiscard]] Spectrum mean_reflectance(const FresnelTerm& term);

}  // namespace alhazen
