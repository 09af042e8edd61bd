#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/native/native_words.h"
#include "alhazen/formats/native/read/native_visibility.h"
#include "alhazen/formats/native/write/native_write_context.h"
#include "alhazen/formats/native/write/native_write_shapes.h"

namespace alhazen {

namespace {

// Meshes.

/// Meshes up to this size are written inline where possible.
constexpr std::size_t kInlineTriangles = 16;

bool can_stand_in_text(const TriangleMesh& mesh) {
    const auto finite = [](const Vec2& v) { return std::isfinite(v.x) && std::isfinite(v.y); };
    // The reader normalises normals in the text again, which may change a last bit.
    return mesh.triangles.size() <= kInlineTriangles &&
           mesh.positions.size() <= 3 * kInlineTriangles && mesh.normals.empty() &&
           mesh.uvs2.empty() && mesh.colors.empty() && mesh.tangents.empty() &&
           std::all_of(mesh.uvs.begin(), mesh.uvs.end(), finite);
}

void add_arrays(NativeBlockText& block, const NativeWriteContext& context,
                const TriangleMesh& mesh) {
    const auto face = [](const std::array<std::uint32_t, 3>& t) {
        return "(" + std::to_string(t[0]) + ", " + std::to_string(t[1]) + ", " +
               std::to_string(t[2]) + ")";
    };
    block.add("points",
              native_list_of(mesh.positions, [](const Vec3& p) { return native_value(p); }));
    block.add("faces", native_list_of(mesh.triangles, face));
    if (!mesh.uvs.empty()) {
        block.add("uvs", native_list_of(mesh.uvs, [](const Vec2& p) { return native_value(p); }));
    }
    if (!mesh.vertex_materials.empty()) {
        block.add("vertex_materials", native_list_of(mesh.vertex_materials, [&](std::uint32_t id) {
                      return native_string(context.material_labels[id]);
                  }));
    }
}

std::string write_ply(const NativeWriteContext& context, const TriangleMesh& mesh,
                      std::size_t number) {
    const std::string bytes = ply_bytes(mesh);
    return context.write_file("mesh_" + std::to_string(number) + ".ply",
                              std::as_bytes(std::span(bytes)));
}

/// Adds the mesh as a file, in which materials are numbered by their first use; `materials` names
/// them.
void add_file(NativeBlockText& block, const NativeWriteContext& context, const TriangleMesh& mesh,
              std::size_t number) {
    if (mesh.vertex_materials.empty()) {
        block.add("file", native_string(write_ply(context, mesh, number)));
        return;
    }
    TriangleMesh renumbered = mesh;
    std::map<std::uint32_t, std::uint32_t> numbers;
    std::vector<std::string> labels;
    for (std::uint32_t& id : renumbered.vertex_materials) {
        const auto [entry, fresh] =
            numbers.try_emplace(id, static_cast<std::uint32_t>(numbers.size()));
        if (fresh) labels.push_back(native_string(context.material_labels[id]));
        id = entry->second;
    }
    block.add("file", native_string(write_ply(context, renumbered, number)));
    block.add("materials", native_list(labels));
}

std::string write_pose(const NativeWriteContext& context, const TriangleMesh& mesh,
                       const MeshKey& key, const std::string& file) {
    TriangleMesh pose = mesh;
    pose.positions = key.positions;
    if (!key.normals.empty()) pose.normals = key.normals;
    const std::string bytes = ply_bytes(pose);
    return context.write_file(file, std::as_bytes(std::span(bytes)));
}

void add_point_keys(NativeBlockText& block, const NativeWriteContext& context,
                    const MeshDescription& mesh, std::size_t number) {
    std::vector<std::string> keys;
    const bool in_text = can_stand_in_text(*mesh.mesh);
    for (std::size_t k = 0; k < mesh.keys.size(); ++k) {
        const MeshKey& key = mesh.keys[k];
        const std::string file =
            "mesh_" + std::to_string(number) + "_key_" + std::to_string(k) + ".ply";
        const std::string points =
            in_text ? native_list_of(key.positions, [](const Vec3& p) { return native_value(p); })
                    : native_string(write_pose(context, *mesh.mesh, key, file));
        keys.push_back("(" + native_value(key.time) + ", " + points + ")");
    }
    block.add("point_keys", native_list(keys));
}

void write_part_block(NativeWriteContext& context, const Part& part, int indent) {
    const auto add_placement = [&](NativeBlockText& block) {
        block.add_unless("transform", part.motion ? part.motion->inner : part.object_from_part,
                         Affine{});
        if (part.motion) block.add("motion", native_value(part.motion->keys));
        if (part.visible_to != kAllRays)
            block.add("visible_to", native_visibility(part.visible_to));
    };
    if (const auto* object = std::get_if<ObjectIndex>(&part.what)) {
        const auto index = static_cast<std::size_t>(*object);
        NativeBlockText block("instance", context.object_labels[index]);
        add_placement(block);
        if (!part.name.empty()) block.add("name", native_string(part.name));
        context.append(block, indent);
        return;
    }
    const std::string material =
        native_string(context.material_labels[static_cast<std::size_t>(part.material)]);
    if (const auto* mesh = std::get_if<MeshIndex>(&part.what)) {
        NativeBlockText block("mesh", part.name);
        const auto& label = context.geometry_labels[static_cast<std::size_t>(*mesh)];
        block.add("geometry", native_string(label));
        add_placement(block);
        block.add("material", material);
        context.append(block, indent);
        return;
    }
    std::visit(
        [&]<class S>(const S& shape) {
            NativeBlockText block(S::kName, part.name);
            add_shape_fields(block, shape);
            add_placement(block);
            block.add("material", material);
            context.append(block, indent);
        },
        std::get<AnyShape>(part.what));
}

/// Writes a part; one that moves inside a static frame goes into a group with the frame's
/// transform.
void write_part(NativeWriteContext& context, const Part& part, int indent) {
    if (!part.motion || part.motion->outer == Affine{}) {
        return write_part_block(context, part, indent);
    }
    const std::string margin(static_cast<std::size_t>(indent), ' ');
    context.text += margin + "group {\n" + margin +
                    "    transform = " + native_value(part.motion->outer) + "\n";
    write_part_block(context, part, indent + 4);
    context.text += margin + "}\n";
}

/// The properties of the object's combination that differ from the default.
std::vector<std::pair<std::string, std::string>> combination_of(const ObjectDescription& object) {
    std::vector<std::pair<std::string, std::string>> pairs;
    if (object.combine != Combine::Group) {
        pairs.emplace_back("combine", native_word(object.combine));
    }
    if (object.cut_material != CutMaterial::Own) {
        pairs.emplace_back("cut_material", native_word(object.cut_material));
    }
    return pairs;
}

/// True if the scene needs a list of objects: without one, objects are numbered in the order of
/// definition, after the scene itself, and must be defined before they are placed.
bool needs_object_list(const SceneDescription& scene) {
    if (scene.root != ObjectIndex{0} || scene.objects.front().name != "scene") return true;
    if (!combination_of(scene.objects.front()).empty()) return true;
    for (std::size_t i = 1; i < scene.objects.size(); ++i) {
        for (const Part& part : scene.objects[i].parts) {
            const auto* child = std::get_if<ObjectIndex>(&part.what);
            if (child != nullptr && static_cast<std::size_t>(*child) >= i) return true;
        }
    }
    return false;
}

void write_object_list(NativeWriteContext& context) {
    const SceneDescription& scene = context.scene;
    const auto root = static_cast<std::size_t>(scene.root);
    const std::string& root_label = context.object_labels[root];
    NativeBlockText block("objects");
    block.add("names", native_list_of(context.object_labels, [](const std::string& label) {
                  return native_string(label);
              }));
    block.add("root", native_string(root_label));
    if (root_label != scene.objects[root].name) {
        block.add("root_name", native_string(scene.objects[root].name));
    }
    for (const auto& [key, word] : combination_of(scene.objects[root])) block.add(key, word);
    context.append(block);
}

}  // namespace

void write_native_geometries(NativeWriteContext& context) {
    for (std::size_t i = 0; i < context.scene.meshes.size(); ++i) {
        const MeshDescription& description = context.scene.meshes[i];
        NativeBlockText block("geometry", context.geometry_labels[i]);
        add_name(block, context.geometry_labels[i], description.name);
        if (can_stand_in_text(*description.mesh)) {
            add_arrays(block, context, *description.mesh);
        } else {
            add_file(block, context, *description.mesh, i);
        }
        if (!description.keys.empty()) add_point_keys(block, context, description, i);
        context.append(block);
    }
}

void write_native_objects(NativeWriteContext& context) {
    const SceneDescription& scene = context.scene;
    if (needs_object_list(scene)) write_object_list(context);
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        if (i == static_cast<std::size_t>(scene.root)) continue;
        const std::string& label = context.object_labels[i];
        context.text += "object " + native_string(label) + " {\n";
        if (label != scene.objects[i].name) {
            context.text += "    name = " + native_string(scene.objects[i].name) + "\n";
        }
        for (const auto& [key, word] : combination_of(scene.objects[i])) {
            context.text += "    " + key + " = " + word + "\n";
        }
        if (!scene.objects[i].accelerator.empty()) {
            context.text +=
                "    accelerator = " + native_string(scene.objects[i].accelerator) + "\n";
        }
        for (const Part& part : scene.objects[i].parts) write_part(context, part, 4);
        context.text += "}\n";
    }
    for (const Part& part : scene.objects[static_cast<std::size_t>(scene.root)].parts) {
        write_part(context, part, 0);
    }
}

}  // namespace alhazen
