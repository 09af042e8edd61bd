#pragma once
/// Physical materials as a ray sees them where it is known what lies on both sides of a surface.
///
/// Source: Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", Eurographics 1994.
/// Differs: `turn_to_view` (material.h) takes air for the other side; here it may be any medium.

#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// As `turn_to_view`, with the cosine to the normal (0..1) on this side. `eta` is the index on this
/// side over that behind; a `wall` between two media reflects by it, not by the index of either.
/// `exact`: share of the reflection that rises to grazing incidence by Fresnel's equations for a
/// dielectric, the rest by Schlick's formula.
void turn_to_view_between(MaterialSample& sample, double cosine, double eta, bool wall,
                          double exact = 0.0);

/// What a surface does not reflect is shared by what lies below it.
void keep_below_reflection(MaterialSample& sample);

}  // namespace alhazen
