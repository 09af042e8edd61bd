#pragma once
/// The surfaces of lights with extent as parts of a scene.

#include <cstddef>
#include <optional>

#include "alhazen/scene_model/scene_description.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

/// Adds a part of emission AreaLight::radiance for each visible light; the part casts no shadow,
/// but blocks the connections of light transport, whose paths meet it as any surface. The lights
/// are marked as parts instead of as seen. The materials of these parts are the last of the
/// description, in the order of the lights.
void add_seen_lights(SceneDescription& description);

/// The material of a light's part after `add_seen_lights`; none if the light has no part.
[[nodiscard]] std::optional<MaterialId> material_of_light(const SceneDescription& description,
                                                          std::size_t light);

/// Gives the part of a light another surface; the light itself is unchanged.
void set_surface_of_light(SceneDescription& description, std::size_t light,
                          const LightExtent& extent);

}  // namespace alhazen
