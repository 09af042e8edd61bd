#pragma once
/// Reads a PLY file into a triangle mesh.
///
/// Source: Turk, "The PLY Polygon File Format", Stanford, 1994.
/// Differs: vertices and faces are read wherever they stand; other elements and properties are
/// skipped.
/// Conventions: the properties of `vertex` in ply_vertices.h; the list `vertex_indices` or
/// `vertex_index` of `face` and of `tristrips`. Polygons are cut into triangles (triangulate.h). A
/// file without faces gives a mesh without triangles.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// The mesh of a whole file; empty after an error. `file` is only used in messages.
[[nodiscard]] TriangleMesh read_ply(std::string_view bytes, const std::string& file,
                                    const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
