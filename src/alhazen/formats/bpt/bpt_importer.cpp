#include "alhazen/formats/bpt/bpt_importer.h"

#include "alhazen/formats/bpt/bpt_reader.h"
#include "alhazen/formats/mesh/mesh_scene.h"

namespace alhazen {

const char* BptImporter::description() const {
    return "Bezier patches (.bpt), docs/reference/formats/bpt.md";
}

int BptImporter::recognise(const ImportSource& source) const {
    if (looks_like_bpt(source.bytes)) return 2;
    return has_suffix(source.path, ".bpt") ? 1 : 0;
}

SceneDescription BptImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene = make_mesh_scene(source, name(), UpAxis::Z);
    if (!is_plain_text(source, diagnostics)) return scene;
    const std::string file = source.path.string();
    std::vector<BptMesh> meshes = read_bpt(source.bytes, file, source.options, diagnostics);
    scene.materials.push_back({default_mesh_material(), {file, 0, 0}});
    for (BptMesh& mesh : meshes) {
        Part part;
        part.name = source.path.stem().string();
        if (meshes.size() > 1) {
            part.name +=
                "_" + std::to_string(mesh.mesh.degree_u) + "x" + std::to_string(mesh.mesh.degree_v);
        }
        part.what = AnyShape{std::move(mesh.mesh)};
        part.location = mesh.location;
        scene.objects.front().parts.push_back(std::move(part));
    }
    return scene;
}

}  // namespace alhazen
