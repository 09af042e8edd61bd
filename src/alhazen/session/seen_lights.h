#pragma once
/// The surfaces of lights with extent as parts of a scene.

#include <cstddef>
#include <optional>

#include "alhazen/scene_model/scene_description.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

/// Adds a part of emission AreaLight::radiance for each light that is seen; it throws no shadow.
/// The lights are then marked as parts, no longer as seen.
/// The materials of these parts are the last of the description, in the order of the lights.
void add_seen_lights(SceneDescription& description);

/// Of the part of a light, after `add_seen_lights`; none where it has no part.
[[nodiscard]] std::optional<MaterialId> material_of_light(const SceneDescription& description,
                                                          std::size_t light);

/// Gives the part of such a light another surface; the light itself stays as it is.
void set_surface_of_light(SceneDescription& description, std::size_t light,
                          const LightExtent& extent);

}  // namespace alhazen
