#pragma once
/// Values of a material's inputs at a point.

#include "alhazen/shading/materials/material.h"

namespace alhazen {

[[nodiscard]] Rgba texel_at(TextureId id, std::span<const Texture> textures,
                            const SurfaceLookup& lookup);
[[nodiscard]] double channel_of(const Rgba& texel, Channel channel);
[[nodiscard]] Rgb color_at(const ColorInput& input, std::span<const Texture> textures,
                           const SurfaceLookup& lookup);
[[nodiscard]] double value_at(const ScalarInput& input, std::span<const Texture> textures,
                              const SurfaceLookup& lookup);

/// False if the material is the same everywhere, apart from vertex colours.
[[nodiscard]] bool reads_textures(const Material& material);
/// True if the material depends on texture coordinates or on their directions in the surface.
[[nodiscard]] bool reads_coordinates(const Material& material);
[[nodiscard]] bool has_grooves(const Material& material);
/// True if its grooves are at an angle to the tangent: the BSDF depends on BsdfPlace::mirrored.
[[nodiscard]] bool has_turned_grooves(const Material& material);

/// The metallic-roughness parameters as terms of Whitted's equation; docs/reference/materials.md
/// derives them.
[[nodiscard]] MaterialSample evaluate_metallic_roughness(const Material& material,
                                                         const MetallicRoughness& parameters,
                                                         std::span<const Texture> textures,
                                                         const SurfaceLookup& lookup);

/// A conductor or dielectric as terms of Whitted's equation: a metal of its colour at normal
/// incidence, or a clear volume.
[[nodiscard]] MaterialSample evaluate_physical_constants(const Material& material,
                                                         std::span<const Texture> textures,
                                                         const SurfaceLookup& lookup);

}  // namespace alhazen
