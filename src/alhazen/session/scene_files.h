#pragma once
/// The files that a scene was read from, which no output may replace.

#include <filesystem>
#include <set>
#include <span>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

/// The scene file itself and all others that were read, or that it names.
[[nodiscard]] std::set<std::filesystem::path> files_of_scene(const SceneDescription& description);

/// Whether both names lead to one file that exists.
[[nodiscard]] bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws Error (Usage) when one of `outputs` is a file of the scene.
void check_spares_scene(const SceneDescription& description,
                        std::span<const std::filesystem::path> outputs);

}  // namespace alhazen
