#pragma once
/// Scene construction common to all mesh formats.
///
/// Conventions: images are sRGB, attenuation is unclamped, the refractive index of air is 1 (as in
/// native scenes); a mesh without a material is matte grey. The scenes have neither cameras nor
/// lights.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// An empty scene with one object, its root.
[[nodiscard]] SceneDescription make_mesh_scene(const ImportSource& source, const char* format,
                                               UpAxis up);

/// Matte grey, 0.7; white for a mesh with vertex colours, which then are unchanged.
[[nodiscard]] Material default_mesh_material(bool colored = false);

/// Adds a mesh as a part of the root; `name` names the mesh and the part.
void add_mesh(SceneDescription& scene, TriangleMesh mesh, std::string name, MaterialId material,
              const FileLocation& where);

/// Reports the error of a file that has only vertices, or no content.
void report_no_faces(const ImportSource& source, std::size_t points, Diagnostics& diagnostics);

/// Reports UTF-16 text, empty files and files with bytes that occur in no text, and returns false
/// for them.
bool is_plain_text(const ImportSource& source, Diagnostics& diagnostics);

/// True if the file name ends with `suffix` (including its dot), ignoring case.
[[nodiscard]] bool has_suffix(const std::filesystem::path& path, std::string_view suffix);

}  // namespace alhazen
