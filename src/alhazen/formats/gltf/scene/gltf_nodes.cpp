#include "alhazen/formats/gltf/scene/gltf_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "alhazen/formats/gltf/scene/gltf_skin.h"

namespace alhazen::gltf {

namespace {

bool is_read(const std::string& semantic) {
    static constexpr std::array<std::string_view, 6> kRead{"POSITION",   "NORMAL",     "TANGENT",
                                                           "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};
    return semantic.starts_with('_') || semantic.starts_with("JOINTS_") ||
           semantic.starts_with("WEIGHTS_") ||
           std::find(kRead.begin(), kRead.end(), semantic) != kRead.end();
}

bool has_joints(const Primitive& primitive) {
    return primitive.attributes.count("JOINTS_0") != 0;
}

/// Number of instances of EXT_mesh_gpu_instancing; ignored attributes are also considered.
std::uint64_t instance_count(const Document& document, const Attributes& attributes) {
    std::uint64_t count = std::numeric_limits<std::uint64_t>::max();
    for (const auto& [semantic, accessor] : attributes) {
        // All counts agree in a valid file.
        count = std::min(count, document.accessors[accessor].count);
    }
    return attributes.empty() ? 0 : count;
}

/// Transforms of the instances, [instance].
std::vector<Affine> instance_transforms(const Document& document, const Attributes& attributes,
                                        std::uint64_t count, Budget& budget) {
    const auto read = [&](const char* semantic, std::size_t width) {
        const auto found = attributes.find(semantic);
        if (found == attributes.end()) return std::vector<double>{};
        if (component_count(document.accessors[found->second].type) != width) {
            return std::vector<double>{};
        }
        budget.take(count);
        return read_numbers(document, found->second, count);
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
                         Budget& budget, SceneDescription& scene, Diagnostics& diagnostics)
    : document_(document),
      source_(source),
      pose_(pose),
      budget_(budget),
      scene_(scene),
      diagnostics_(diagnostics),
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
            add_skinned(index, weights, world_from_node, name);
        } else if (!node.instances.empty()) {
            place_instances(node, shared_object({*node.mesh, weights}, nullptr),
                            world_from_node[index], name);
        } else if (is_invertible(world_from_node[index])) {
            place(shared_object({*node.mesh, weights}, nullptr), world_from_node[index], name);
        }
    }
    report_left_out();
}

void NodeBuilder::add_skinned(Index index, const std::vector<double>& weights,
                              const std::vector<Affine>& world_from_node, const std::string& name) {
    const Node& node = document_.nodes[index];
    const auto& primitives = document_.meshes[*node.mesh].primitives;
    const std::vector<Affine>& joints = joints_of(*node.skin, world_from_node);
    place(shared_object({*node.mesh, weights, Primitives::WithJoints, *node.skin}, &joints),
          Affine{}, name);
    if (std::all_of(primitives.begin(), primitives.end(), has_joints)) return;
    if (!is_invertible(world_from_node[index])) return;
    place(shared_object({*node.mesh, weights, Primitives::WithoutJoints}, nullptr),
          world_from_node[index], name);
}

const std::vector<Affine>& NodeBuilder::joints_of(Index skin,
                                                  const std::vector<Affine>& world_from_node) {
    const auto [entry, fresh] = joints_.try_emplace(skin);
    if (fresh) {
        budget_.take(document_.skins[skin].joints.size());
        entry->second = joint_matrices(document_, document_.skins[skin], world_from_node);
    }
    return entry->second;
}

ObjectIndex NodeBuilder::shared_object(ObjectKey key, const std::vector<Affine>* joints) {
    if (const auto found = objects_.find(key); found != objects_.end()) return found->second;
    budget_.make(1, sizeof(ObjectDescription) + sizeof(double) * key.weights.size());
    const ObjectIndex object = make_object(key, joints);
    objects_.emplace(std::move(key), object);
    return object;
}

ObjectIndex NodeBuilder::make_object(const ObjectKey& key, const std::vector<Affine>* joints) {
    const Mesh& mesh = document_.meshes[key.mesh];
    const bool first_time = mesh_seen_[key.mesh] == 0;
    mesh_seen_[key.mesh] = 1;
    ObjectDescription object{mesh_name(key.mesh), {}, {source_.path.string(), 0, 0}};
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const Primitive& primitive = mesh.primitives[i];
        if (first_time) count_left_out(primitive);
        const bool wanted = key.primitives == Primitives::All ||
                            has_joints(primitive) == (key.primitives == Primitives::WithJoints);
        if (!wanted) continue;
        PrimitiveGeometry geometry =
            read_primitive(document_, primitive, key.weights, joints != nullptr, budget_);
        if (geometry.mesh.triangles.empty()) continue;
        if (joints != nullptr && geometry.joints.per_vertex > 0) apply_skin(geometry, *joints);
        add_mesh_part(key.mesh, i, std::move(geometry), object);
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
    budget_.make(1, part_bytes(name) + sizeof(MeshDescription));
    scene_.meshes.push_back({std::move(name),
                             std::make_shared<TriangleMesh>(std::move(geometry.mesh)),
                             object.location});
    object.parts.push_back(std::move(part));
}

void NodeBuilder::place(ObjectIndex object, const Affine& world_from_part, std::string name) {
    if (scene_.objects[std::size_t(object)].parts.empty()) return;
    budget_.make(1, part_bytes(name));
    Part part;
    part.what = object;
    part.object_from_part = world_from_part;
    part.name = std::move(name);
    part.location = {source_.path.string(), 0, 0};
    scene_.objects.front().parts.push_back(std::move(part));
}

void NodeBuilder::place_instances(const Node& node, ObjectIndex object,
                                  const Affine& world_from_node, const std::string& name) {
    const std::uint64_t count = instance_count(document_, node.instances);
    // Checks the budget before reading: an accessor without data may have any number of elements.
    budget_.expect(count, part_bytes(name));
    const std::vector<Affine> transforms =
        instance_transforms(document_, node.instances, count, budget_);
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        const Affine world_from_instance = world_from_node * transforms[i];
        if (!is_invertible(world_from_instance)) continue;
        place(object, world_from_instance, fmt::format("{}[{}]", name, i));
    }
}

std::size_t NodeBuilder::part_bytes(const std::string& name) const {
    return sizeof(Part) + name.size() + source_.path.native().size();
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
            where, fmt::format("points and lines are not supported; left out: {} of points, {} of "
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
