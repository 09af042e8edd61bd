#include "alhazen/importers/obj_reader.h"

#include <algorithm>
#include <climits>
#include <span>

#include "alhazen/importers/mesh_io_normals.h"
#include "alhazen/importers/obj_statements.h"
#include "alhazen/importers/triangulate.h"

namespace alhazen {

namespace {

constexpr int kMaxErrors = 50;

/// Finds the vertex of a combination of indices, or makes it: a hash table with linear probing.
class VertexTable {
  public:
    VertexTable() : slots_(1024, kNone) {}

    std::uint32_t find_or_add(const ObjCorner& corner) {
        std::size_t slot = first_slot(corner);
        for (; slots_[slot] != kNone; slot = (slot + 1) & (slots_.size() - 1)) {
            if (keys_[slots_[slot]] == corner) return slots_[slot];
        }
        keys_.push_back(corner);
        const std::uint32_t index = std::uint32_t(keys_.size() - 1);
        slots_[slot] = index;
        if (2 * keys_.size() > slots_.size()) grow();
        return index;
    }
    [[nodiscard]] std::size_t size() const { return keys_.size(); }
    [[nodiscard]] const ObjCorner& operator[](std::size_t i) const { return keys_[i]; }

  private:
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    [[nodiscard]] std::size_t first_slot(const ObjCorner& corner) const {
        std::uint64_t hash = 0;
        for (const std::int32_t part : {corner.position, corner.uv, corner.normal}) {
            hash = (hash ^ std::uint32_t(part)) * 0x9E3779B97F4A7C15u;
            hash ^= hash >> 32;
        }
        return std::size_t(hash) & (slots_.size() - 1);
    }
    void grow() {
        slots_.assign(4 * slots_.size(), kNone);
        for (std::uint32_t i = 0; i < keys_.size(); ++i) {
            std::size_t slot = first_slot(keys_[i]);
            while (slots_[slot] != kNone) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = i;
        }
    }

    std::vector<ObjCorner> keys_;
    std::vector<std::uint32_t> slots_;  ///< a power of two
};

/// Calls use(corners of the face, line) for each face.
template <class Use>
void for_each_face(ObjStatements& statements, const Use& use) {
    std::uint32_t begin = 0;
    for (const ObjFace& face : statements.faces) {
        use(std::span(statements.corners).subspan(begin, face.end - begin), face.line);
        begin = face.end;
    }
}

class MeshMaker {
  public:
    MeshMaker(ObjStatements& statements, const std::string& file, Diagnostics& diagnostics)
        : in_(statements), file_(file), diagnostics_(diagnostics) {}

    TriangleMesh make() {
        check_indices();
        if (errors_ != 0) return {};
        make_vertices();
        make_triangles();
        if (errors_ != 0) return {};
        if (mesh_.triangles.empty()) {
            diagnostics_.warning({file_, 0, 0}, "the mesh has no faces");
        }
        make_normals_unit(mesh_);
        return std::move(mesh_);
    }

  private:
    void check_indices() {
        for_each_face(in_, [&](std::span<const ObjCorner> corners, std::uint32_t line) {
            for (const ObjCorner& corner : corners) {
                check(corner.position, in_.positions.size(), "v", line);
                check(corner.uv, in_.uvs.size(), "vt", line);
                check(corner.normal, in_.normals.size(), "vn", line);
                has_uvs_ = has_uvs_ || corner.uv >= 0;
                has_normals_ = has_normals_ || corner.normal >= 0;
            }
        });
    }
    void check(std::int32_t index, std::size_t count, const char* what, std::uint32_t line) {
        if (index < 0 || std::size_t(index) < count) return;
        error(line, "the index " + std::to_string(index + 1) + " is above the " +
                        std::to_string(count) + " statements '" + what + "'");
    }

    /// Afterwards `position` of each corner is its vertex in the mesh.
    void make_vertices() {
        if (!has_uvs_ && !has_normals_) {
            mesh_.positions = std::move(in_.positions);
            return;
        }
        VertexTable table;
        for (ObjCorner& corner : in_.corners) {
            corner.position = std::int32_t(table.find_or_add(corner));
        }
        mesh_.positions.reserve(table.size());
        if (has_uvs_) mesh_.uvs.reserve(table.size());
        if (has_normals_) mesh_.normals.reserve(table.size());
        for (std::size_t i = 0; i < table.size(); ++i) {
            const ObjCorner& key = table[i];
            mesh_.positions.push_back(in_.positions[std::size_t(key.position)]);
            // A zero normal is one that is not there: make_normals_unit fills it in.
            if (has_normals_) {
                mesh_.normals.push_back(key.normal < 0 ? Vec3{}
                                                       : in_.normals[std::size_t(key.normal)]);
            }
            if (has_uvs_) mesh_.uvs.push_back(key.uv < 0 ? Vec2{} : in_.uvs[std::size_t(key.uv)]);
        }
    }

    void make_triangles() {
        mesh_.triangles.reserve(in_.corners.size() - 2 * in_.faces.size());
        std::vector<std::uint32_t> polygon;
        for_each_face(in_, [&](std::span<const ObjCorner> corners, std::uint32_t line) {
            polygon.clear();
            for (const ObjCorner& corner : corners) {
                polygon.push_back(std::uint32_t(corner.position));
            }
            if (errors_ < kMaxErrors && !triangulate(mesh_.positions, polygon, mesh_.triangles)) {
                error(line, "a concave polygon of " + std::to_string(polygon.size()) +
                                " vertices; the limit is " + std::to_string(kMaxConcaveVertices));
            }
        });
    }

    void error(std::uint32_t line, const std::string& message) {
        if (++errors_ > kMaxErrors) return;
        diagnostics_.error({file_, int(std::min<std::uint32_t>(line, INT_MAX)), 0}, message);
    }

    ObjStatements& in_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    TriangleMesh mesh_;
    std::uint64_t errors_ = 0;
    bool has_uvs_ = false;
    bool has_normals_ = false;
};

}  // namespace

TriangleMesh read_obj(std::string_view bytes, const std::string& file, const ImportOptions& options,
                      Diagnostics& diagnostics) {
    const std::size_t errors_before = diagnostics.error_count();
    ObjStatements statements = read_obj_statements(bytes, file, options, diagnostics);
    if (diagnostics.error_count() != errors_before) return {};
    return MeshMaker(statements, file, diagnostics).make();
}

}  // namespace alhazen
