#pragma once
/// The statements of an OBJ file as they stand: lists of positions, texture coordinates, normals
/// and faces.
///
/// Source: see obj_reader.h. Differs: nothing.
/// Conventions: indices count from 0; -1 = not given. Texture coordinate and normal indices, and
/// positions given before their vertex, are only checked when the mesh is made.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/importers/importer.h"

namespace alhazen {

struct ObjCorner {
    std::int32_t position = -1, uv = -1, normal = -1;
    friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

struct ObjFace {
    std::uint32_t end = 0;   ///< one past its last corner; it begins where the face before ends
    std::uint32_t line = 0;  ///< in the file, from 1
};

struct ObjStatements {
    std::vector<Vec3> positions;
    std::vector<Vec2> uvs;
    std::vector<Vec3> normals;
    std::vector<ObjCorner> corners;
    std::vector<ObjFace> faces;
};

/// Reads all statements. Stops after some errors. Throws Error (Resource) beyond
/// options.max_elements.
[[nodiscard]] ObjStatements read_obj_statements(std::string_view bytes, const std::string& file,
                                                const ImportOptions& options,
                                                Diagnostics& diagnostics);

}  // namespace alhazen
