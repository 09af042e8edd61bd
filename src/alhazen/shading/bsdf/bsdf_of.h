#pragma once
/// Parts of `bsdf_of` (bsdf.h): materials as lobes. docs/reference/materials.md states what becomes
/// of what.

#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

/// Index on the side of the view over that behind, of a material with this index.
[[nodiscard]] double eta_at(const BsdfPlace& place, double index);

/// A mirror, or its rough form; the roughness, 0..1, is the root of the alpha of Ggx.
[[nodiscard]] Lobe reflection_lobe(double roughness, const FresnelTerm& fresnel);

/// The boundary of a clear body, smooth or rough.
[[nodiscard]] Lobe boundary_lobe(double roughness, double eta, const Spectrum& reflection,
                                 const Spectrum& transmission);

[[nodiscard]] Bsdf bsdf_of_metallic_roughness(const Material& material,
                                              const MetallicRoughness& parameters,
                                              std::span<const Texture> textures,
                                              const SurfaceLookup& lookup, const BsdfPlace& place);

}  // namespace alhazen
