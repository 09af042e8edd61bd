#pragma once
/// The surfaces of lights with extent as parts of a scene.

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Adds a part of emission AreaLight::radiance for each light that is seen; it throws no shadow.
/// The lights are then marked as parts, no longer as seen.
void add_seen_lights(SceneDescription& description);

}  // namespace alhazen
