#pragma once
/// Shading conventions of native scenes and of formats that define none.

#include "alhazen/shading/shading_conventions.h"

namespace alhazen {

/// sRGB images, unclamped attenuation, refractive index 1 for air.
[[nodiscard]] ShadingConventions default_conventions();

}  // namespace alhazen
