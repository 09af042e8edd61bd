#pragma once
/// The environment that a user chooses for a scene, or that a scene without light gets.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "alhazen/session/load.h"

namespace alhazen {

/// Whether the renderer follows light physically, so that an environment lights what it renders.
[[nodiscard]] bool follows_light(const std::string& renderer);

/// An environment by name, and what it is in one line.
struct EnvironmentEntry {
    const char* name;
    const char* description;
};
/// What `set_environment` takes beside names of pictures.
[[nodiscard]] std::span<const EnvironmentEntry> environments();
/// That of an entry of the table; null for "none".
[[nodiscard]] std::shared_ptr<const Environment> make_environment(const std::string& name,
                                                                  UpAxis up_axis);

/// Throws Error (Usage) for a text that is not empty and a renderer that sees no environments, and
/// for what is neither a known word nor a file.
void check_environment(const std::string& text, const std::string& renderer);

/// Sets the environment that `text` says: "sky", "studio", "none" (that of the file is removed), or
/// the name of a picture of all directions. Empty: that of the file; where a scene has no light at
/// all and the renderer follows light, the studio. Returns what was done, a sentence each. Throws
/// Error as `check_environment` and `read_image`.
std::vector<std::string> set_environment(LoadedScene& loaded, const std::string& text,
                                         const std::string& renderer, const ImageLimits& limits);

/// Texels of the environment that are no radiances, as a warning.
void warn_of_bad_texels(LoadedScene& loaded);

}  // namespace alhazen
