#pragma once
/// The textures of a material.

#include <vector>

#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// Those that the material reads, each as often as it is named.
[[nodiscard]] std::vector<TextureId> textures_of(const Material& material);

}  // namespace alhazen
