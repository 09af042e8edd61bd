#include "alhazen/illumination/emitter_list.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/illumination/emitters_of_shape.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/shading/materials/texture_inputs.h"

namespace alhazen {

namespace {

/// The emission of a surface times its coverage.
Rgb emission_at(const Scene& scene, const Surface& surface) {
    const SurfaceLookup lookup{
        {surface.uv, surface.uv2}, {}, surface.color, {surface.point, {}, {}}};
    Rgb sum;
    for (std::size_t i = 0; i < static_cast<std::size_t>(surface.material_count); ++i) {
        const Material& m = scene.materials[static_cast<std::size_t>(surface.materials[i])];
        const MaterialSample s = evaluate(m, scene.textures, lookup);
        if (!s.unlit) sum += (surface.weights[i] * s.coverage) * s.emission;
    }
    return sum;
}

}  // namespace

EmitterList::EmitterList(const Scene& scene) : scene_(scene) {
    if (!scene.aggregate) return;
    may_shine_ = std::any_of(scene.materials.begin(), scene.materials.end(),
                             [&](const Material& m) { return emits(m); });
    if (!may_shine_) return;
    emitters_.reserve(count(*scene.aggregate).count());
    has_unsampled_ |= emitters_.capacity() >= kMostEmitters;
    expand(*scene.aggregate, {});
    for (std::size_t i = 0; i < emitters_.size(); ++i) {
        if (!make_ready(emitters_[i])) {
            // A polygon whose corners are off its plane shines, and is met by chance.
            has_unsampled_ |= emitters_[i].form == EmitterForm::Polygon;
            emitters_[i].area = 0.0;
            continue;
        }
        if (emitters_[i].form == EmitterForm::Sphere) {
            const Mat3 own = inverse(emitters_[i].world_from_own.linear);
            emitters_[i].in_plane =
                rounding(i) * (length(own.x_axis) + length(own.y_axis) + length(own.z_axis));
        }
        if (varying_[i]) {
            emitters_[i].radiance = mean_radiance(i);
            if (!emitters_[i].radiance.is_finite()) emitters_[i].area = 0.0;
        }
    }
    for (const Emitter& e : emitters_) has_area_.push_back(e.area > 0.0);
}

bool EmitterList::emits(const Material& m) const {
    if (m.metallic_roughness && m.metallic_roughness->unlit) return false;
    return m.emission.color.max() > 0.0 && m.emission.color.is_finite();
}

bool EmitterList::varies(const Material& m) const {
    return m.emission.texture != kNoTexture || m.alpha_mode != AlphaMode::Opaque;
}

bool EmitterList::emits(const PrimitiveTable& table, PrimitiveId id) const {
    const auto material_emits = [&](MaterialId m) {
        return emits(scene_.materials[static_cast<std::size_t>(m)]);
    };
    if (table.kind(id) != kTriangleKind) return material_emits(table.shape_material(id));
    const std::uint32_t i = table.index(id);
    const PlacedMesh& placed = table.mesh_of(i);
    const auto& of_vertices = placed.mesh->vertex_materials;
    if (of_vertices.empty()) return material_emits(placed.material);
    const auto& corners = *table.triangle_corners(i);
    return std::any_of(corners.begin(), corners.end(),
                       [&](std::uint32_t v) { return material_emits(MaterialId{of_vertices[v]}); });
}

std::uint32_t EmitterList::emitters_of(const PrimitiveTable& table, PrimitiveId id) {
    if (!table.is_seen(id, mask_of(RayKind::Reflection))) return 0;
    const std::uint32_t kind = table.kind(id), i = table.index(id);
    if (kind == kInstanceKind) {
        const Instance& instance = table.instances[i];
        const std::uint32_t inside = count(*instance.aggregate).count();
        if (!instance.motion) return inside;
        has_unsampled_ |= inside > 0;
        return 0;
    }
    return emits(table, id) ? emitters_of_shape(table, id) : 0;
}

bool EmitterList::may_be_half(const PrimitiveTable& table, PrimitiveId id) const {
    if (table.kind(id) != kTriangleKind) return false;
    const PlacedMesh& placed = table.mesh_of(table.index(id));
    return placed.mesh->vertex_materials.empty() &&
           !varies(scene_.materials[static_cast<std::size_t>(placed.material)]);
}

const EmitterList::Table& EmitterList::count(const Aggregate& aggregate) {
    const auto known = tables_.find(&aggregate);
    if (known != tables_.end()) return known->second;
    Table result;
    std::uint64_t sum = 0;
    const PrimitiveTable& table = aggregate.primitives();
    const bool is_solid = dynamic_cast<const CsgAggregate*>(&aggregate) != nullptr;
    const bool is_top = &aggregate == scene_.aggregate.get();
    bool follows_half = false;  // the primitive before may be a first half
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        const PrimitiveId id{i};
        const bool follows = std::exchange(follows_half, false);
        const std::uint32_t found = is_solid ? 0 : emitters_of(table, id);
        if (found == 0) {
            has_unsampled_ |= table.kind(id) != kInstanceKind && emits(table, id);
            continue;
        }
        result.primitives.push_back(i);
        const bool is_half = is_top && sum < kMostEmitters && may_be_half(table, id);
        if (is_half && follows && rectangle_of_halves(table, PrimitiveId{i - 1}, id)) {
            result.before.push_back(result.before.back());
            continue;
        }
        follows_half = is_half;
        result.before.push_back(static_cast<std::uint32_t>(sum));
        sum = std::min<std::uint64_t>(sum + found, kMostEmitters);
    }
    result.before.push_back(static_cast<std::uint32_t>(sum));
    result.set_blocks();
    return tables_.emplace(&aggregate, std::move(result)).first->second;
}

