#include "alhazen/formats/rib/rib_scene.h"

#include <algorithm>
#include <cmath>

#include "alhazen/formats/mesh/mesh_scene.h"

namespace alhazen {

void RibScene::error(const RibPlace& place, const std::string& message) {
    diagnostics_.error(at(place), message);
    ++errors_;
}

void RibScene::warning(const RibPlace& place, const std::string& message) {
    diagnostics_.warning(at(place), message);
}

MaterialId RibScene::material_of(const Rgb& color) {
    const auto number = MaterialId(scene_.materials.size());
    const auto [entry, fresh] = materials_.try_emplace({color.r, color.g, color.b}, number);
    if (fresh) {
        Material material = default_mesh_material();
        material.name = "color_" + std::to_string(scene_.materials.size() + 1);
        material.diffuse.color = color;
        material.ambient = material.diffuse;
        scene_.materials.push_back({std::move(material), {file_, 0, 0}});
    }
    return entry->second;
}

Part& RibScene::add_part(const RibState& state, const RibPlace& place) {
    Part part;
    part.object_from_part = state.transform;
    part.material = material_of(state.color);
    part.name = name_;
    part.location = at(place);
    std::vector<Part>& parts = scene_.objects[current_].parts;
    parts.push_back(std::move(part));
    part_colors_.resize(scene_.objects.size());
    part_colors_[current_].push_back({state.color, state.inherits_color});
    return parts.back();
}

void RibScene::count(std::uint64_t points, const FileLocation& where) {
    points_ += points;
    if (points_ <= limit_) return;
    throw Error(ErrorKind::Resource, "more than " + std::to_string(limit_) + " control points",
                where);
}

RibScene::Meshed& RibScene::mesh_of(const RibState& state, const BezierNet& net,
                                    const RibPlace& place) {
    const auto& [x, y, z] = state.transform.linear;
    const Vec3& t = state.transform.translation;
    const Rgb& c = state.color;
    const Key key{double(current_),
                  double(net.degree_u * 16 + net.degree_v),
                  x.x,
                  x.y,
                  x.z,
                  y.x,
                  y.y,
                  y.z,
                  z.x,
                  z.y,
                  z.z,
                  t.x,
                  t.y,
                  t.z,
                  c.r,
                  c.g,
                  c.b,
                  state.inherits_color ? 1.0 : 0.0};
    const auto [entry, fresh] = mesh_numbers_.try_emplace(key, meshes_.size());
    if (fresh) {
        add_part(state, place);
        meshes_.push_back({PatchWelder(std::uint32_t(net.degree_u), std::uint32_t(net.degree_v)),
                           current_, scene_.objects[current_].parts.size() - 1});
    }
    return meshes_[entry->second];
}

void RibScene::add_patch(const RibState& state, const BezierNet& given, const RibPlace& place) {
    const BezierNet net = state.reversed ? transposed(given) : given;
    const std::size_t size = std::size_t(net.count());
    std::array<Vec3, kMaxPatchOrder * kMaxPatchOrder> points;
    std::array<double, kMaxPatchOrder * kMaxPatchOrder> weights{};
    for (std::size_t k = 0; k < size; ++k) {
        weights[k] = net.points[k].w;
        if (!(weights[k] > 0.0) || !std::isfinite(weights[k])) {
            error(place,
                  "the weights of a patch must be positive, not " + std::to_string(weights[k]));
            return;
        }
        points[k] = projected(net.points[k]);
        if (!std::isfinite(points[k].x) || !std::isfinite(points[k].y) ||
            !std::isfinite(points[k].z)) {
            error(place, "a control point of the patch is not finite");
            return;
        }
    }
    count(size, at(place));
    mesh_of(state, net, place).welder.add({points.data(), size}, {weights.data(), size});
}

void RibScene::add_shape(const RibState& state, AnyShape shape, const RibPlace& place) {
    if (const auto* surface = std::get_if<NurbsSurface>(&shape)) {
        count(surface->points.size(), at(place));
    }
    add_part(state, place).what = std::move(shape);
}

bool RibScene::begin_object(const std::string& name, const RibPlace& place) {
    if (in_object()) return false;
    current_ = scene_.objects.size();
    scene_.objects.push_back({"object_" + name, {}, at(place)});
    objects_[name] = current_;
    return true;
}

bool RibScene::end_object() {
    if (!in_object()) return false;
    current_ = 0;
    return true;
}

bool RibScene::add_instance(const RibState& state, const std::string& name, const RibPlace& place) {
    const auto found = objects_.find(name);
    if (found == objects_.end() || found->second == current_) return false;
    add_part(state, place).what = ObjectIndex(found->second);
    return true;
}

void RibScene::leave_out(const std::string& what, const RibPlace& place) {
    if (left_out_.empty()) first_left_out_ = place;
    ++left_out_[what];
}

std::size_t RibScene::colored(std::size_t object, const Rgb& color, int depth) {
    const std::vector<PartColor>& own = part_colors_[object];
    const bool inherits =
        std::any_of(own.begin(), own.end(), [](const PartColor& part) { return part.inherits; });
    if (!inherits) return object;
    if (depth > max_nesting_) {
        throw Error(ErrorKind::Resource,
                    "objects nested more than " + std::to_string(max_nesting_) + " deep",
                    scene_.objects[object].location);
    }
    const std::array<double, 4> key{double(object), color.r, color.g, color.b};
    if (const auto made = colored_.find(key); made != colored_.end()) return made->second;
    ObjectDescription copy = scene_.objects[object];
    bool differs = false;
    for (std::size_t k = 0; k < copy.parts.size(); ++k) {
        Part& part = copy.parts[k];
        if (!own[k].inherits) continue;
        if (const auto* of = std::get_if<ObjectIndex>(&part.what)) {
            const auto child = ObjectIndex(colored(std::size_t(*of), color, depth + 1));
            differs = differs || child != *of;
            part.what = child;
        }
        const MaterialId material = material_of(color);
        differs = differs || material != part.material;
        part.material = material;
    }
    std::size_t result = object;
    if (differs) {
        for (const Part& part : copy.parts) {
            const auto* shape = std::get_if<AnyShape>(&part.what);
            if (shape == nullptr) continue;
            if (const auto* mesh = std::get_if<PatchMesh>(shape)) {
                count(mesh->points.size(), copy.location);
            }
            if (const auto* surface = std::get_if<NurbsSurface>(shape)) {
                count(surface->points.size(), copy.location);
            }
        }
        result = scene_.objects.size();
        scene_.objects.push_back(std::move(copy));
    }
    colored_.emplace(key, result);
    return result;
}

void RibScene::color_instances() {
    part_colors_.resize(scene_.objects.size());
    // Instances refer to objects before their own; the world, which is the first, is the last.
    const std::size_t count = part_colors_.size();
    for (std::size_t number = 1; number <= count; ++number) {
        const std::size_t object = number % count;
        for (std::size_t k = 0; k < part_colors_[object].size(); ++k) {
            const PartColor& own = part_colors_[object][k];
            const auto* of = std::get_if<ObjectIndex>(&scene_.objects[object].parts[k].what);
            if (of == nullptr || own.inherits) continue;
            const auto child = ObjectIndex(colored(std::size_t(*of), own.color, 0));
            scene_.objects[object].parts[k].what = child;
        }
    }
}

void RibScene::finish() {
    for (Meshed& mesh : meshes_) {
        scene_.objects[mesh.object].parts[mesh.part].what = AnyShape{mesh.welder.take()};
    }
    color_instances();
    if (left_out_.empty()) return;
    std::string list;
    for (const auto& [what, number] : left_out_) {
        list += (list.empty() ? "" : ", ") + std::to_string(number) + " " + what;
    }
    warning(first_left_out_, "geometry left out: " + list);
}

}  // namespace alhazen
