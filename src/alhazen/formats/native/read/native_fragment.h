#pragma once
/// Adds blocks of the native format to an existing scene, for programs that build scenes
/// incrementally with the format's vocabulary.
///
/// Source: docs/reference/formats/native.md.
/// Differs: a fragment has no header, and may refer to the scene's materials, textures, meshes (as
/// geometries) and objects by name; the first of each name is meant. Its top level is that of the
/// root object.
/// Errors: all findings are reported at their lines of the fragment; after an error the scene is
/// invalid.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Reads the fragment `text` into `scene`. `name`: the file in locations. File names in the
/// fragment are relative to the folder of `scene.path`, and must lie in it or in
/// ImportOptions::allowed_folders. Throws Error (Resource) beyond the limits of the options.
void read_native_fragment(std::string_view text, const std::string& name,
                          const ImportOptions& options, SceneDescription& scene,
                          Diagnostics& diagnostics);

}  // namespace alhazen
