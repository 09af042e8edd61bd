#pragma once
/// The environment of a scene: chosen by the user, or the default of a scene without light.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/session/load.h"

namespace alhazen {

/// True if the renderer is physically based: environments then light the scene.
[[nodiscard]] bool follows_light(const std::string& renderer);

/// The name of a built-in environment and its description in one line.
struct EnvironmentEntry {
    const char* name;
    const char* description;
};
/// The names that `set_environment` accepts besides picture files.
[[nodiscard]] std::span<const EnvironmentEntry> environments();
/// The environment of a name in the table; null for "none".
[[nodiscard]] std::shared_ptr<const Environment> make_environment(const std::string& name,
                                                                  UpAxis up_axis);

/// Throws Error (Usage) if `text` is not empty and the renderer ignores environments, or if `text`
/// is neither a known word nor a file.
void check_environment(const std::string& text, const std::string& renderer);

/// True if a scene has no light that a physically based renderer sees: `set_environment` puts the
/// studio around it. To be asked before `complete_view`.
[[nodiscard]] bool is_dark(const LoadedScene& loaded);

/// Sets the environment `text`: "sky", "studio", "none" (removes that of the file) or the name of a
/// picture of all directions. Empty: keeps that of the file; a scene without any light gets the
/// studio if the renderer is physically based. Returns notes of what was done, one sentence each.
/// Throws Error as `check_environment` and `read_image`.
std::vector<std::string> set_environment(LoadedScene& loaded, const std::string& text,
                                         const std::string& renderer, const ImageLimits& limits);

/// Warns of texels of the environment that are not valid radiances.
void warn_of_bad_texels(LoadedScene& loaded);

}  // namespace alhazen
