#pragma once
/// What a person wants to know about a scene first.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "alhazen/session/load.h"

namespace alhazen {

struct InfoOptions {
    /// Whether meshes of more than two million triangles are closed, too: a sort of all their
    /// edges.
    bool all = false;
};

/// Format, bounds, counts by type, meshes with area and volume, materials, textures, cameras,
/// lights, animations, memory, times, warnings. The description must have its meshes.
[[nodiscard]] nlohmann::ordered_json scene_info(const std::string& scene_name,
                                                const LoadedScene& loaded,
                                                const InfoOptions& options = {});

/// The same for reading. `all`: lists are not cut short.
[[nodiscard]] std::string info_text(const nlohmann::ordered_json& info, bool all = false);

}  // namespace alhazen
