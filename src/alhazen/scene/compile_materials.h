#pragma once
/// Compiles the non-geometric part of a scene: materials, textures, lights, cameras. Internal to
/// `compile`.

#include <cstdint>

#include "alhazen/scene/scene.h"

namespace alhazen {

/// Adds materials, textures, lights and cameras of the description to the scene.
void compile_materials(const SceneDescription& description, Scene& scene);

/// Bytes of all images, each counted once, however many textures share it.
[[nodiscard]] std::uint64_t texture_bytes(const std::vector<Texture>& textures);

}  // namespace alhazen
