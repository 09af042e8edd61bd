#pragma once
/// The scattering lobes of surfaces: a closed variant of plain structs.
///
/// ADD A LOBE HERE: a file pair with the struct, and an entry in `Lobe`. Each has
///   - kSingular: scatters into single directions, which have no density; kTransmits: may scatter
///     below the surface;
///   - sample(view, choice, u, transport) and albedo(view), as in class Bsdf;
///   - optionally, unless singular, direction(view, choice, u): the direction of `sample`, cheaper;
///   - unless singular, value(view, direction, transport) and density(view, direction).
/// Conventions: those of bsdf.h; a view has z > 0, a direction z != 0. The density integrates to 1,
/// or to the share of samples that are not absorbed, and is above 0 where the value is.

#include <variant>

#include "alhazen/shading/bsdf/covered_matt.h"
#include "alhazen/shading/bsdf/lambert.h"
#include "alhazen/shading/bsdf/mirror.h"
#include "alhazen/shading/bsdf/oren_nayar.h"
#include "alhazen/shading/bsdf/phong.h"
#include "alhazen/shading/bsdf/rough_dielectric.h"
#include "alhazen/shading/bsdf/rough_reflection.h"
#include "alhazen/shading/bsdf/sheen.h"
#include "alhazen/shading/bsdf/smooth_dielectric.h"

namespace alhazen {

using Lobe =
    std::variant<Lambert, LambertTransmission, OrenNayar, CoveredMatt, Mirror, SmoothDielectric,
                 ThinSheet, RoughReflection, RoughSheet, RoughDielectric, Phong, BlinnPhong, Sheen>;

}  // namespace alhazen
