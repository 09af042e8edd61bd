#pragma once
/// Shading conventions of native scenes and of formats that define none.

#include "alhazen/scene_model/conventions.h"

namespace alhazen {

/// The conventions: pictures are sRGB, attenuation is not clamped, the refractive index of air is
/// 1.
[[nodiscard]] Conventions default_conventions();

}  // namespace alhazen
