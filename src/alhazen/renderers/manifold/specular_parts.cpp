#include "alhazen/renderers/manifold/specular_parts.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/shading/bsdf/bsdf.h"

namespace alhazen {

namespace {

/// True if the directions of reflection or refraction, and not only their weight, may vary over the
/// surface.
bool varies_in_form(const Material& m) {
    const auto textured = [](const auto& input) { return input.texture != kNoTexture; };
    if (m.alpha_mode != AlphaMode::Opaque || textured(m.normal_map) || textured(m.roughness) ||
        textured(m.index)) {
        return true;
    }
    if (!m.metallic_roughness) return false;
    const MetallicRoughness& p = *m.metallic_roughness;
    return p.unlit || textured(p.roughness) || textured(p.thickness) ||
           textured(p.coat.normal_map) || textured(p.coat.roughness) || textured(p.anisotropy);
}

/// The radius of a sphere under a similarity transform; empty for other transforms.
std::optional<double> radius_behind(const Mat3& linear, double radius) {
    const double x = length(linear.x_axis), y = length(linear.y_axis), z = length(linear.z_axis);
    constexpr double kSame = 1e-12;
    const bool same = std::abs(y - x) <= kSame * x && std::abs(z - x) <= kSame * x &&
                      std::abs(dot(linear.x_axis, linear.y_axis)) <= kSame * x * x &&
                      std::abs(dot(linear.y_axis, linear.z_axis)) <= kSame * x * x &&
                      std::abs(dot(linear.z_axis, linear.x_axis)) <= kSame * x * x;
    if (!same) return std::nullopt;
    return x * radius;
}

Box3 in_world(const Affine& world, const Box3& box) {
    if (box.empty() || world == Affine{}) return box;
    return box.bounded() ? transformed(world, box) : kAllSpace;
}

template <class S>
inline constexpr bool is_in_one_plane_v =
    std::is_same_v<S, Plane> || std::is_same_v<S, Disc> || std::is_same_v<S, Rectangle> ||
    std::is_same_v<S, HalfSpace>;

struct PointAndNormal {
    Vec3 point, normal;
};
PointAndNormal plane_of(const Plane& s) {
    return {s.point, s.unit_normal};
}
PointAndNormal plane_of(const HalfSpace& s) {
    return {s.point, normalize(s.normal)};
}
PointAndNormal plane_of(const Disc& s) {
    return {s.center, normalize(s.normal)};
}
PointAndNormal plane_of(const Rectangle& s) {
    return {s.corner, normalize(cross(s.edge_u, s.edge_v))};
}

bool is_closed(const PrimitiveTable& table, PrimitiveId id) {
    if (table.kind(id) == kTriangleKind) return false;
    return with_column(table.columns, table.kind(id),
                       [&](const auto& column) { return column.shapes[table.index(id)].closed(); });
}

std::uint32_t number_of_part(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id), index = table.index(id);
    if (kind == kTriangleKind) return table.mesh_of(index).part;
    return with_column(table.columns, kind, [&](const auto& column) {
        return column.parts.empty() ? 0u : column.parts[index];
    });
}

}  // namespace

SpecularParts::SpecularParts(const Scene& scene) : scene_(scene) {
    if (!scene.aggregate) return;
    for (const Material& m : scene.materials) materials_.push_back(bends_of(m));
    if (std::none_of(materials_.begin(), materials_.end(), [](Bends b) { return b.any(); })) return;
    if (has_some(*scene.aggregate)) expand(*scene.aggregate, {});
    for (SpecularPart& part : parts_) {
        part.bounded = part.box.bounded();
        if (!part.bounded) continue;
        part.around = {part.box.center(), 0.5 * length(part.box.size())};
        if (part.sphere) part.around = *part.sphere;
        part.around.radius *= 1.0 + 1e-9;
    }
}

SpecularParts::Bends SpecularParts::bends_of(const Material& material) const {
    Bends bends;
    if (varies_in_form(material)) return bends;
    for (const bool from_inside : {false, true}) {
        const Bsdf bsdf = bsdf_of(material, scene_.textures, {}, {.from_inside = from_inside});
        for (const double sine : {0.0, 0.95}) {
            const Vec3 view{sine, 0.0, std::sqrt(1.0 - sine * sine)};
            const SingularLight light = bsdf.singular(view, Transport::Radiance);
            bends.reflects |= !light.reflected.is_black();
            bends.refracts |= !light.transmitted.is_black();
        }
    }
    return bends;
}

