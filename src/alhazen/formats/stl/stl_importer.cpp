#include "alhazen/formats/stl/stl_importer.h"

#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/stl/stl_reader.h"

namespace alhazen {

const char* StlImporter::description() const {
    return "stereolithography meshes (.stl), docs/reference/formats/stl.md";
}

int StlImporter::recognise(const ImportSource& source) const {
    if (looks_like_stl(source.bytes)) return 2;
    return has_suffix(source.path, ".stl") ? 1 : 0;
}

SceneDescription StlImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene = make_mesh_scene(source, name(), UpAxis::Z);
    const std::string file = source.path.string();
    const std::size_t errors_before = diagnostics.error_count();
    std::vector<StlSolid> solids = read_stl(source.bytes, file, source.options, diagnostics);
    if (diagnostics.error_count() != errors_before) return scene;
    scene.materials.push_back({default_mesh_material(), {file, 0, 0}});
    std::size_t triangles = 0;
    for (StlSolid& solid : solids) {
        triangles += solid.mesh.triangles.size();
        if (solid.mesh.triangles.empty()) continue;
        std::string part = solid.name.empty() ? source.path.stem().string() : solid.name;
        add_mesh(scene, std::move(solid.mesh), std::move(part), MaterialId{0},
                 {file, solid.line, 0});
    }
    if (triangles == 0) report_no_faces(source, 0, diagnostics);
    return scene;
}

}  // namespace alhazen
