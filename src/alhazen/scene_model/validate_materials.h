#pragma once
/// Validation of materials and textures. Internal to this folder.

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Adds to `diagnostics`: textures without a picture or with unusable coordinates, numbers that are
/// not finite or out of range, ids of missing textures.
void validate_materials(const SceneDescription& description, Diagnostics& diagnostics);

}  // namespace alhazen
