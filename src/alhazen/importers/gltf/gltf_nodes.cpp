#include "alhazen/importers/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "alhazen/importers/gltf/gltf_skin.h"

namespace alhazen::gltf {

namespace {

bool is_read(const std::string& semantic) {
    static constexpr std::array<std::string_view, 6> kRead{"POSITION",   "NORMAL",     "TANGENT",
                                                           "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    return semantic.starts_with('_') || semantic.starts_with("JOINTS_") ||
           semantic.starts_with("WEIGHTS_") ||
           std::find(kRead.begin(), kRead.end(), semantic) != kRead.end();
}

/// [instance] the transforms of EXT_mesh_gpu_instancing.
std::vector<Affine> instance_transforms(const Document& document, const Attributes& attributes,
                                        ElementBudget& budget) {
    std::size_t count = 0;
    const auto read = [&](const char* semantic, std::size_t width) {
        const auto found = attributes.find(semantic);
        if (found == attributes.end()) return std::vector<double>{};
        const Accessor& accessor = document.accessors[found->second];
        if (component_count(accessor.type) != width) return std::vector<double>{};
        budget.take(accessor.count);
        std::vector<double> numbers = read_numbers(document, found->second);
        // The counts of a valid file agree.
        count = count == 0 ? accessor.count : std::min<std::size_t>(count, accessor.count);
        return numbers;
    };
    const std::vector<double> t = read("TRANSLATION", 3);
    const std::vector<double> r = read("ROTATION", 4);
    const std::vector<double> s = read("SCALE", 3);
    std::vector<Affine> transforms;
    transforms.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Vec3 translation{0, 0, 0}, scale{1, 1, 1};
        Quaternion rotation{0, 0, 0, 1};
        if (!t.empty()) translation = {t[3 * i], t[3 * i + 1], t[3 * i + 2]};
        if (!r.empty()) rotation = {r[4 * i], r[4 * i + 1], r[4 * i + 2], r[4 * i + 3]};
        if (!s.empty()) scale = {s[3 * i], s[3 * i + 1], s[3 * i + 2]};
        transforms.push_back(transform_of(translation, rotation, scale));
    }
    return transforms;
}

}  // namespace

NodeBuilder::NodeBuilder(const Document& document, const ImportSource& source, const Pose& pose,
                         SceneDescription& scene, Diagnostics& diagnostics)
    : document_(document),
      source_(source),
      pose_(pose),
      scene_(scene),
      diagnostics_(diagnostics),
      budget_(source.options.max_elements),
      default_material_(scene),
      mesh_seen_(document.meshes.size(), 0) {}

void NodeBuilder::add(std::span<const Index> nodes, const std::vector<Affine>& world_from_node) {
    for (const Index index : nodes) {
        const Node& node = document_.nodes[index];
        if (!node.mesh) continue;
        const std::string name = (node.name.empty() ? fmt::format("node {}", index) : node.name) +
                                 "/" + mesh_name(*node.mesh);
        const std::vector<double>& own = pose_[index].weights;
        const auto& weights = own.empty() ? document_.meshes[*node.mesh].weights : own;
        if (node.skin) {
            budget_.take(document_.skins[*node.skin].joints.size());
            const std::vector<Affine> joints =
                joint_matrices(document_, document_.skins[*node.skin], world_from_node);
            bool skinned = true;
            const ObjectIndex object = make_object(*node.mesh, weights, &joints, skinned);
            if (skinned) {
                place(object, Affine{}, name);
            } else if (is_invertible(world_from_node[index])) {
                place(object, world_from_node[index], name);
            }
        } else if (!node.instances.empty()) {
            place_instances(node, shared_object(node, weights), world_from_node[index], name);
        } else if (is_invertible(world_from_node[index])) {
            place(shared_object(node, weights), world_from_node[index], name);
        }
    }
    report_left_out();
}

ObjectIndex NodeBuilder::shared_object(const Node& node, const std::vector<double>& weights) {
    const ObjectKey key{*node.mesh, weights};
    if (const auto found = objects_.find(key); found != objects_.end()) return found->second;
    bool skinned = false;
    const ObjectIndex object = make_object(*node.mesh, weights, nullptr, skinned);
    objects_.emplace(key, object);
    return object;
}

/// `skinned` becomes false when the mesh has a primitive without joints.
ObjectIndex NodeBuilder::make_object(Index index, const std::vector<double>& weights,
                                     const std::vector<Affine>* world_from_bound, bool& skinned) {
    const Mesh& mesh = document_.meshes[index];
    const bool first_time = mesh_seen_[index] == 0;
    mesh_seen_[index] = 1;
    ObjectDescription object{mesh_name(index), {}, {source_.path.string(), 0, 0}};
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& primitive = mesh.primitives[i];
        if (first_time) count_left_out(primitive);
        PrimitiveGeometry geometry =
            read_primitive(document_, primitive, weights, world_from_bound != nullptr, budget_);
        if (geometry.mesh.triangles.empty()) continue;
        if (world_from_bound != nullptr && geometry.joints.per_vertex > 0) {
            apply_skin(geometry, *world_from_bound);
        } else {
            skinned = false;
        }
        add_mesh_part(index, i, std::move(geometry), object);
    }
    scene_.objects.push_back(std::move(object));
    return ObjectIndex{std::uint32_t(scene_.objects.size() - 1)};
}

