#pragma once
/// Reads the mesh files that scenes refer to (PLY, OBJ, STL), each as one TriangleMesh.

#include <filesystem>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// Reads a PLY (ascii, both binary byte orders, any property order, polygons of any size), OBJ
/// (geometry only, materials ignored) or STL file (all solids as one), recognised by content.
/// Findings go to `diagnostics` with file:line; the mesh is empty on failure. Throws Error (File,
/// Resource).
[[nodiscard]] TriangleMesh read_mesh(const std::filesystem::path& path,
                                     const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
