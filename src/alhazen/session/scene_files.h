#pragma once
/// The files of a scene, which no output may overwrite.

#include <filesystem>
#include <set>
#include <span>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// The scene file and all other files that were read or that it names.
[[nodiscard]] std::set<std::filesystem::path> files_of_scene(const SceneDescription& description);

/// True if both names denote one existing file.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Error (Usage) when one of `outputs` is a file of the scene.
void check_spares_scene(const SceneDescription& description,
                        std::span<const std::filesystem::path> outputs);

}  // namespace alhazen
