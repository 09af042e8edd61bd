#include "alhazen/formats/ply/ply_importer.h"

#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/ply/ply_reader.h"
#include "alhazen/formats/text/text_cursor.h"

namespace alhazen {

bool looks_like_ply(std::string_view bytes) {
    return bytes.starts_with("ply") && bytes.size() > 3 && TextCursor::is_space(bytes[3]);
}

const char* PlyImporter::description() const {
    return "Stanford meshes (.ply), docs/reference/formats/ply.md";
}

int PlyImporter::recognise(const ImportSource& source) const {
    if (looks_like_ply(source.bytes)) return 2;
    return has_suffix(source.path, ".ply") ? 1 : 0;
}

SceneDescription PlyImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene = make_mesh_scene(source, name(), UpAxis::Y);
    const std::string file = source.path.string();
    const std::size_t errors_before = diagnostics.error_count();
    TriangleMesh mesh = read_ply(source.bytes, file, source.options, diagnostics);
    if (diagnostics.error_count() != errors_before) return scene;
    if (mesh.triangles.empty()) {
        report_no_faces(source, mesh.positions.size(), diagnostics);
        return scene;
    }
    mesh.vertex_materials.clear();  // indices into a scene that is not available
    scene.materials.push_back({default_mesh_material(!mesh.colors.empty()), {file, 0, 0}});
    add_mesh(scene, std::move(mesh), source.path.stem().string(), MaterialId{0}, {file, 0, 0});
    return scene;
}

}  // namespace alhazen
