#include "alhazen/formats/mesh/mesh_scene.h"

#include <memory>
#include <utility>
#include "alhazen/formats/core/default_conventions.h"

#include "alhazen/base/lower_case.h"
#include "alhazen/base/unicode_marks.h"

namespace alhazen {

SceneDescription make_mesh_scene(const ImportSource& source, const char* format, UpAxis up) {
    SceneDescription scene;
    scene.format = format;
    scene.path = source.path;
    scene.up_axis = up;
    scene.conventions = default_conventions();
    scene.objects.push_back({"scene", {}, {source.path.string(), 0, 0}});
    return scene;
}

Material default_mesh_material(bool colored) {
    Material m;
    m.name = "default";
    m.diffuse.color = colored ? Rgb{1, 1, 1} : Rgb{0.7, 0.7, 0.7};
    m.ambient = m.diffuse;
    return m;
}

void add_mesh(SceneDescription& scene, TriangleMesh mesh, std::string name, MaterialId material,
              const FileLocation& where) {
    Part part;
    part.what = MeshIndex(scene.meshes.size());
    part.material = material;
    part.name = name;
    part.location = where;
    scene.objects.front().parts.push_back(std::move(part));
    scene.meshes.push_back(
        {std::move(name), std::make_shared<TriangleMesh>(std::move(mesh)), where});
}

void report_no_faces(const ImportSource& source, std::size_t points, Diagnostics& diagnostics) {
    diagnostics.error({source.path.string(), 0, 0},
                      points == 0
                          ? "the file has no points and no faces"
                          : "the file has " + std::to_string(points) + " points but no faces");
}

bool is_plain_text(const ImportSource& source, Diagnostics& diagnostics) {
    const std::string_view bytes = source.bytes;
    const FileLocation start{source.path.string(), 1, 1};
    if (report_wide_text(bytes, start.file, diagnostics)) return false;
    if (is_empty_file(bytes)) {
        diagnostics.error(start, "the file is empty");
    } else if (bytes.substr(0, 65536).find('\0') != std::string_view::npos) {
        diagnostics.error(start, "the file is not text");
    } else {
        return true;
    }
    return false;
}

bool has_suffix(const std::filesystem::path& path, std::string_view suffix) {
    return lower_suffix(path) == suffix;
}

}  // namespace alhazen
