#pragma once
/// Effect of the lobes of a BSDF on polarised light. Mirrors, boundaries of clear bodies and single
/// microfacets have Fresnel's Mueller matrix; all other scattering depolarises.
///
/// Source: that of optics/polarization.h; Wilkie and Weidlich 2012 (microfacets polarise as mirrors
/// across the half vector, multiple scattering is unpolarised).
/// Differs: a reflectance by Schlick's formula polarises as a clear body of the same reflectance at
/// normal incidence; a thin film as its base.
/// Conventions: the frame is that of the plane through the view and the direction, x across it. It
/// is common to all lobes, so that a sum of lobes is a sum of matrices of one form.

#include "alhazen/shading/bsdf/lobe.h"
#include "alhazen/shading/optics/polarization.h"

namespace alhazen {

/// A BoundaryMueller for each wavelength.
struct PlaneMueller {
    Spectrum q, d, c, e;

    [[nodiscard]] static PlaneMueller all(const BoundaryMueller& m) {
        return {Spectrum::all(m.q), Spectrum::all(m.d), Spectrum::all(m.c), Spectrum::all(m.e)};
    }
    void set(int i, const BoundaryMueller& m) {
        q[i] = m.q;
        d[i] = m.d;
        c[i] = m.c;
        e[i] = m.e;
    }
};

[[nodiscard]] PlaneMueller polarization_of(const FresnelTerm& term, double cosine);

/// Light that a lobe scatters from a direction to the view, and the part of it that has a matrix.
struct PolarizedValue {
    Spectrum all, part;
    PlaneMueller matrix;  ///< matrix of `part`
};

/// For radiance. Singular lobes: the share of the light from the mirror direction (direction.z
/// above 0) or from the refracted direction. Others: `value`.
[[nodiscard]] PolarizedValue polarized_value(const Lobe& lobe, const Vec3& view,
                                             const Vec3& direction);

}  // namespace alhazen
