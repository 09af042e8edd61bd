#pragma once
/// Adds blocks of the native format to a scene that exists: for programs that build scenes piece by
/// piece with the format's vocabulary.
///
/// Source: docs/reference/formats/native.md.
/// Differs: a fragment has no header, and sees what the scene has: materials, textures, meshes (as
/// geometries) and objects by their names, the first of each name. Its top level is that of the
/// root object.
/// Errors: every finding is reported at its line of the fragment; the scene is then not valid.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// `name` stands for the file in locations. File names in the fragment are relative to the folder
/// of `scene.path`, and must lie in it or in ImportOptions::allowed_folders. Throws Error
/// (Resource) beyond the limits of the options.
void read_native_fragment(std::string_view text, const std::string& name,
                          const ImportOptions& options, SceneDescription& scene,
                          Diagnostics& diagnostics);

}  // namespace alhazen