void EmitterList::expand(const Aggregate& aggregate, const Holder& holder) {
    const PrimitiveTable& table = aggregate.primitives();
    const Table& counted = tables_.at(&aggregate);
    for (std::size_t k = 0; k < counted.primitives.size(); ++k) {
        const PrimitiveId id{counted.primitives[k]};
        if (k > 0 && counted.before[k] == counted.before[k - 1] &&
            counted.before[k] < kMostEmitters) {
            join_half(table, PrimitiveId{counted.primitives[k - 1]}, id);
            continue;
        }
        if (emitters_.size() >= kMostEmitters) return;
        if (table.kind(id) == kInstanceKind) {
            const Instance& instance = table.instances[table.index(id)];
            Holder inner{holder.frames, holder.seen_by & table.visible_to(id)};
            inner.frames.push_back(holder.world_from_table() * instance.placement.outer_from_inner);
            expand(*instance.aggregate, inner);
        } else {
            expand_primitive(table, id, holder);
        }
    }
}

void EmitterList::join_half(const PrimitiveTable& table, PrimitiveId first, PrimitiveId second) {
    Emitter& e = emitters_.back();
    const Emitter half = std::exchange(e, *rectangle_of_halves(table, first, second));
    e.two_sided = half.two_sided;
    e.unseen = half.unseen;
    e.radiance = half.radiance;
    e.illuminant = half.illuminant;
}

void EmitterList::set_rounding(const PrimitiveTable& table, PrimitiveId id, const Holder& holder,
                               std::size_t first) {
    rounding_in_frames_.resize(emitters_.size());
    const std::uint32_t kind = table.kind(id);
    const Placement* own = nullptr;
    if (kind != kTriangleKind) {
        with_column(table.columns, kind, [&](const auto& column) {
            const std::uint32_t placement = column.placements[table.index(id)];
            if (placement != kNoPlacement) own = &table.placements[placement];
        });
    }
    for (std::size_t i = first; i < emitters_.size(); ++i) {
        const Box3 box = bounds_of(emitters_[i]).box;
        double& most = rounding_in_frames_[i];
        for (const Affine& frame : holder.frames) {
            most = std::max(most, rounding_within(frame, box));
        }
        if (own != nullptr) {
            most = std::max(
                most, rounding_within(holder.world_from_table() * own->outer_from_inner, box));
        }
    }
}

