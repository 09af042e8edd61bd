#pragma once
/// The volumes of materials, and the material of a wall that a part of one material cuts into a
/// volume of another.

#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// True if light enters its volumes or sheets, not just passes through holes.
[[nodiscard]] inline bool is_clear(const Material& m) {
    if (m.conductor || m.dielectric) return m.dielectric.has_value();
    if (const auto& p = m.metallic_roughness) return p->transmission.value > 0.0;
    return m.transmissive.texture != kNoTexture || !m.transmissive.color.is_black();
}

/// True for a metallic-roughness material whose surfaces are thin sheets.
[[nodiscard]] inline bool is_sheet(const Material& m) {
    return !m.conductor && !m.dielectric && m.metallic_roughness &&
           !(m.metallic_roughness->thickness.value > 0.0);
}

/// True if a surface of the material may bound a volume that light enters along the refracted
/// direction; false for opaque ones and thin sheets.
[[nodiscard]] inline bool may_bound_volume(const Material& m) {
    return is_clear(m) && !is_sheet(m);
}

/// True if light enters volumes of the material, if only by diffuse transmission.
[[nodiscard]] inline bool has_inside(const Material& m) {
    if (may_bound_volume(m)) return true;
    return !m.conductor && !m.dielectric && m.metallic_roughness && !is_sheet(m) &&
           m.metallic_roughness->diffuse_transmission.share.value > 0.0;
}

/// The surface of `surface`, with colours, roughness and layers, on the volume of `volume`: its
/// index, dispersion, absorption and scattering. `surface` itself if one of them is not clear.
[[nodiscard]] Material wall_material(const Material& surface, const Material& volume);

}  // namespace alhazen
