#pragma once
/// The choices of the viewer's page, from the tables of `alhazen list`.

#include <nlohmann/json.hpp>

#include "added_lights.h"
#include "alhazen/session/load.h"

namespace alhazen::viewer {

/// The response to /state without current work. The scene must have a camera and an aggregate.
/// `accelerator`: chosen at the start, maybe with a setting.
[[nodiscard]] nlohmann::ordered_json view_menus(const LoadedScene& loaded, const AddedLights& added,
                                                const std::string& accelerator);

}  // namespace alhazen::viewer
