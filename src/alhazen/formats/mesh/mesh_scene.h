#pragma once
/// What the scenes of all mesh formats have in common.
///
/// Conventions: pictures are sRGB, attenuation is not clamped, the air's index is 1 (as in native
/// scenes); a mesh without a material of its own is matt grey. Such files have neither cameras
/// nor lights.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// An empty scene with one object, its root.
[[nodiscard]] SceneDescription make_mesh_scene(const ImportSource& source, const char* format,
                                               UpAxis up);

/// Matt grey, 0.7; white below the colours of vertices, which are then what is seen.
[[nodiscard]] Material default_mesh_material(bool colored = false);

/// Adds a mesh as a part of the root. `name` is also that of the part.
void add_mesh(SceneDescription& scene, TriangleMesh mesh, std::string name, MaterialId material,
              const FileLocation& where);

/// The error of a file that has vertices only, or nothing at all.
void report_no_faces(const ImportSource& source, std::size_t points, Diagnostics& diagnostics);

/// Reports text in UTF-16, and files that are empty or hold bytes that no text has. False then.
bool is_plain_text(const ImportSource& source, Diagnostics& diagnostics);

/// Whether the file's name ends like this, whatever the capitals; `suffix` with its dot.
[[nodiscard]] bool has_suffix(const std::filesystem::path& path, std::string_view suffix);

}  // namespace alhazen
