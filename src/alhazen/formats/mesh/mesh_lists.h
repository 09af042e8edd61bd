#pragma once
/// Lists of points, faces, normals and texture coordinates of the text formats.
///
/// Conventions: each function reports errors with their location and returns false; vertex arrays
/// must have one entry per position.

#include <string_view>

#include "alhazen/formats/text/block_reader.h"
#include "alhazen/shapes/meshes/triangle_mesh.h"

namespace alhazen {

/// Reads `((x, y, z), ...)` into mesh.positions.
bool read_points(TextNode list, std::string_view what, const ValueReader& values,
                 TriangleMesh& mesh);
/// Reads `((i, j, k, ...), ...)` into mesh.triangles; faces of more than three vertices become fans
/// around the first vertex. Precondition: the positions are read (bounds of the indices).
bool read_faces(TextNode list, std::string_view what, const ValueReader& values,
                TriangleMesh& mesh);
/// Lengths of the normals that are read: they are their weights when normals are interpolated.
enum class NormalLengths { Unit, AsWritten };
/// Reads `((x, y, z), ...)` into mesh.normals.
bool read_normals(TextNode list, std::string_view what, const ValueReader& values,
                  NormalLengths lengths, TriangleMesh& mesh);
/// Reads `((u, v), ...)` into mesh.uvs.
bool read_uvs(TextNode list, std::string_view what, const ValueReader& values, TriangleMesh& mesh);

/// Reports an error unless the list has `vertices` entries.
bool has_one_per_vertex(TextNode list, std::string_view what, std::size_t vertices,
                        const ValueReader& values);

}  // namespace alhazen
