#pragma once
/// The part of a scene that has no geometry: materials, textures, lights, cameras.
///
/// Internal to `compile`.

#include <cstdint>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Fills in what the description says of them.
void compile_materials(const SceneDescription& description, Scene& scene);

/// Of all pictures, each once, however many textures show it.
[[nodiscard]] std::uint64_t texture_bytes(const std::vector<Texture>& textures);

}  // namespace alhazen
