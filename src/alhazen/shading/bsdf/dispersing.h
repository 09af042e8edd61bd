#pragma once
/// Materials whose index depends on the wavelength.

#include "alhazen/shading/materials/material.h"
#include "alhazen/shading/spectrum/wavelengths.h"

namespace alhazen {

/// The material's own dispersion, or that of its Abbe number (KHR_materials_dispersion); empty if
/// its index is the same at all wavelengths.
[[nodiscard]] inline std::optional<Dispersion> dispersion_of(const Material& material) {
    if (material.dispersion) return material.dispersion;
    if (material.metallic_roughness && material.metallic_roughness->dispersion > 0.0) {
        return Dispersion{.abbe = 20.0 / material.metallic_roughness->dispersion};
    }
    return std::nullopt;
}

/// Index at the wavelength `nm` of a material whose index at line d is `index_d`.
[[nodiscard]] inline double index_at(const Material& material, double index_d, double nm) {
    const std::optional<Dispersion> dispersion = dispersion_of(material);
    return dispersion ? dispersion->index(index_d, nm) : index_d;
}

/// Indices at the four wavelengths of a material whose index at line d is `index_d`.
[[nodiscard]] inline Spectrum index_of(const Material& material, double index_d,
                                       const Wavelengths& waves) {
    if (!waves.is_spectral()) return Spectrum::all(index_d);
    const std::optional<Dispersion> dispersion = dispersion_of(material);
    return dispersion ? waves.index(index_d, *dispersion) : Spectrum::all(index_d);
}

}  // namespace alhazen
