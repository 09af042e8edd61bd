#include "alhazen/formats/obj/obj_reader.h"

#include <algorithm>
#include <climits>
#include <unordered_map>

#include "alhazen/formats/mesh/mesh_normals.h"
#include "alhazen/formats/obj/obj_smoothing.h"
#include "alhazen/formats/obj/obj_vertex_table.h"
#include "alhazen/geometry/polygon/free_diagonals.h"
#include "alhazen/geometry/polygon/triangulate.h"

namespace alhazen {

namespace {

constexpr int kMaxFileErrors = 50;

/// A part, with the runs of faces that belong to it.
struct RunsOfPart {
    std::uint32_t name = 0, material = 0;
    std::vector<std::uint32_t> runs;
    bool has_uvs = false, has_all_uvs = false, has_normals = false;
};

class PartMaker {
  public:
    PartMaker(ObjStatements& statements, const std::string& file, Diagnostics& diagnostics)
        : in_(statements), file_(file), diagnostics_(diagnostics) {}

    std::vector<ObjPart> make(bool as_one) {
        check_indices();
        if (errors_ != 0) return {};
        smooth_obj_normals(in_, file_);
        std::vector<RunsOfPart> groups = group_runs(as_one);
        find_attributes(groups);
        std::vector<ObjPart> parts;
        parts.reserve(groups.size());
        for (RunsOfPart& group : groups) {
            parts.push_back(make_part(group, groups.size() == 1));
            group = {};
        }
        if (errors_ != 0) parts.clear();
        return parts;
    }

  private:
    /// Drops indices of normals and texture coordinates that the file omits; some exporters write
    /// them.
    void drop_indices_of_nothing(std::vector<std::int32_t>& indices, std::size_t count,
                                 const char* what) {
        if (count != 0 ||
            std::none_of(indices.begin(), indices.end(), [](std::int32_t i) { return i >= 0; })) {
            return;
        }
        diagnostics_.warning({file_, 0, 0}, std::string("faces name '") + what +
                                                "' statements, and the file has none: omitted");
        indices.clear();
    }
    void check_indices() {
        drop_indices_of_nothing(in_.corners.uv, in_.uvs.size(), "vt");
        drop_indices_of_nothing(in_.corners.normal, in_.normals.size(), "vn");
        if (all_below(in_.corners.position, in_.positions.size()) &&
            all_below(in_.corners.uv, in_.uvs.size()) &&
            all_below(in_.corners.normal, in_.normals.size())) {
            return;
        }
        in_.for_each_face(
            [&](const ObjRun&, std::uint32_t begin, std::uint32_t end, std::uint32_t line) {
                for (std::uint32_t c = begin; c < end; ++c) {
                    const ObjCorner corner = in_.corners[c];
                    check(corner.position, in_.positions.size(), "v", line);
                    check(corner.uv, in_.uvs.size(), "vt", line);
                    check(corner.normal, in_.normals.size(), "vn", line);
                }
            });
    }
    static bool all_below(const std::vector<std::int32_t>& indices, std::size_t count) {
        std::int32_t most = -1;
        for (const std::int32_t index : indices) most = std::max(most, index);
        return most < 0 || std::size_t(most) < count;
    }
    void check(std::int32_t index, std::size_t count, const char* what, std::uint32_t line) {
        if (index < 0 || std::size_t(index) < count) return;
        error(line, "the index " + std::to_string(index + 1) + " is above the " +
                        std::to_string(count) + " statements '" + what + "'");
    }

    std::vector<RunsOfPart> group_runs(bool as_one) {
        std::vector<RunsOfPart> groups;
        bool by_name = true;
        std::unordered_map<std::uint64_t, std::size_t> found;
        for (std::size_t r = 0; r < in_.runs.size(); ++r) {
            const ObjRun& run = in_.runs[r];
            std::uint64_t key = 0;
            if (!as_one) key = (by_name ? std::uint64_t{run.name} << 32 : 0) | run.material;
            const auto [entry, fresh] = found.try_emplace(key, groups.size());
            if (fresh && by_name && groups.size() == kMaxObjParts) {
                diagnostics_.warning({file_, 0, 0},
                                     "more than " + std::to_string(kMaxObjParts) +
                                         " objects, groups and materials: merged by material");
                by_name = false;
                groups.clear();
                found.clear();
                r = std::size_t(-1);  // restart
                continue;
            }
            if (fresh) groups.push_back({by_name && !as_one ? run.name : 0, run.material, {}});
            groups[entry->second].runs.push_back(std::uint32_t(r));
        }
        return groups;
    }

    /// Finds the attributes of each part. A part has normals if any corner has one; its flat faces
    /// then need normals too.
    void find_attributes(std::vector<RunsOfPart>& groups) {
        if (in_.corners.uv.empty() && in_.corners.normal.empty()) return;
        std::vector<bool> wanted(in_.runs.size());
        for (RunsOfPart& group : groups) {
            group.has_all_uvs = true;
            for (const std::uint32_t r : group.runs) {
                in_.for_each_face_in(
                    r, [&](const ObjRun&, std::uint32_t begin, std::uint32_t end, std::uint32_t) {
                        for (std::uint32_t c = begin; c < end; ++c) {
                            const ObjCorner corner = in_.corners[c];
                            group.has_uvs = group.has_uvs || corner.uv >= 0;
                            group.has_all_uvs = group.has_all_uvs && corner.uv >= 0;
                            group.has_normals = group.has_normals || corner.normal >= 0;
                        }
                    });
            }
            for (const std::uint32_t r : group.runs) wanted[r] = group.has_normals;
        }
        flatten_obj_normals(in_, file_, wanted);
    }

