#include "alhazen/formats/obj/obj_importer.h"

#include <algorithm>
#include <array>

#include "alhazen/formats/mesh/mesh_scene.h"
#include "alhazen/formats/obj/obj_materials.h"
#include "alhazen/formats/obj/obj_reader.h"
#include "alhazen/formats/obj/obj_surfaces.h"
#include "alhazen/formats/text/text_cursor.h"
#include "alhazen/scene_model/read_pictures.h"

namespace alhazen {

namespace {

/// True if numbers follow a statement that other formats may also begin with (NFF has `v`, `f`,
/// `s`).
bool begins_with_numbers(std::string_view word, TextCursor cursor) {
    static constexpr std::array<std::string_view, 3> kVectors{"v", "vn", "vt"};
    if (std::find(kVectors.begin(), kVectors.end(), word) == kVectors.end()) return false;
    double number = 0;
    return cursor.skip_blanks() && cursor.number(number);
}

}  // namespace

bool looks_like_obj(std::string_view bytes) {
    static constexpr std::array<std::string_view, 7> kFirst{"mtllib", "usemtl", "o", "cstype",
                                                            "g",      "s",      "vp"};
    TextCursor cursor(bytes.substr(0, 65536));
    // Reads up to the first statement that is unique to OBJ.
    while (cursor.skip_to_word("#")) {
        const std::string_view word = cursor.word();
        if (begins_with_numbers(word, cursor)) return true;
        if (std::find(kFirst.begin(), kFirst.end(), word) == kFirst.end()) return false;
        if (word == "mtllib" || word == "usemtl") return true;
        cursor.skip_line();
    }
    return false;
}

const char* ObjImporter::description() const {
    return "Wavefront meshes with materials (.obj, .mtl), docs/reference/formats/obj.md";
}

int ObjImporter::recognise(const ImportSource& source) const {
    if (looks_like_obj(source.bytes)) return 2;
    return has_suffix(source.path, ".obj") ? 1 : 0;
}

SceneDescription ObjImporter::import(const ImportSource& source, Diagnostics& diagnostics) const {
    SceneDescription scene = make_mesh_scene(source, name(), UpAxis::Y);
    if (!is_plain_text(source, diagnostics)) return scene;
    const std::string file = source.path.string();
    const std::size_t errors_before = diagnostics.error_count();
    ObjStatements statements = read_obj_statements(source.bytes, file, source.options, diagnostics);
    if (diagnostics.error_count() != errors_before) return scene;
    const bool colored = !statements.colors.empty();
    const std::size_t points = statements.positions.size();
    ObjMaterials materials(source, scene, diagnostics, colored);
    materials.load(statements.libraries);
    materials.unify(statements);
    std::vector<ObjSurface> surfaces = make_obj_surfaces(statements, file, diagnostics);
    if (diagnostics.error_count() != errors_before) return scene;
    std::vector<ObjPart> parts = make_obj_parts(statements, file, diagnostics);
    if (diagnostics.error_count() != errors_before) return scene;
    if (parts.empty() && surfaces.empty()) {
        report_no_faces(source, points, diagnostics);
        return scene;
    }
    const auto name_of = [&](const std::string& group, const std::string& material) {
        const std::string& name = group.empty() ? material : group;
        return name.empty() ? source.path.stem().string() : name;
    };
    const auto use = [&](std::uint32_t material) {
        return materials.use(statements.materials[material],
                             {file, int(statements.material_lines[material]), 0});
    };
    for (ObjPart& part : parts) {
        const std::string& material = statements.materials[part.material];
        const std::string name = name_of(part.name, material);
        const FileLocation where{file, int(std::min<std::uint32_t>(part.line, 0x7FFFFFFF)), 0};
        const MaterialId id = use(part.material);
        if (part.lacks_uvs && reads_pictures(scene, id)) {
            diagnostics.warning(where, "the mesh '" + name.substr(0, 200) +
                                           "' has faces without texture coordinates (vt): they "
                                           "have the colours of its pictures at (0, 0)");
            part.mesh.uvs.resize(part.mesh.positions.size());
        }
        add_mesh(scene, std::move(part.mesh), name, id, where);
    }
    for (ObjSurface& surface : surfaces) {
        const std::string& material = statements.materials[surface.material];
        Part part;
        part.what = std::move(surface.shape);
        part.name = name_of(statements.names[surface.name], material);
        part.material = use(surface.material);
        part.location = surface.location;
        scene.objects.front().parts.push_back(std::move(part));
    }
    return scene;
}

}  // namespace alhazen