void NodeBuilder::count_left_out(const Primitive& primitive) {
    for (const auto& [semantic, accessor] : primitive.attributes) {
        if (!is_read(semantic)) ++other_attributes_[semantic];
    }
    if (primitive.mode == PrimitiveMode::Points) {
        ++points_;
    } else if (!makes_surface(primitive.mode)) {
        ++lines_;
    } else if (primitive.attributes.count("POSITION") == 0) {
        ++without_positions_;
    }
}

void NodeBuilder::add_mesh_part(Index mesh, std::size_t primitive, PrimitiveGeometry geometry,
                                ObjectDescription& object) {
    const Mesh& owner = document_.meshes[mesh];
    std::string name = mesh_name(mesh);
    if (owner.primitives.size() > 1) name += fmt::format(".{}", primitive);
    Part part;
    part.what = MeshIndex{std::uint32_t(scene_.meshes.size())};
    const std::optional<Index> material = owner.primitives[primitive].material;
    part.material = material ? MaterialId{*material} : default_material_.id();
    part.name = name;
    part.location = object.location;
    scene_.meshes.push_back({std::move(name),
                             std::make_shared<TriangleMesh>(std::move(geometry.mesh)),
                             object.location});
    object.parts.push_back(std::move(part));
}

void NodeBuilder::place(ObjectIndex object, const Affine& world_from_part, std::string name) {
    if (scene_.objects[std::size_t(object)].parts.empty()) return;
    Part part;
    part.what = object;
    part.object_from_part = world_from_part;
    part.name = std::move(name);
    part.location = {source_.path.string(), 0, 0};
    scene_.objects.front().parts.push_back(std::move(part));
}

void NodeBuilder::place_instances(const Node& node, ObjectIndex object,
                                  const Affine& world_from_node, const std::string& name) {
    const std::vector<Affine> transforms = instance_transforms(document_, node.instances, budget_);
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const Affine world_from_instance = world_from_node * transforms[i];
        if (!is_invertible(world_from_instance)) continue;
        place(object, world_from_instance, fmt::format("{}[{}]", name, i));
    }
}

std::string NodeBuilder::mesh_name(Index mesh) const {
    const std::string& name = document_.meshes[mesh].name;
    return name.empty() ? fmt::format("mesh {}", mesh) : name;
}

void NodeBuilder::report_left_out() const {
    const FileLocation where{source_.path.string(), 0, 0};
    const auto primitives = [](std::size_t n) {
        return fmt::format("{} primitive{}", n, n == 1 ? "" : "s");
    };
    if (points_ + lines_ > 0) {
        diagnostics_.warning(
            where, fmt::format("points and lines make no surface; left out: {} of points, {} of "
                               "lines",
                               primitives(points_), primitives(lines_)));
    }
    if (without_positions_ > 0) {
        diagnostics_.warning(where, primitives(without_positions_) + " without POSITION left out");
    }
    for (const auto& [semantic, count] : other_attributes_) {
        diagnostics_.warning(
            where, fmt::format("the attribute {} is not read ({})", semantic, primitives(count)));
    }
}

}  // namespace alhazen::gltf
