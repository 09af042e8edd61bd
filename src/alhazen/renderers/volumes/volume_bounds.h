#pragma once
/// The volumes that surfaces bound.

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/scene/scene.h"
#include "alhazen/shading/materials/wall_material.h"

namespace alhazen {

/// True if a surface of the material may bound a volume without any other effect than those of the
/// indices on its sides.
[[nodiscard]] inline bool may_only_bound_volume(const Material& m) {
    if (!may_bound_volume(m)) return false;
    if (m.dielectric || m.metallic_roughness) return true;
    const auto none = [](const ColorInput& input) {
        return input.texture == kNoTexture && input.color.is_black();
    };
    return none(m.diffuse) && none(m.reflective);
}

/// True if a surface of the material may bound a volume of the index of the air without any other
/// effect: light passes it straight (ScatterPoint::is_null_boundary).
[[nodiscard]] inline bool may_be_null_boundary(const Material& m, double air) {
    return (m.index.texture != kNoTexture || m.index.value == air) && may_only_bound_volume(m);
}

/// The identity of the volume that a surface bounds: its part, or a solid of several media.
[[nodiscard]] inline std::uint64_t volume_number(const Surface& surface) {
    const SurfaceMedia& media = surface.media;
    return media.known ? media.solid : part_number({surface.part, surface.instance});
}

/// True if a path that crosses the surface enters the volume that it bounds.
[[nodiscard]] inline bool enters_volume(const ShadingPoint& point) {
    const SurfaceMedia& media = point.surface.media;
    return media.known ? media.after && !media.before : point.entering;
}

/// True at a wall between two media of one solid.
[[nodiscard]] inline bool is_wall(const Surface& surface) {
    return surface.media.before && surface.media.after;
}

/// The volume that a surface bounds; of a solid of several media with the medium behind the
/// surface or, where the solid ends, before it.
[[nodiscard]] inline Medium volume_of(const Scene& scene, const ShadingPoint& point) {
    const Surface& surface = point.surface;
    const std::uint64_t number = volume_number(surface);
    if (surface.media.known) {
        const std::optional<MaterialId>& id =
            surface.media.after ? surface.media.after : surface.media.before;
        if (!id) return {.part = number, .material = 0xFFFFFFFFu, .seen_by = point.seen_by};
        const MaterialSample medium = medium_at(scene, surface, *id);
        return {number, medium.index, medium.absorption, static_cast<std::uint32_t>(*id),
                point.seen_by};
    }
    Medium volume{number, point.material->index, point.material->absorption,
                  static_cast<std::uint32_t>(volume_material(surface)), point.seen_by};
    if (surface.volume) {
        volume.absorption = medium_at(scene, surface, *surface.volume).absorption;
    }
    return volume;
}

}  // namespace alhazen
