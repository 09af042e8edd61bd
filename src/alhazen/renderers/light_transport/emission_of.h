#pragma once
/// The radiance that a surface emits towards the ray that hit it, at the wavelengths of a path.
///
/// Conventions: a single-sided surface emits on its front only, as its emitter does (emitter.h); an
/// unlit one shows its colour on both sides and lights nothing.

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

[[nodiscard]] inline Spectrum emission_of(const Scene& scene, const ShadingPoint& point,
                                          const Wavelengths& waves) {
    const Rgb& color = point.material->emission;
    if (color.is_black()) return waves.emission(color);
    const Material& material =
        scene.materials[static_cast<std::size_t>(point.surface.materials[0])];
    const bool one_sided = !material.double_sided && !point.material->unlit;
    if (one_sided && dot(point.surface.normal, point.view) < 0.0) return waves.emission(Rgb{});
    return waves.is_spectral() ? waves.emission(color, material.illuminant) : waves.emission(color);
}

}  // namespace alhazen
