#pragma once
/// The part of a scene without geometry: materials, textures, lights, cameras.
///
/// Internal to `compile`.

#include <cstdint>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Sets materials, textures, lights, cameras, conventions and background.
void compile_materials(const SceneDescription& description, Scene& scene);

/// Bytes of all images and their pyramids, each counted once.
[[nodiscard]] std::uint64_t texture_bytes(const std::vector<Texture>& textures);

}  // namespace alhazen
