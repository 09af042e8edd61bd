#pragma once
/// The choices of the viewer's page, from the tables of `alhazen list`.

#include <nlohmann/json.hpp>

#include "alhazen/session/load.h"

namespace alhazen::viewer {

/// The response to /state without current work. The scene must have a camera and an aggregate.
[[nodiscard]] nlohmann::ordered_json view_menus(const LoadedScene& loaded);

}  // namespace alhazen::viewer
