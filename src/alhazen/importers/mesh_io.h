#pragma once
/// Mesh files that scenes refer to: PLY and OBJ as one TriangleMesh.

#include <filesystem>

#include "alhazen/importers/importer.h"

namespace alhazen {

/// Reads a PLY (ascii, both binary orders, any property order, polygons of any size) or OBJ file (geometry only,
/// materials ignored) recognised by content. Findings go to `diagnostics` with file:line; the mesh is empty
/// when it could not be read. Throws Error (File, Resource).
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path, const ImportOptions& options,
                                     Diagnostics& diagnostics);

}  // namespace alhazen
