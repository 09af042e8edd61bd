#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

SceneDescription::SceneDescription() = default;
SceneDescription::SceneDescription(const SceneDescription&) = default;
SceneDescription::SceneDescription(SceneDescription&&) noexcept = default;
SceneDescription& SceneDescription::operator=(const SceneDescription&) = default;
SceneDescription& SceneDescription::operator=(SceneDescription&&) noexcept = default;
SceneDescription::~SceneDescription() = default;

}  // namespace alhazen
