#pragma once
/// Lists of points, faces, normals and texture coordinates, as both text formats write them.
///
/// Conventions: each function reports what is wrong with its place and then returns false; arrays
/// at the vertices must have one entry per position.

#include <string_view>

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// `((x, y, z), ...)` into mesh.positions.
bool read_points(TextNode list, std::string_view what, const ValueReader& values,
                 TriangleMesh& mesh);
/// `((i, j, k, ...), ...)` into mesh.triangles; faces of more than three vertices become fans from
/// the first. Needs the positions, to check the indices.
bool read_faces(TextNode list, std::string_view what, const ValueReader& values,
                TriangleMesh& mesh);
/// `((x, y, z), ...)` into mesh.normals, made unit.
bool read_normals(TextNode list, std::string_view what, const ValueReader& values,
                  TriangleMesh& mesh);
/// `((u, v), ...)` into mesh.uvs.
bool read_uvs(TextNode list, std::string_view what, const ValueReader& values, TriangleMesh& mesh);

/// Reports unless the list has `vertices` entries.
bool has_one_per_vertex(TextNode list, std::string_view what, std::size_t vertices,
                        const ValueReader& values);

}  // namespace alhazen
