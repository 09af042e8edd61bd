#pragma once
/// What a surface emits, at the wavelengths of a path.

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

[[nodiscard]] inline Spectrum emission_of(const Scene& scene, const ShadingPoint& point,
                                          const Wavelengths& waves) {
    const Rgb& color = point.material->emission;
    if (!waves.is_spectral() || color.is_black()) return waves.emission(color);
    const auto material = static_cast<std::size_t>(point.surface.materials[0]);
    return waves.emission(color, scene.materials[material].illuminant);
}

}  // namespace alhazen