std::optional<MaterialId> SpecularParts::bending(const PrimitiveTable& table,
                                                 PrimitiveId id) const {
    if (!table.is_seen(id, mask_of(RayKind::Reflection))) return std::nullopt;
    MaterialId material;
    if (table.kind(id) == kTriangleKind) {
        const PlacedMesh& placed = table.mesh_of(table.index(id));
        if (!placed.mesh->vertex_materials.empty()) return std::nullopt;
        material = placed.material;
    } else {
        material = table.shape_material(id);
    }
    if (!materials_[static_cast<std::size_t>(material)].any()) return std::nullopt;
    return material;
}

bool SpecularParts::has_some(const Aggregate& aggregate) {
    const auto known = has_some_.find(&aggregate);
    if (known != has_some_.end()) return known->second;
    const PrimitiveTable& table = aggregate.primitives();
    bool found = false;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const PrimitiveId id{i};
        found = found || (table.kind(id) == kInstanceKind
                              ? has_some(*table.instances[table.index(id)].aggregate)
                              : bending(table, id).has_value());
    }
    has_some_.emplace(&aggregate, found);
    return found;
}

void SpecularParts::expand(const Aggregate& aggregate, const Owner& owner) {
    const PrimitiveTable& table = aggregate.primitives();
    Owner around = owner;
    if (dynamic_cast<const CsgAggregate*>(&aggregate) != nullptr) {
        around.solid = in_world(owner.world, aggregate.box());
    }
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const PrimitiveId id{i};
        if (table.kind(id) != kInstanceKind) {
            add(table, id, around);
            continue;
        }
        const Instance& instance = table.instances[table.index(id)];
        if (!table.is_seen(id, mask_of(RayKind::Reflection)) || !has_some(*instance.aggregate)) {
            continue;
        }
        Owner inside = around;
        inside.world = owner.world * instance.placement.outer_from_inner;
        inside.moves = owner.moves || instance.motion != nullptr;
        if (!inside.instance && !instance.holds_rest) inside.instance = instance.part;
        expand(*instance.aggregate, inside);
    }
}

void SpecularParts::add(const PrimitiveTable& table, PrimitiveId id, const Owner& owner) {
    const std::optional<MaterialId> material = bending(table, id);
    if (!material) return;
    const std::uint64_t key =
        part_key(owner.instance ? *owner.instance : number_of_part(table, id), *material);
    const auto [known, is_new] = by_key_.emplace(key, parts_.size());
    if (is_new && parts_.size() == kMostSpecularParts) {
        leaves_some_out_ = true;
        by_key_.erase(known);
        return;
    }
    if (is_new) {
        const Bends bends = materials_[static_cast<std::size_t>(*material)];
        SpecularPart& part = parts_.emplace_back();
        part.key = key;
        part.reflects = bends.reflects;
        part.refracts = bends.refracts;
    }
    SpecularPart& part = parts_[known->second];
    const std::uint32_t kind = table.kind(id);
    const bool vertices_move =
        kind == kTriangleKind && table.mesh_of(table.index(id)).motion != nullptr;
    const Box3 box = owner.solid ? *owner.solid
                                 : in_world(owner.world, table.box(static_cast<std::uint32_t>(id)));
    part.box.include(owner.moves || vertices_move ? kAllSpace : box);
    part.closed = part.closed && (owner.solid || is_closed(table, id));
    part.sphere.reset();
    part.flat.reset();
    if (is_new && !owner.solid && !owner.moves) set_form(table, id, owner, part);
}

void SpecularParts::set_form(const PrimitiveTable& table, PrimitiveId id, const Owner& owner,
                             SpecularPart& part) const {
    const std::uint32_t kind = table.kind(id);
    if (kind == kTriangleKind) return;
    const Placement* const placed = table.placement_of(id);
    const Affine all = placed != nullptr ? owner.world * placed->outer_from_inner : owner.world;
    with_column(table.columns, kind, [&](const auto& column) {
        using S = typename ShapeOfColumn<decltype(column)>::Type;
        const S& shape = column.shapes[table.index(id)];
        if constexpr (std::is_same_v<S, Sphere>) {
            const auto radius = radius_behind(all.linear, shape.radius);
            if (radius) part.sphere = BoundingSphere{all.point(shape.center), *radius};
        } else if constexpr (is_in_one_plane_v<S>) {
            const auto [point, normal] = plane_of(shape);
            part.flat = FlatPlace{all.point(point),
                                  normalize(transpose_times(inverse(all.linear), normal))};
        }
    });
}

}  // namespace alhazen