    ObjPart make_part(const RunsOfPart& group, bool alone) {
        ObjPart part;
        part.name = in_.names[group.name];
        part.material = group.material;
        part.line = in_.faces[in_.runs[group.runs.front()].first_face].line;
        part.lacks_uvs = !group.has_all_uvs;
        number_vertices(group, alone, part.mesh);
        make_triangles(group, part.mesh);
        if (errors_ == 0) make_normals_unit(part.mesh);
        return part;
    }

    /// Assigns vertex numbers: `position` of each corner becomes its vertex in the mesh.
    void number_vertices(const RunsOfPart& group, bool alone, TriangleMesh& mesh) {
        if (alone && !group.has_uvs && !group.has_normals) {
            mesh.positions = std::move(in_.positions);
            mesh.colors = std::move(in_.colors);
            return;
        }
        ObjVertexTable table;
        for_each_corner(group, [&](std::uint32_t c) {
            in_.corners.position[c] = std::int32_t(table.find_or_add(in_.corners[c]));
        });
        mesh.positions.reserve(table.size());
        if (!in_.colors.empty()) mesh.colors.reserve(table.size());
        if (group.has_uvs) mesh.uvs.reserve(table.size());
        if (group.has_normals) mesh.normals.reserve(table.size());
        for (std::size_t i = 0; i < table.size(); ++i) {
            const ObjCorner& key = table[i];
            const std::size_t position = std::size_t(key.position);
            mesh.positions.push_back(in_.positions[position]);
            if (!in_.colors.empty()) mesh.colors.push_back(in_.colors[position]);
            if (group.has_normals) mesh.normals.push_back(in_.normals[std::size_t(key.normal)]);
            if (group.has_uvs) {
                mesh.uvs.push_back(key.uv < 0 ? Vec2{} : in_.uvs[std::size_t(key.uv)]);
            }
        }
    }

    void make_triangles(const RunsOfPart& group, TriangleMesh& mesh) {
        std::size_t corners = 0, faces = 0;
        for_each_face(group, [&](std::uint32_t begin, std::uint32_t end, std::uint32_t) {
            corners += end - begin;
            ++faces;
        });
        mesh.triangles.reserve(corners - 2 * faces);
        std::vector<std::uint32_t> polygon;
        std::vector<PolygonTriangles> polygons;
        for_each_face(group, [&](std::uint32_t begin, std::uint32_t end, std::uint32_t) {
            const std::int32_t* const corner = in_.corners.position.data() + begin;
            if (end - begin == 3) {
                mesh.triangles.push_back(
                    {std::uint32_t(corner[0]), std::uint32_t(corner[1]), std::uint32_t(corner[2])});
                return;
            }
            polygon.assign(corner, corner + (end - begin));
            const std::size_t first = mesh.triangles.size();
            triangulate(mesh.positions, polygon, mesh.triangles);
            polygons.push_back({first, mesh.triangles.size()});
        });
        free_diagonals(mesh.positions, polygons, mesh.triangles);
    }

    template <class Use>
    void for_each_face(const RunsOfPart& group, const Use& use) {
        for (const std::uint32_t r : group.runs) {
            in_.for_each_face_in(r, [&](const ObjRun&, std::uint32_t begin, std::uint32_t end,
                                        std::uint32_t line) { use(begin, end, line); });
        }
    }
    template <class Use>
    void for_each_corner(const RunsOfPart& group, const Use& use) {
        for_each_face(group, [&](std::uint32_t begin, std::uint32_t end, std::uint32_t) {
            for (std::uint32_t c = begin; c < end; ++c) use(c);
        });
    }

    void error(std::uint32_t line, const std::string& message) {
        if (++errors_ > kMaxFileErrors) return;
        diagnostics_.error({file_, int(std::min<std::uint32_t>(line, INT_MAX)), 0}, message);
    }

    ObjStatements& in_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    std::uint64_t errors_ = 0;
};

}  // namespace

std::vector<ObjPart> make_obj_parts(ObjStatements& statements, const std::string& file,
                                    Diagnostics& diagnostics) {
    return PartMaker(statements, file, diagnostics).make(false);
}

TriangleMesh read_obj(std::string_view bytes, const std::string& file, const ImportOptions& options,
                      Diagnostics& diagnostics) {
    const std::size_t errors_before = diagnostics.error_count();
    ObjStatements statements = read_obj_statements(bytes, file, options, diagnostics);
    if (diagnostics.error_count() != errors_before) return {};
    if (!statements.free_form.surfaces.empty()) {
        diagnostics.warning({file, statements.free_form.surfaces.front().line, 0},
                            "a mesh has no free-form surfaces: they are left out");
    }
    std::vector<ObjPart> parts = PartMaker(statements, file, diagnostics).make(true);
    if (diagnostics.error_count() != errors_before) return {};
    if (parts.empty()) {
        TriangleMesh points;
        points.positions = std::move(statements.positions);
        points.colors = std::move(statements.colors);
        return points;
    }
    return std::move(parts.front().mesh);
}

}  // namespace alhazen
