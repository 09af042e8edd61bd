#pragma once
/// What the page of the viewer can choose from, out of the tables of `alhazen list`.

#include <nlohmann/json.hpp>

#include "alhazen/session/load.h"

namespace alhazen::viewer {

/// The answer to /state, without what changes from moment to moment. The scene must have a camera
/// and an aggregate.
[[nodiscard]] nlohmann::ordered_json view_menus(const LoadedScene& loaded);

}  // namespace alhazen::viewer
