#pragma once
/// The material of a wall that a part of one material cuts into a volume of another.

#include "alhazen/shading/materials/material.h"

namespace alhazen {

/// True if light enters its volumes or sheets, not just passes through holes.
[[nodiscard]] bool is_clear(const Material& material);

/// The surface of `surface`, with colours, roughness and layers, on the volume of `volume`: its
/// index, dispersion, absorption and scattering. `surface` itself if one of them is not clear.
[[nodiscard]] Material wall_material(const Material& surface, const Material& volume);

}  // namespace alhazen
