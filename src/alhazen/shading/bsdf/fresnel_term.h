#pragma once
/// The Fresnel term of a reflecting lobe: a closed variant.
///
/// Source: as of its parts (optics/fresnel.h, optics/thin_film.h); Schlick 1994.

#include <variant>

#include "alhazen/shading/spectrum/spectrum.h"

namespace alhazen {

/// f0 + (f90 - f0) (1 - cosine)^5. All 1: an ideal mirror.
struct SchlickTerm {
    Spectrum f0{1, 1, 1, 1}, f90{1, 1, 1, 1};
};
/// 1 at every angle: the weight of the lobe is all of the reflectance. `normal` has that weight:
/// polarisation is that of a clear body which reflects it at normal incidence.
struct ConstantTerm {
    Spectrum normal{1, 1, 1, 1};
};
/// Exact, of a complex index relative to the medium outside.
struct ConductorTerm {
    Spectrum index, extinction;
};
/// Exact, where nothing that is transmitted matters. `eta`: index outside over inside.
struct DielectricTerm {
    double eta = 1;
};
/// A thin film, of which `share` is there, over a base that Schlick's formula describes.
struct FilmTerm {
    SchlickTerm base;
    double share = 1, index = 1.3, thickness_nm = 400;
    Spectrum nm;  ///< the wavelengths; 0: channels of colour
};

using FresnelTerm =
    std::variant<SchlickTerm, ConductorTerm, DielectricTerm, FilmTerm, ConstantTerm>;

/// Share reflected at this cosine to the normal (of the microfacet).
[[nodiscard]] Spectrum reflectance(const FresnelTerm& term, double cosine);

/// A Schlick term that is near it for views at `cosine`. Exact of a Schlick term.
[[nodiscard]] SchlickTerm schlick_fit(const FresnelTerm& term, double cosine);

/// Mean over the hemisphere, weighted by the cosine: does not depend on the view.
[[nodiscard]] Spectrum mean_reflectance(const FresnelTerm& term);

}  // namespace alhazen
