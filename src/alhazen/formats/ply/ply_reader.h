#pragma once
/// Reads a PLY file into a triangle mesh.
///
/// Source: Turk, "The PLY Polygon File Format", Stanford, 1994.
/// Differs: vertices and faces may come in any order; other elements and properties are skipped.
/// Conventions: `vertex` properties as in ply_vertices.h; the list `vertex_indices` or
/// `vertex_index` of `face` and of `tristrips`. Polygons are triangulated (triangulate.h). A file
/// without faces gives a mesh without triangles.

#include <string>
#include <string_view>

#include "alhazen/formats/core/importer.h"

namespace alhazen {

/// The mesh of a whole file; empty after an error. `file` is for messages only.
[[nodiscard]] TriangleMesh read_ply(std::string_view bytes, const std::string& file,
                                    const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
