#pragma once
/// Reads the geometry of a Wavefront OBJ file into a triangle mesh.
///
/// Source: "Object Files (.obj)", Advanced Visualizer manual, appendix B1, Wavefront, 1992.
/// Differs: polygons only; groups, materials, lines, points and free-form surfaces are stepped
/// over. Conventions: a vertex of the mesh is a combination of v, vt and vn that a face uses, in
/// the order of first use; without vt and vn in any face the vertices are those of the file. w,
/// colours and the third texture coordinate are ignored. A positive index may point forward, a
/// negative one counts back from the face.

#include <string>
#include <string_view>

#include "alhazen/importers/importer.h"

namespace alhazen {

/// The mesh of a whole file; empty after an error. `file` is only used in messages.
[[nodiscard]] TriangleMesh read_obj(std::string_view bytes, const std::string& file,
                                    const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
