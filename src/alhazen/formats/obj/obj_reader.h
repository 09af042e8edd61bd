#pragma once
/// Reads the geometry of a Wavefront OBJ file into triangle meshes: one per object or group and
/// material, or all as one.
///
/// Source: "Object Files (.obj)", Advanced Visualizer manual, appendix B1, Wavefront, 1992.
/// Differs: polygons only; lines, points and free-form surfaces are stepped over. Vertices may have
/// colours. Without any `s` statement faces are flat.
/// Conventions: a vertex of a mesh is a combination of v, vt and vn that a face uses, in the order
/// of first use; a single mesh without any of the latter keeps the vertices of the file. w and the
/// third texture coordinate are ignored. A positive index may point forward, a negative one counts
/// back from the face. A corner without a normal gets the sum of the area-weighted normals of the
/// faces of its smoothing group around its position, whatever their part; without a smoothing group
/// that of its face.
/// Complexity: linear in time and memory, however many groups and switches of material.

#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/obj/obj_statements.h"

namespace alhazen {

/// More parts than this are merged by material alone.
inline constexpr std::size_t kMaxObjParts = 100'000;

/// The faces of one object or group that are of one material.
struct ObjPart {
    std::string name;        ///< of the object, "object/group" or the group; may be empty
    std::uint32_t material;  ///< in ObjStatements::materials
    std::uint32_t line;      ///< of its first face
    TriangleMesh mesh;
};

/// The meshes of a file in the order of their first faces; empty after an error. The geometry in
/// `statements` is used up. `file` is only used in messages.
[[nodiscard]] std::vector<ObjPart> make_obj_parts(ObjStatements& statements,
                                                  const std::string& file,
                                                  Diagnostics& diagnostics);

/// The mesh of a whole file; empty after an error. `file` is only used in messages.
[[nodiscard]] TriangleMesh read_obj(std::string_view bytes, const std::string& file,
                                    const ImportOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen
