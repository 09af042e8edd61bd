#pragma once
/// Summary of a scene: `alhazen info`.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "alhazen/session/load.h"

namespace alhazen {

struct InfoOptions {
    /// Also tests meshes of more than two million triangles for closedness, which sorts all edges,
    /// and measures surfaces of more than 20 000 patches.
    bool all = false;
};

/// Format, bounds, counts by type, meshes with area and volume, materials, textures, cameras,
/// lights, animations, memory, times, warnings. The description must have its meshes.
[[nodiscard]] nlohmann::ordered_json scene_info(const std::string& scene_name,
                                                const LoadedScene& loaded,
                                                const InfoOptions& options = {});

/// The summary as text. `all`: lists are not truncated.
[[nodiscard]] std::string info_text(const nlohmann::ordered_json& info, bool all = false);

}  // namespace alhazen