void EmitterList::expand_primitive(const PrimitiveTable& table, PrimitiveId id,
                                   const Holder& holder) {
    const RayMask seen_by = holder.seen_by & table.visible_to(id);
    const std::size_t first = emitters_.size();
    append_emitters_of_shape(table, id, holder.world_from_table(), emitters_);
    set_rounding(table, id, holder, first);
    MaterialId material{};
    bool of_vertices = false;
    if (table.kind(id) == kTriangleKind) {
        const PlacedMesh& placed = table.mesh_of(table.index(id));
        material = placed.material;
        of_vertices = !placed.mesh->vertex_materials.empty();
        if (of_vertices) {
            material = MaterialId{
                placed.mesh->vertex_materials[(*table.triangle_corners(table.index(id)))[0]]};
        }
    } else {
        material = table.shape_material(id);
    }
    const Material& m = scene_.materials[static_cast<std::size_t>(material)];
    varying_.resize(emitters_.size(), of_vertices || varies(m));
    for (std::size_t i = first; i < emitters_.size(); ++i) {
        emitters_[i].two_sided = m.double_sided;
        emitters_[i].unseen = (seen_by & kConnectingRays) == 0;
        emitters_[i].radiance = m.emission.color;
        emitters_[i].illuminant = m.illuminant;
    }
}

void EmitterList::Table::set_blocks() {
    if (primitives.empty()) return;
    of_block.reserve(primitives.back() / kBlock + 2);
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
        while (of_block.size() <= primitives[i] / kBlock) of_block.push_back(i);
    }
    of_block.push_back(static_cast<std::uint32_t>(primitives.size()));
}

std::optional<std::size_t> EmitterList::Table::index_of(PrimitiveId id) const {
    const auto wanted = static_cast<std::uint32_t>(id);
    const std::size_t block = wanted / kBlock;
    if (block + 1 >= of_block.size()) return std::nullopt;
    const std::uint32_t first = of_block[block], last = of_block[block + 1];
    // Emitters of a mesh follow each other.
    if (last - first == kBlock) return first + wanted % kBlock;
    const auto begin = primitives.begin() + first, end = primitives.begin() + last;
    const auto found = std::lower_bound(begin, end, wanted);
    if (found == end || *found != wanted) return std::nullopt;
    return static_cast<std::size_t>(found - primitives.begin());
}

std::optional<std::size_t> EmitterList::find(const Hit& hit) const {
    if (emitters_.empty()) return std::nullopt;
    std::size_t number = 0;
    const Aggregate* aggregate = scene_.aggregate.get();
    for (std::size_t level = hit.path.size() + 1; level-- > 0;) {
        const auto known = tables_.find(aggregate);
        if (known == tables_.end()) return std::nullopt;
        const Table& counted = known->second;
        const PrimitiveId id = level == 0 ? hit.primitive : hit.path[level - 1];
        const std::optional<std::size_t> index = counted.index_of(id);
        if (!index) return std::nullopt;
        const std::size_t i = *index;
        number += counted.before[i];
        const PrimitiveTable& table = aggregate->primitives();
        if (level > 0) {
            aggregate = table.instances[table.index(id)].aggregate.get();
        } else if (counted.before[i + 1] - counted.before[i] > 1) {
            number += hit.part;
        }
    }
    // Emitters of many lights are not in the cache.
    if (number >= emitters_.size() || !has_area_[number]) return std::nullopt;
    return number;
}

