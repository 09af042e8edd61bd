#pragma once
/// Fresnel reflection of a sample between two known media.
///
/// Source: Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", Eurographics 1994.
/// Differs: `turn_to_view` (material.h) assumes air on the other side; here it may be any medium.

#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// As `turn_to_view`, with the cosine to the normal (0..1) on this side. `eta` is the index on this
/// side over that behind. A `wall` between two media has the reflectance of `eta`, not of the
/// material's index. `exact`: share of the reflection's rise to grazing incidence that follows
/// Fresnel's equations for a dielectric; the rest follows Schlick's formula.
void turn_to_view_between(MaterialSample& sample, double cosine, double eta, bool wall,
                          double exact = 0.0);

/// Scales the terms below the reflection by the share that is not reflected.
void keep_below_reflection(MaterialSample& sample);

}  // namespace alhazen
