#pragma once
/// Pieces of the text of an OBJ file, which several threads read.
///
/// Differs: only plain lines are read so, which are most of a mesh without texture coordinates and
/// normals: empty ones, comments, positions of three numbers, triangles of three positive indices.
/// Conventions: a piece ends at the end of a line that the next one does not continue.

#include <cstdint>
#include <string_view>
#include <vector>

#include "alhazen/math/vec.h"

namespace alhazen {

/// The pieces of a text, in its order.
[[nodiscard]] std::vector<std::string_view> obj_pieces(std::string_view text);

/// Numbers of lines that begin with `v`, `vt`, `vn` and `f`.
struct ObjLineCounts {
    std::size_t positions = 0, uvs = 0, normals = 0, faces = 0;
};
/// Sums those of the pieces.
[[nodiscard]] ObjLineCounts count_obj_lines(const std::vector<std::string_view>& pieces);

struct PlainObjLines {
    std::vector<Vec3> positions;
    std::vector<std::int32_t> corners;     ///< [face][3], from 0
    std::vector<std::int64_t> face_lines;  ///< [face], from 0 at the first line of the piece
    std::int64_t lines = 0;                ///< of the piece; 0: not all are plain
};

/// Reads a piece. A last line without an end is not plain.
[[nodiscard]] PlainObjLines read_plain_obj_lines(std::string_view piece);

}  // namespace alhazen