std::optional<Hit> EmitterList::hit_of(std::size_t emitter, const Ray& ray, double distance,
                                       const Vec2& parameters) const {
    Hit hit;
    hit.t = distance;
    hit.u = parameters.x;
    hit.v = parameters.y;
    std::vector<PrimitiveId> path;
    Ray inner = ray;
    const Aggregate* aggregate = scene_.aggregate.get();
    std::uint32_t rest = static_cast<std::uint32_t>(emitter);
    std::optional<PrimitiveId> other_half;
    for (;;) {
        const Table& counted = tables_.at(aggregate);
        const auto after = std::upper_bound(counted.before.begin(), counted.before.end() - 1, rest);
        const std::size_t i = std::size_t(after - counted.before.begin()) - 1;
        rest -= counted.before[i];
        hit.primitive = PrimitiveId{counted.primitives[i]};
        const PrimitiveTable& table = aggregate->primitives();
        const std::uint32_t kind = table.kind(hit.primitive);
        if (kind != kInstanceKind) {
            if (i > 0 && counted.before[i - 1] == counted.before[i]) {
                other_half = PrimitiveId{counted.primitives[i - 1]};
            }
            break;
        }
        path.push_back(hit.primitive);
        const Instance& instance = table.instances[table.index(hit.primitive)];
        inner = inner_ray(instance, inner);
        aggregate = instance.aggregate.get();
    }
    for (std::size_t i = path.size(); i-- > 0;) hit.path.push_back(path[i]);
    hit.part = rest;
    const EmitterForm form = emitters_[emitter].form;
    if (form == EmitterForm::Triangle || form == EmitterForm::Patch) return hit;
    // Parameters of other forms are those of the crossing nearest to the point.
    ShapeHits crossings;
    const RayShear shear(inner.direction);
    aggregate->primitives().intersect(hit.primitive, inner, shear, crossings);
    if (crossings.empty() && other_half) {
        hit.primitive = *other_half;
        aggregate->primitives().intersect(hit.primitive, inner, shear, crossings);
    }
    if (crossings.empty()) return std::nullopt;
    double nearest = kInfinity;
    for (const ShapeHit& crossing : crossings) {
        const double away = std::abs(crossing.t - distance);
        if (!(away < nearest)) continue;
        nearest = away;
        static_cast<ShapeHit&>(hit) = crossing;
    }
    return hit;
}

Rgb EmitterList::radiance(std::size_t emitter, const Vec3& from, const Vec3& direction,
                          double distance, const Vec2& parameters) const {
    if (!varying_[emitter]) return emitters_[emitter].radiance;
    const Ray ray{from, direction};
    const std::optional<Hit> hit = hit_of(emitter, ray, distance, parameters);
    if (!hit) return emitters_[emitter].radiance;
    return emission_at(scene_, surface_at(*scene_.aggregate, ray, *hit));
}

EmitterList::Start EmitterList::start(std::size_t emitter, const EmitterPoint& p,
                                      const Vec3& direction) const {
    const Emitter& e = emitters_[emitter];
    const double away = std::sqrt(e.area);
    const Vec3 normal = dot(direction, p.normal) < 0.0 ? -p.normal : p.normal;
    const Ray ray{p.point + away * normal, -normal};
    const std::optional<Hit> hit = hit_of(emitter, ray, away, p.parameters);
    // By rounding the point may be beside the edge.
    if (!hit) return {leaving_ray(p, direction, rounding(emitter)), e.radiance};
    Surface surface;
    const bool varies = varying_[emitter];
    set_surface(*scene_.aggregate, ray, *hit,
                varies ? CoordinateNeed::all() : CoordinateNeed::none(), surface);
    return {leaving_ray(surface, direction), varies ? emission_at(scene_, surface) : e.radiance};
}

Rgb EmitterList::mean_radiance(std::size_t emitter) const {
    constexpr int kGrid = 4;
    Rgb sum;
    for (int i = 0; i < kGrid * kGrid; ++i) {
        const EmitterPoint p =
            point_of(emitters_[emitter], {(i % kGrid + 0.5) / kGrid, (i / kGrid + 0.5) / kGrid});
        if (!(p.density > 0.0)) continue;
        const double away = std::sqrt(1.0 / p.density);
        sum += radiance(emitter, p.point + away * p.normal, -p.normal, away, p.parameters);
    }
    return (1.0 / (kGrid * kGrid)) * sum;
}

}  // namespace alhazen
