#pragma once
/// Reads the geometry of a Wavefront OBJ file into triangle meshes: one per object or group and
/// material, or a single one.
///
/// Source: "Object Files (.obj)", Advanced Visualizer manual, appendix B1, Wavefront, 1992.
/// Differs: polygons only; free-form surfaces are in obj_surfaces.h; lines and points are skipped.
/// Vertices may have colours. Without any `s` statement faces are flat.
/// Conventions: a mesh vertex is a combination of v, vt and vn used by a face, in the order of
/// first use; a single mesh without vt and vn keeps the vertices of the file. w and the third
/// texture coordinate are ignored. Positive indices may refer forward; negative ones count back
/// from the face. A corner without a normal gets the sum of the area-weighted normals of the faces
/// of its smoothing group around its position, across parts; without a smoothing group, the normal
/// of its face.
/// Complexity: linear in time and memory, independent of the number of groups and material
/// switches.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/obj/obj_statements.h"

namespace alhazen {

/// Number of parts above which parts are merged by material.
inline constexpr std::size_t kMaxObjParts = 100'000;

/// The faces of one object or group that have one material.
struct ObjPart {
    std::string name;        ///< the object, "object/group" or the group; may be empty
    std::uint32_t material;  ///< index in ObjStatements::materials
    std::uint32_t line;      ///< of its first face
    bool lacks_uvs;          ///< corners of its faces have no texture coordinates
    TriangleMesh mesh;       ///< its uvs of such corners, if any has some, are (0, 0)
};

/// The meshes of a file in the order of their first faces; empty after an error. Consumes the
/// geometry in `statements`. `file` is for messages only.
[[nodiscard]] std::vector<ObjPart> make_obj_parts(ObjStatements& statements,
                                                  const std::string& file,
                                                  Diagnostics& diagnostics);

/// The mesh of a whole file; empty after an error. `file` is for messages only.
[[nodiscard]] TriangleMesh read_obj(std::string_view bytes, const std::string& file,
                                    const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
