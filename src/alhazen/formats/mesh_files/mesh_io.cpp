#include "alhazen/formats/mesh_files/mesh_io.h"

#include <array>

#include "alhazen/base/file.h"
#include "alhazen/base/unicode_marks.h"
#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/obj/obj_importer.h"
#include "alhazen/formats/obj/obj_reader.h"
#include "alhazen/formats/ply/ply_importer.h"
#include "alhazen/formats/ply/ply_reader.h"
#include "alhazen/formats/stl/stl_reader.h"

namespace alhazen {

namespace {

TriangleMesh read_any(const ImportSource& source, Diagnostics& diagnostics) {
    const std::string file = source.path.string();
    if (is_empty_file(source.bytes)) {
        diagnostics.error({file, 0, 0}, "the file is empty");
        return {};
    }
    const bool stl = looks_like_stl(source.bytes);
    if (!stl && (looks_like_ply(source.bytes) || has_suffix(source.path, ".ply"))) {
        return read_ply(source.bytes, file, source.options, diagnostics);
    }
    if (stl || has_suffix(source.path, ".stl")) {
        std::vector<StlSolid> solids =
            read_stl(source.bytes, file, source.options, diagnostics, true);
        return solids.empty() ? TriangleMesh{} : std::move(solids.front().mesh);
    }
    if (looks_like_obj(source.bytes) || has_suffix(source.path, ".obj")) {
        if (!is_plain_text(source, diagnostics)) return {};
        return read_obj(source.bytes, file, source.options, diagnostics);
    }
    if (report_wide_text(source.bytes, file, diagnostics)) return {};
    diagnostics.error({file, 1, 1}, "not a mesh of a known format; expected PLY, OBJ or STL");
    return {};
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, const ImportOptions& options,
                       Diagnostics& diagnostics) {
    diagnostics.note_file(path);
    const std::string bytes = read_file(path, options.max_included_bytes);
    const std::string_view text = without_byte_order_mark(bytes);
    const std::size_t errors_before = diagnostics.error_count();
    TriangleMesh mesh = read_any({text, path, options}, diagnostics);
    if (mesh.triangles.empty() && diagnostics.error_count() == errors_before) {
        diagnostics.warning({path.string(), 0, 0}, "the mesh has no faces");
    }
    return mesh;
}

}  // namespace alhazen
