#pragma once
/// Shading conventions of native scenes and of formats that define none.

#include "alhazen/scene_model/conventions.h"

namespace alhazen {

/// Pictures are sRGB, attenuation is not clamped, the air's index is 1.
[[nodiscard]] Conventions default_conventions();

}  // namespace alhazen
