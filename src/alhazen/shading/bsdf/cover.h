#pragma once
/// A layer that reflects a part of the light and leaves the rest to what lies below: a clear coat,
/// sheen, the face of a sheet. Its own reflection is a lobe; this is what it takes from others.
///
/// Source: Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF", 2017, section 4 (albedo
/// scaling).
/// Differs: only the side of the eye is scaled: see bsdf.h.

#include "alhazen/shading/bsdf/fresnel_term.h"

namespace alhazen {

struct Cover {
    enum class Kind { Ggx, Sheen };
    Kind kind = Kind::Ggx;
    double share = 1;  ///< how much of the surface it covers, or its largest colour (sheen)
    double alpha = 0;  ///< roughness; below kSmoothAlpha: smooth
    double f0 = 0.04, f90 = 1;  ///< of Schlick's formula (Ggx)

    /// What it leaves of light at this cosine to the normal, 0..1.
    [[nodiscard]] double transmittance(double cosine) const;
};

}  // namespace alhazen
