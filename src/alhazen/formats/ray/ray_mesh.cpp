#include "alhazen/formats/ray/ray_mesh.h"

#include <cmath>
#include <memory>

#include "alhazen/formats/mesh/mesh_lists.h"

namespace alhazen {

namespace {

bool wants_normals(BlockReader& reader, Diagnostics& diagnostics) {
    reader.ignore("gennormals");
    bool generate = false;
    std::optional<TextNode> previous;
    for (const TextNode item : reader.block()) {
        const bool word = item.is(NodeKind::Word, "gennormals");  // `gennormals;`
        if (!word && !item.is(NodeKind::Pair, "gennormals")) continue;
        // The reader warns of two pairs.
        if (previous && (word || previous->is(NodeKind::Word))) {
            diagnostics.warning(item.location(), reader.what() + ": 'gennormals' is given twice");
        }
        if (word) {
            generate = true;
        } else if (!item.broken() && !item.empty()) {
            reader.values().read(item.first(), "gennormals", generate);
        }
        previous = item;
    }
    return generate;
}

void read_vertex_materials(BlockReader& reader, RayMaterials& materials,
                           const RayMaterial& enclosing, TriangleMesh& mesh) {
    const auto list = reader.find("materials");
    if (!list || !reader.values().is_list(*list, "materials")) return;
    if (list->size() == 0) return;  // as in the programs of the courses
    if (!has_one_per_vertex(*list, "materials", mesh.positions.size(), reader.values())) return;
    for (const TextNode value : *list) {
        RayMaterial material = materials.read(value, enclosing);
        mesh.vertex_materials.push_back(static_cast<std::uint32_t>(materials.use(material)));
    }
}

void report_other_items(BlockReader& reader, Diagnostics& diagnostics) {
    for (const TextNode item : reader.block()) {
        if (item.is(NodeKind::Pair) || item.broken() || item.is(NodeKind::Word, "gennormals"))
            continue;
        diagnostics.warning(item.location(), reader.what() + ": unexpected " + item.describe());
    }
}

}  // namespace

std::optional<MeshIndex> read_ray_mesh(BlockReader& reader, RayContext& context,
                                       RayMaterials& materials, const RayMaterial& material) {
    auto mesh = std::make_shared<TriangleMesh>();
    reader.require("points");
    reader.require("faces");
    const auto points = reader.find("points");
    const auto faces = reader.find("faces");
    const auto normals = reader.find("normals");
    const bool readable = points && read_points(*points, "points", reader.values(), *mesh) &&
                          faces && read_faces(*faces, "faces", reader.values(), *mesh);
    if (readable) {
        context.count_elements(mesh->positions.size() + mesh->triangles.size(),
                               reader.block().location());
        const bool given = normals && !(normals->is(NodeKind::List) && normals->size() == 0);
        if (given) {
            read_normals(*normals, "normals", reader.values(), NormalLengths::AsWritten, *mesh);
        }
        read_vertex_materials(reader, materials, material, *mesh);
    } else {
        reader.ignore("materials");
    }
    if (wants_normals(reader, context.diagnostics) && readable) mesh->generate_mean_normals();
    report_other_items(reader, context.diagnostics);
    if (!readable) return std::nullopt;
    context.scene.meshes.push_back({"", std::move(mesh), reader.block().location()});
    return static_cast<MeshIndex>(context.scene.meshes.size() - 1);
}

}  // namespace alhazen
