#pragma once
/// Parts of `bsdf_of` (bsdf.h): conversion of materials to lobes, as described in
/// docs/reference/materials.md.

#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

/// Index on the side of the view over that behind, for a material of this index.
[[nodiscard]] double eta_at(const BsdfPlace& place, double index);

/// A mirror, or a rough reflection; `roughness`, 0..1, is the square root of Ggx alpha.
[[nodiscard]] Lobe reflection_lobe(double roughness, const FresnelTerm& fresnel);

/// The smooth or rough boundary of a clear body.
[[nodiscard]] Lobe boundary_lobe(double roughness, const BsdfPlace& place, double index,
                                 const Spectrum& reflection, const Spectrum& transmission);

[[nodiscard]] Bsdf bsdf_of_metallic_roughness(const Material& material,
                                              const MetallicRoughness& parameters,
                                              std::span<const Texture> textures,
                                              const SurfaceLookup& lookup, const BsdfPlace& place);

}  // namespace alhazen
