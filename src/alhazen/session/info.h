#pragma once
/// What a person wants to know about a scene first.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "alhazen/session/load.h"

namespace alhazen {

/// Format, bounds, counts by type, cameras, lights, materials, warnings.
[[nodiscard]] nlohmann::ordered_json scene_info(const std::string& scene_name,
                                                const LoadedScene& loaded);

/// The same for reading, one fact a line.
[[nodiscard]] std::string info_text(const nlohmann::ordered_json& info);

}  // namespace alhazen
