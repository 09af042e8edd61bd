#include "alhazen/formats/native/read/native_meshes.h"

#include <memory>

#include "alhazen/base/file.h"
#include "alhazen/formats/mesh/mesh_lists.h"
#include "alhazen/formats/mesh_files/mesh_io.h"
#include "alhazen/formats/native/read/native_materials.h"

namespace alhazen {

namespace {

void read_inline_mesh(BlockReader& reader, TriangleMesh& mesh) {
    reader.require("points");
    reader.require("faces");
    const auto points = reader.find("points"), faces = reader.find("faces");
    const auto normals = reader.find("normals"), uvs = reader.find("uvs");
    if (!points || !read_points(*points, "points", reader.values(), mesh)) return;
    if (faces) read_faces(*faces, "faces", reader.values(), mesh);
    if (normals) read_normals(*normals, "normals", reader.values(), NormalLengths::Unit, mesh);
    if (uvs) read_uvs(*uvs, "uvs", reader.values(), mesh);
}

/// `materials`: maps the material numbers of the file, which are ignored without it.
void read_materials_of_file(BlockReader& reader, NativeContext& context, TriangleMesh& mesh) {
    const auto list = reader.find("materials");
    if (!list || !reader.values().is_list(*list, "materials")) {
        mesh.vertex_materials.clear();
        return;
    }
    std::vector<std::uint32_t> meanings;
    for (const TextNode value : *list) {
        const MaterialId id = read_material_value(value, context).value_or(MaterialId{0});
        meanings.push_back(static_cast<std::uint32_t>(id));
    }
    for (std::uint32_t& number : mesh.vertex_materials) {
        if (number >= meanings.size()) {
            reader.error(*list, "'materials' names " + std::to_string(meanings.size()) +
                                    ", but a vertex of the file has number " +
                                    std::to_string(number));
            mesh.vertex_materials.clear();
            return;
        }
        number = meanings[number];
    }
}

void read_mesh_file(BlockReader& reader, NativeContext& context, const NativeScope& scope,
                    TriangleMesh& mesh) {
    std::string file;
    if (!reader.read("file", file)) return;
    try {
        mesh = read_mesh(resolve_inside(context.roots, scope.folder, file), context.options,
                         context.diagnostics);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(*reader.find("file"), error.what());
    }
    read_materials_of_file(reader, context, mesh);
}

void read_vertex_materials(BlockReader& reader, NativeContext& context, TriangleMesh& mesh) {
    const auto list = reader.find("vertex_materials");
    if (!list || !reader.values().is_list(*list, "vertex_materials")) return;
    if (!has_one_per_vertex(*list, "vertex_materials", mesh.positions.size(), reader.values())) {
        return;
    }
    mesh.vertex_materials.clear();
    for (const TextNode value : *list) {
        const MaterialId id = read_material_value(value, context).value_or(MaterialId{0});
        mesh.vertex_materials.push_back(static_cast<std::uint32_t>(id));
    }
}

/// Reads the points of one key, from the list or from a mesh file, which may have normals.
bool read_point_key(TextNode value, BlockReader& reader, NativeContext& context,
                    const NativeScope& scope, TriangleMesh& pose) {
    if (!value.is(NodeKind::String)) {
        return read_points(value, "point_keys", reader.values(), pose);
    }
    try {
        pose = read_mesh(resolve_inside(context.roots, scope.folder, std::string(value.text())),
                         context.options, context.diagnostics);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Resource) throw;
        reader.error(value, error.what());
        return false;
    }
    return true;
}

/// Reads `point_keys = [(time, points or "FILE"), ...]`.
std::vector<MeshKey> read_point_keys(BlockReader& reader, NativeContext& context,
                                     const NativeScope& scope, const TriangleMesh& mesh,
                                     bool smooth) {
    const auto list = reader.find("point_keys");
    if (!list || !reader.values().is_list(*list, "point_keys")) return {};
    std::vector<MeshKey> keys;
    for (const TextNode entry : *list) {
        MeshKey& key = keys.emplace_back();
        TriangleMesh pose;
        if (!entry.is(NodeKind::List) || entry.size() != 2) {
            reader.values().fail(entry, "point_keys", "(time, points), ...");
            return {};
        }
        auto part = entry.begin();
        if (!reader.values().read(*part, "point_keys", key.time) ||
            !read_point_key(*++part, reader, context, scope, pose)) {
            return {};
        }
        if (smooth && pose.positions.size() == mesh.positions.size()) {
            pose.triangles = mesh.triangles;
            pose.generate_normals();
        }
        key.positions = std::move(pose.positions);
        if (!mesh.normals.empty()) key.normals = std::move(pose.normals);
    }
    if (const char* fault = fault_of(mesh, keys); fault != nullptr) {
        reader.error(*list, fault);
        return {};
    }
    return keys;
}

MeshIndex add_geometry(BlockReader& reader, std::string name, const FileLocation& where,
                       NativeContext& context, const NativeScope& scope) {
    auto mesh = std::make_shared<TriangleMesh>();
    bool smooth = false;
    reader.ignore("file");
    if (reader.has("file")) {
        read_mesh_file(reader, context, scope, *mesh);
    } else {
        read_inline_mesh(reader, *mesh);
    }
    read_vertex_materials(reader, context, *mesh);
    if (reader.read("smooth", smooth) && smooth) mesh->generate_normals();
    std::vector<MeshKey> keys = read_point_keys(reader, context, scope, *mesh, smooth);
    context.count_elements(mesh->positions.size() + mesh->triangles.size() + 1, where);
    for (const MeshKey& key : keys) context.count_elements(key.positions.size(), where);
    context.scene.meshes.push_back({std::move(name), std::move(mesh), where, std::move(keys)});
    return static_cast<MeshIndex>(context.scene.meshes.size() - 1);
}

}  // namespace

void read_native_geometry(const NativeBlock& block, NativeContext& context, NativeScope& scope) {
    if (block.name.empty()) {
        context.diagnostics.error(block.location,
                                  "geometry: expected a name, as in geometry \"wheel\" { }");
    }
    BlockReader reader = context.reader(*block.block, block.type);
    std::string name = block.name;
    reader.read("name", name);
    const MeshIndex index = add_geometry(reader, std::move(name), block.location, context, scope);
    reader.finish();
    if (block.name.empty()) return;
    define_name(block.name, index, "geometry", block.location, context.geometry_names,
                context.diagnostics);
}

std::optional<MeshIndex> read_native_mesh(BlockReader& reader, const NativeBlock& block,
                                          NativeContext& context, const NativeScope& scope) {
    const auto geometry = reader.find("geometry");
    if (!reader.has("geometry")) {
        return add_geometry(reader, block.name, block.location, context, scope);
    }
    if (!geometry) return std::nullopt;
    if (!geometry->is(NodeKind::String) && !geometry->is(NodeKind::Word)) {
        reader.values().fail(*geometry, "geometry", "the name of a geometry");
        return std::nullopt;
    }
    return look_up(*geometry, "geometry", context.geometry_names, context.diagnostics);
}

}  // namespace alhazen
