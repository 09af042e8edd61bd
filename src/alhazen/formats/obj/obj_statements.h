#pragma once
/// The statements of an OBJ file: lists of positions, texture coordinates, normals and faces, and
/// the state at each face.
///
/// Source: see obj_reader.h.
/// Conventions: indices count from 0; -1: absent. Texture coordinate and normal indices, and
/// position indices that refer forward, are checked only when meshes are made.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/formats/core/importer.h"
#include "alhazen/formats/obj/obj_free_form.h"

namespace alhazen {

struct ObjCorner {
    std::int32_t position = -1, uv = -1, normal = -1;
    friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

/// The corners of all faces, concatenated. An array that no face uses takes no memory.
class ObjCorners {
  public:
    [[nodiscard]] std::size_t size() const { return position.size(); }
    [[nodiscard]] ObjCorner operator[](std::size_t i) const {
        return {position[i], uv.empty() ? -1 : uv[i], normal.empty() ? -1 : normal[i]};
    }
    void push_back(const ObjCorner& corner) {
        push(uv, corner.uv);
        push(normal, corner.normal);
        position.push_back(corner.position);
    }
    /// Adds corners of positions alone.
    void append(const std::vector<std::int32_t>& positions);
    void resize(std::size_t size);
    /// Allocates a normal index for every corner.
    void need_normals();

    std::vector<std::int32_t> position;  ///< [corner]
    std::vector<std::int32_t> uv;        ///< [corner], or empty
    std::vector<std::int32_t> normal;    ///< [corner], or empty

  private:
    void push(std::vector<std::int32_t>& list, std::int32_t index) const {
        if (index < 0 && list.empty()) return;
        list.resize(position.size(), -1);
        list.push_back(index);
    }
};

struct ObjFace {
    std::uint32_t end = 0;  ///< one past its last corner; it begins at the end of the previous face
    std::uint32_t line = 0;  ///< line in the file, from 1
};

/// The state from `first_face` to the first face of the next run.
struct ObjRun {
    std::uint32_t first_face = 0;
    std::uint32_t name = 0;       ///< object and group, index in `names`
    std::uint32_t material = 0;   ///< index in `materials`
    std::uint32_t smoothing = 0;  ///< group; 0: flat
};

struct ObjLibrary {
    std::string names;  ///< the rest of the `mtllib` line
    std::uint32_t line = 0;
};

struct ObjStatements {
    std::vector<Vec3> positions;
    std::vector<double> weights;      ///< [position]; may be shorter, all others are 1
    std::vector<VertexColor> colors;  ///< [position], linear; empty if no vertex has one
    std::vector<Vec2> uvs;
    std::vector<Vec3> normals;
    ObjCorners corners;
    std::vector<ObjFace> faces;
    std::vector<ObjRun> runs;                      ///< of at least one face
    std::vector<std::string> names;                ///< the first is empty
    std::vector<std::string> materials;            ///< the first is empty
    std::vector<std::uint32_t> material_lines{0};  ///< [material] of its first `usemtl`
    std::vector<ObjLibrary> libraries;
    ObjFreeForm free_form;

    /// Calls use(run, first corner, end corner, line) for each face.
    template <class Use>
    void for_each_face(const Use& use) const {
        for (std::size_t r = 0; r < runs.size(); ++r) {
            const std::size_t end = r + 1 < runs.size() ? runs[r + 1].first_face : faces.size();
            for_each_face_of(r, end, use);
        }
    }
    /// Calls use for each face of one run.
    template <class Use>
    void for_each_face_in(std::size_t run, const Use& use) const {
        const std::size_t end = run + 1 < runs.size() ? runs[run + 1].first_face : faces.size();
        for_each_face_of(run, end, use);
    }

  private:
    template <class Use>
    void for_each_face_of(std::size_t run, std::size_t end, const Use& use) const {
        for (std::size_t f = runs[run].first_face; f < end; ++f) {
            use(runs[run], f == 0 ? 0u : faces[f - 1].end, faces[f].end, faces[f].line);
        }
    }
};

/// The name before a comment: before a `#` that is a word by itself. `wheel #2` is all name.
[[nodiscard]] std::string obj_name_of(std::string_view text);

/// Reads all statements. Stops after a limited number of errors; text without any OBJ statement is
/// an error. Throws Error (Resource) beyond options.max_elements.
[[nodiscard]] ObjStatements read_obj_statements(std::string_view bytes, const std::string& file,
                                                const ImportOptions& options,
                                                Diagnostics& diagnostics);

}  // namespace alhazen
