#pragma once
/// What the lobes of a BSDF do to polarised light. Mirrors, boundaries of clear bodies and single
/// microfacets have Fresnel's matrix; all else depolarises.
///
/// Source: that of optics/polarization.h; Wilkie and Weidlich 2012 (microfacets polarise as mirrors
/// across the half vector, what is scattered several times is not polarised).
/// Differs: reflectances by Schlick's formula are those of a clear body with the same reflectance
/// at normal incidence, as far as polarisation goes; thin films those of what they lie on.
/// Conventions: the frame is that of the plane through the view and the direction, x across it: all
/// lobes have it in common, and a sum of lobes is a sum of matrices of one form.

#include "alhazen/shading/bsdf/lobe.h"
#include "alhazen/shading/optics/polarization.h"

namespace alhazen {

/// BoundaryMueller at each wavelength.
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

/// Light that a lobe sends from a direction to the view, and the part that has a matrix.
struct PolarizedValue {
    Spectrum all, part;
    PlaneMueller matrix;  ///< of `part`
};

/// Of radiance. Of singular lobes the share of what comes from the mirror direction (direction.z
/// above 0) or from the refracted one, of others `value`.
[[nodiscard]] PolarizedValue polarized_value(const Lobe& lobe, const Vec3& view,
                                             const Vec3& direction);

}  // namespace alhazen
