#include "alhazen/scene_model/scene_description.h"

#include <fmt/format.h>

#include "alhazen/base/error.h"

namespace alhazen {

SceneDescription::SceneDescription() = default;
SceneDescription::SceneDescription(const SceneDescription&) = default;
SceneDescription::SceneDescription(SceneDescription&&) noexcept = default;
SceneDescription& SceneDescription::operator=(const SceneDescription&) = default;
SceneDescription& SceneDescription::operator=(SceneDescription&&) noexcept = default;
SceneDescription::~SceneDescription() = default;

void check_picture_size(int width, int height) {
    if (width >= 1 && height >= 1 && width <= kMaxPictureSide && height <= kMaxPictureSide) return;
    throw Error(ErrorKind::Usage, fmt::format("picture size {}x{} is out of range; each side must "
                                              "be 1 to {} pixels",
                                              width, height, kMaxPictureSide));
}

}  // namespace alhazen
