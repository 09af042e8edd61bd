#pragma once
/// Checks that the operands of solids bound volumes. Internal to `validate`.

#include <string>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// Adds to `diagnostics` every part of a solid, or of an object that a solid uses, that bounds no
/// volume, and every empty intersection or difference. Accepts objects that contain themselves.
void validate_solids(const SceneDescription& description, Diagnostics& diagnostics);

/// The text "mesh 'name'", or "a mesh without a name".
[[nodiscard]] std::string in_words(const MeshDescription& mesh);

}  // namespace alhazen
