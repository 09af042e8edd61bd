#pragma once
/// The volumes that surfaces bound.

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/materials/wall_material.h"

namespace alhazen {

/// True if a surface of the material may bound a volume of the index of the air without any other
/// effect: light passes it straight.
[[nodiscard]] inline bool may_pass_straight(const Material& m, double air) {
    if (!may_bound_volume(m) || (m.index.texture == kNoTexture && m.index.value != air)) {
        return false;
    }
    if (m.dielectric || m.metallic_roughness) return true;
    const auto none = [](const ColorInput& input) {
        return input.texture == kNoTexture && input.color.is_black();
    };
    return none(m.diffuse) && none(m.reflective);
}

/// The volume that a surface bounds.
[[nodiscard]] inline Medium volume_of(const Scene& scene, const ShadingPoint& point) {
    const Surface& surface = point.surface;
    Medium volume{part_number({surface.part, surface.instance}), point.material->index,
                  point.material->absorption, static_cast<std::uint32_t>(volume_material(surface))};
    if (surface.volume) {
        volume.absorption = medium_at(scene, surface, *surface.volume).absorption;
    }
    return volume;
}

}  // namespace alhazen
