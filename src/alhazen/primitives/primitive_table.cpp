#include "alhazen/primitives/primitive_table.h"

#include <algorithm>
#include <limits>

#include "alhazen/base/error.h"
#include "alhazen/primitives/nearest_hit.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/polygons/polygon_cells.h"

namespace alhazen {

namespace {

/// The bounds of a placed box, with a margin for the rounding of transforming a ray into the inner
/// frame and back, which grows with the condition of the transform.
Box3 placed_box(const Placement& placement, const Box3& inner) {
    const Box3 box = transformed(placement.outer_from_inner, inner);
    if (!box.bounded()) return box;
    const Mat3& m = placement.outer_from_inner.linear;
    const Mat3& i = placement.inner_from_outer.linear;
    const auto times_abs = [](const Mat3& a, const Vec3& v) {
        return v.x * abs(a.x_axis) + v.y * abs(a.y_axis) + v.z * abs(a.z_axis);
    };
    const Vec3 reach{std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                     std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
                     std::max(std::abs(box.lo.z), std::abs(box.hi.z))};
    const Vec3 pad = 1e-15 * times_abs(m, times_abs(i, reach));
    return {box.lo - pad, box.hi + pad};
}

// ---- The bytes that a value keeps outside of itself, in arrays.

template <class T>
std::size_t bytes_outside(const T& value);

template <class T>
std::size_t bytes_outside(const std::vector<T>& values) {
    std::size_t sum = values.capacity() * sizeof(T);
    if constexpr (!std::is_trivially_copyable_v<T>) {
        for (const T& value : values) sum += bytes_outside(value);
    }
    return sum;
}

template <class T>
std::size_t bytes_outside(const T& value) {
    std::size_t sum = 0;
    if constexpr (requires { T::kFields; }) {
        for_each_field<T>([&](const auto& f) { sum += bytes_outside(value.*f.member); });
    }
    if constexpr (std::is_same_v<T, Polygon>) {
        if (value.cells) sum += value.cells->memory_bytes();
    }
    if constexpr (std::is_same_v<T, Polyhedron>) {
        sum += bytes_outside(value.faces) + bytes_outside(value.hull);
    }
    if constexpr (std::is_same_v<T, Profile>) {
        sum += bytes_outside(value.curves) + bytes_outside(value.loop_ends);
    }
    if constexpr (std::is_same_v<T, TrimCurve>) {
        sum +=
            bytes_outside(value.knots) + bytes_outside(value.points) + bytes_outside(value.weights);
    }
    return sum;
}

}  // namespace

PrimitiveTable::PrimitiveTable() = default;
PrimitiveTable::PrimitiveTable(const PrimitiveTable&) = default;
// Via a copy and a move: less code to compile than memberwise assignment of all columns.
PrimitiveTable& PrimitiveTable::operator=(const PrimitiveTable& other) {
    return *this = PrimitiveTable(other);
}
PrimitiveTable::PrimitiveTable(PrimitiveTable&&) noexcept = default;
PrimitiveTable& PrimitiveTable::operator=(PrimitiveTable&&) noexcept = default;
PrimitiveTable::~PrimitiveTable() = default;

void PrimitiveTable::finish() {
    std::uint64_t next = 0;
    std::uint32_t kind = 0;
    kinds_.clear();
    const auto begin_kind = [&](std::size_t count) {
        first_[kind++] = static_cast<std::uint32_t>(next);
        next += count;
        if (next >= static_cast<std::uint64_t>(kNoPrimitive)) {
            throw Error(ErrorKind::Resource, "more than 4294967294 primitives in one object");
        }
    };
    std::apply(
        [&](auto&... column) {
            const auto seal = [&](auto& c) {
                for (auto& shape : c.shapes) shape.prepare();
                kinds_.insert(kinds_.end(), c.shapes.size(), static_cast<std::uint8_t>(kind));
                begin_kind(c.shapes.size());
            };
            (seal(column), ...);
        },
        columns);
    std::uint64_t triangles = 0;
    mesh_starts_.clear();
    for (PlacedMesh& mesh : meshes) {
        mesh.first_triangle = static_cast<std::uint32_t>(triangles);
        mesh_starts_.push_back(mesh.first_triangle);
        triangles += mesh.mesh->triangles.size();
    }
    begin_kind(triangles);
    for (Instance& instance : instances) {
        instance.in_place = instance.placement.inner_from_outer == Affine{};
        instance.lane_solid = instance.aggregate->lane_solid();
    }
    begin_kind(instances.size());
    first_[kind] = static_cast<std::uint32_t>(next);
    collect_masks();
}

void PrimitiveTable::collect_masks() {
    masks_.clear();
    std::uint32_t next = 0;
    const auto add = [&](std::size_t count, RayMask visible_to) {
        if (count > 0 && (masks_.empty() || masks_.back().visible_to != visible_to)) {
            masks_.push_back({next, visible_to});
        }
        next += static_cast<std::uint32_t>(count);
    };
    const auto add_column = [&](const auto& column) {
        for (const RayMask mask : column.visible_to) add(1, mask);
        add(column.shapes.size() - column.visible_to.size(), kAllRays);
    };
    std::apply([&](const auto&... column) { (add_column(column), ...); }, columns);
    for (const PlacedMesh& mesh : meshes) add(mesh.mesh->triangles.size(), mesh.visible_to);
    for (const Instance& instance : instances) add(1, instance.visible_to);
    if (masks_.size() == 1 && masks_.front().visible_to == kAllRays) masks_.clear();
    common_mask_ = kAllRays;
    for (const MaskRange& range : masks_) common_mask_ &= range.visible_to;
}

RayMask PrimitiveTable::visible_to(PrimitiveId id) const {
    if (masks_.empty()) return kAllRays;
    const auto after =
        std::upper_bound(masks_.begin(), masks_.end(), static_cast<std::uint32_t>(id),
                         [](std::uint32_t i, const MaskRange& range) { return i < range.first; });
    return (after - 1)->visible_to;
}

const PlacedMesh& PrimitiveTable::mesh_of(std::uint32_t triangle) const {
    if (meshes.size() == 1) return meshes.front();
    // A binary search without a branch that depends on the triangle.
    const std::uint32_t* found = mesh_starts_.data();
    for (std::size_t left = mesh_starts_.size(); left > 1;) {
        const std::size_t half = left / 2;
        found += found[half] <= triangle ? half : 0;
        left -= half;
    }
    return meshes[static_cast<std::size_t>(found - mesh_starts_.data())];
}

std::array<Vec3, 3> PrimitiveTable::triangle_vertices(std::uint32_t triangle) const {
    const PlacedMesh& placed = mesh_of(triangle);
    const auto& corners = placed.mesh->triangles[triangle - placed.first_triangle];
    const auto& p = placed.mesh->positions;
    return {p[corners[0]], p[corners[1]], p[corners[2]]};
}

const std::array<std::uint32_t, 3>* PrimitiveTable::triangle_corners(std::uint32_t triangle) const {
    const PlacedMesh& placed = mesh_of(triangle);
    return &placed.mesh->triangles[triangle - placed.first_triangle];
}

std::array<const Vec3*, 3> PrimitiveTable::corner_positions(std::uint32_t triangle) const {
    const PlacedMesh& placed = mesh_of(triangle);
    const auto& corners = placed.mesh->triangles[triangle - placed.first_triangle];
    const Vec3* p = placed.mesh->positions.data();
    return {p + corners[0], p + corners[1], p + corners[2]};
}

MaterialId PrimitiveTable::shape_material(PrimitiveId id) const {
    const std::uint32_t i = index(id);
    return with_column(columns, kind(id), [&](const auto& c) { return c.materials[i]; });
}

bool PrimitiveTable::is_opaque(PrimitiveId id) const {
    const std::uint32_t k = kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - first_[k];
    const auto opaque = [&](MaterialId m) {
        return material_opacity[static_cast<std::uint32_t>(m)] == Opacity::Opaque;
    };
    if (k == kInstanceKind) return false;
    if (k != kTriangleKind) {
        return with_column(columns, k, [&](const auto& c) { return opaque(c.materials[i]); });
    }
    const PlacedMesh& placed = mesh_of(i);
    const TriangleMesh& mesh = *placed.mesh;
    if (mesh.vertex_materials.empty()) return opaque(placed.material);
    const auto& corners = mesh.triangles[i - placed.first_triangle];
    return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
        return opaque(MaterialId{mesh.vertex_materials[v]});
    });
}

bool PrimitiveTable::is_opaque_from_front(PrimitiveId id) const {
    if (kind(id) != kTriangleKind) return false;
    const PlacedMesh& placed = mesh_of(index(id));
    return placed.mesh->vertex_materials.empty() &&
           material_opacity[static_cast<std::uint32_t>(placed.material)] ==
               Opacity::OpaqueFromFront;
}

PrimitiveTable::ShadowEffect PrimitiveTable::shadow_effect(PrimitiveId id, const Ray& ray) const {
    if (is_opaque(id)) return ShadowEffect::Blocks;
    if (!is_opaque_from_front(id)) return ShadowEffect::Tints;
    return leaves_through_front(id, ray) ? ShadowEffect::Blocks : ShadowEffect::None;
}

bool PrimitiveTable::leaves_through_front(PrimitiveId id, const Ray& ray) const {
    const std::uint32_t triangle = index(id);
    const auto [a, b, c] = triangle_vertices(triangle);
    const double side = dot(cross(b - a, c - a), ray.direction);
    return mesh_of(triangle).mirrored ? side < 0.0 : side > 0.0;
}

Box3 PrimitiveTable::box(std::size_t i) const {
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    const std::uint32_t k = kind(id);
    const std::uint32_t j = static_cast<std::uint32_t>(i) - first_[k];
    if (k == kInstanceKind) {
        return placed_box(instances[j].placement, instances[j].aggregate->box());
    }
    if (k == kTriangleKind) {
        const std::array<Vec3, 3> corners = triangle_vertices(j);
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
            return {};
        }
        Box3 box;
        for (const Vec3& p : corners) box.include(p);
        return padded(box);
    }
    return with_column(columns, k, [&](const auto& c) {
        const Box3 inner = c.shapes[j].box();
        const std::uint32_t placement = c.placements[j];
        return placement == kNoPlacement ? padded(inner) : placed_box(placements[placement], inner);
    });
}

Box3 PrimitiveTable::inner_box(PrimitiveId id) const {
    const std::uint32_t k = kind(id);
    const std::uint32_t j = static_cast<std::uint32_t>(id) - first_[k];
    if (k == kInstanceKind) return instances[j].aggregate->box();
    return with_column(columns, k, [&](const auto& c) { return c.shapes[j].box(); });
}

const Placement* PrimitiveTable::placement_of(PrimitiveId id) const {
    const std::uint32_t k = kind(id);
    const std::uint32_t j = static_cast<std::uint32_t>(id) - first_[k];
    if (k == kInstanceKind) return &instances[j].placement;
    if (k == kTriangleKind) return nullptr;
    return with_column(columns, k, [&](const auto& c) {
        return c.placements[j] == kNoPlacement ? nullptr : &placements[c.placements[j]];
    });
}

Interval PrimitiveTable::extent(std::size_t i, const Vec3& axis) const {
    const PrimitiveId id{static_cast<std::uint32_t>(i)};
    const std::uint32_t k = kind(id);
    const std::uint32_t j = static_cast<std::uint32_t>(i) - first_[k];
    if (k == kInstanceKind) return BoundsSource::extent(i, axis);
    if (k == kTriangleKind) {
        Interval range;
        for (const Vec3& p : triangle_vertices(j)) range.include(dot(axis, p));
        const double pad = 1e-15 * std::max(std::abs(range.lo), std::abs(range.hi));
        return {range.lo - pad, range.hi + pad};
    }
    return with_column(columns, k, [&](const auto& c) {
        const std::uint32_t p = c.placements[j];
        if (p == kNoPlacement) return c.shapes[j].extent(axis);
        // dot(axis, M x + t) = dot(M^T axis, x) + dot(axis, t)
        const Affine& m = placements[p].outer_from_inner;
        const Interval inner = c.shapes[j].extent(transpose_times(m.linear, axis));
        const double shift = dot(axis, m.translation);
        const double pad =
            1e-15 * (std::abs(shift) + std::max(std::abs(inner.lo), std::abs(inner.hi)));
        return Interval{inner.lo + shift - pad, inner.hi + shift + pad};
    });
}

void PrimitiveTable::intersect(PrimitiveId id, const Ray& ray, const RayShear& shear,
                               ShapeHits& hits) const {
    const std::uint32_t k = kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - first_[k];
    if (k == kTriangleKind) {
        const auto [a, b, c] = triangle_vertices(i);
        hits.grow(intersect_triangle(ray, shear, a, b, c, *hits.room(1)) ? 1 : 0);
        return;
    }
    with_column(columns, k, [&](const auto& c) {
        const std::uint32_t placement = c.placements[i];
        if (placement == kNoPlacement) return append_hits(c.shapes[i], ray, hits);
        append_hits(c.shapes[i], transformed(placements[placement].inner_from_outer, ray), hits);
    });
}

bool PrimitiveTable::inside_at_minus_infinity(PrimitiveId id, const Ray& ray) const {
    const std::uint32_t k = kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - first_[k];
    if (k >= kTriangleKind) return false;
    return with_column(columns, k, [&](const auto& c) {
        const std::uint32_t placement = c.placements[i];
        if (placement == kNoPlacement) {
            return alhazen::inside_at_minus_infinity(c.shapes[i], ray);
        }
        return alhazen::inside_at_minus_infinity(
            c.shapes[i], transformed(placements[placement].inner_from_outer, ray));
    });
}

namespace {

/// Sets `hit` to the first hit that PrimitiveTable::intersect appends.
bool first_hit_of(const PrimitiveTable& table, PrimitiveId id, const Ray& ray,
                  const RayShear& shear, ShapeHit& hit) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - table.first(kind);
    if (kind == kTriangleKind) {
        const auto [a, b, c] = table.triangle_vertices(i);
        return intersect_triangle(ray, shear, a, b, c, hit);
    }
    return with_column(table.columns, kind, [&](const auto& c) {
        const std::uint32_t placement = c.placements[i];
        if (placement == kNoPlacement) return find_first_hit(c.shapes[i], ray, hit);
        const Affine& inner_from_outer = table.placements[placement].inner_from_outer;
        return find_first_hit(c.shapes[i], transformed(inner_from_outer, ray), hit);
    });
}

}  // namespace

template <class Stats>
void PrimitiveTable::closest(PrimitiveId id, Ray& ray, const RayShear& shear, Hit& best,
                             Stats stats, RayMask mask) const {
    if (!is_seen(id, mask)) return;
    if (static_cast<std::uint32_t>(id) < first_[kInstanceKind]) {
        ShapeHit hit;
        stats.primitives(1);
        if (!first_hit_of(*this, id, ray, shear, hit)) return;
        stats.primitive_hits(1);
        offer_hit(hit, id, ray, best);
        return;
    }
    const Instance& instance = instances[static_cast<std::uint32_t>(id) - first_[kInstanceKind]];
    Hit inner;
    if (!instance.aggregate->closest(inner_ray(instance, ray), inner, {stats.sink(), mask})) return;
    if (wins(inner.t, id, best)) {
        best = inner;
        best.path.push_back(id);
        ray.t_max = inner.t;
    }
}

template <class Stats>
bool PrimitiveTable::occluded(PrimitiveId id, const Ray& ray, const RayShear& shear, Stats stats,
                              RayMask mask) const {
    if (!is_seen(id, mask)) return false;
    if (static_cast<std::uint32_t>(id) < first_[kInstanceKind]) {
        ShapeHit hit;
        stats.primitives(1);
        if (!first_hit_of(*this, id, ray, shear, hit)) return false;
        stats.primitive_hits(1);
        return true;
    }
    const Instance& instance = instances[static_cast<std::uint32_t>(id) - first_[kInstanceKind]];
    return instance.aggregate->occluded(inner_ray(instance, ray), {stats.sink(), mask});
}

template <class Stats>
void PrimitiveTable::all_hits(PrimitiveId id, const Ray& ray, const RayShear& shear,
                              std::vector<Hit>& hits, Stats stats, RayMask mask) const {
    if (!is_seen(id, mask)) return;
    if (static_cast<std::uint32_t>(id) < first_[kInstanceKind]) {
        ShapeHits crossings;
        intersect(id, ray, shear, crossings);
        stats.primitives(1);
        if (!crossings.empty()) stats.primitive_hits(1);
        for (const ShapeHit& crossing : crossings) {
            Hit& hit = hits.emplace_back();
            static_cast<ShapeHit&>(hit) = crossing;
            hit.primitive = id;
        }
        return;
    }
    const Instance& instance = instances[static_cast<std::uint32_t>(id) - first_[kInstanceKind]];
    const std::size_t before = hits.size();
    instance.aggregate->all_hits(inner_ray(instance, ray), hits, {stats.sink(), mask});
    for (std::size_t i = before; i < hits.size(); ++i) hits[i].path.push_back(id);
}

template <class Stats>
bool PrimitiveTable::shadowed(PrimitiveId id, const Ray& ray, const RayShear& shear,
                              std::vector<Hit>& crossings, Stats stats, RayMask mask) const {
    if (!is_seen(id, mask)) return false;
    if (static_cast<std::uint32_t>(id) < first_[kInstanceKind]) {
        const std::size_t before = crossings.size();
        all_hits(id, ray, shear, crossings, stats, mask);
        if (crossings.size() == before) return false;
        const ShadowEffect effect = shadow_effect(id, ray);
        if (effect == ShadowEffect::None) crossings.resize(before);
        return effect == ShadowEffect::Blocks;
    }
    const Instance& instance = instances[static_cast<std::uint32_t>(id) - first_[kInstanceKind]];
    const std::size_t before = crossings.size();
    if (instance.aggregate->shadowed(inner_ray(instance, ray), crossings, {stats.sink(), mask})) {
        return true;
    }
    for (std::size_t i = before; i < crossings.size(); ++i) crossings[i].path.push_back(id);
    return false;
}

template void PrimitiveTable::closest(PrimitiveId, Ray&, const RayShear&, Hit&, NoStats,
                                      RayMask) const;
template void PrimitiveTable::closest(PrimitiveId, Ray&, const RayShear&, Hit&, CountingStats,
                                      RayMask) const;
template bool PrimitiveTable::occluded(PrimitiveId, const Ray&, const RayShear&, NoStats,
                                       RayMask) const;
template bool PrimitiveTable::occluded(PrimitiveId, const Ray&, const RayShear&, CountingStats,
                                       RayMask) const;
template void PrimitiveTable::all_hits(PrimitiveId, const Ray&, const RayShear&, std::vector<Hit>&,
                                       NoStats, RayMask) const;
template void PrimitiveTable::all_hits(PrimitiveId, const Ray&, const RayShear&, std::vector<Hit>&,
                                       CountingStats, RayMask) const;
template bool PrimitiveTable::shadowed(PrimitiveId, const Ray&, const RayShear&, std::vector<Hit>&,
                                       NoStats, RayMask) const;
template bool PrimitiveTable::shadowed(PrimitiveId, const Ray&, const RayShear&, std::vector<Hit>&,
                                       CountingStats, RayMask) const;

std::size_t PrimitiveTable::memory_bytes() const {
    const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    std::size_t total = bytes(meshes) + bytes(kinds_) + bytes(mesh_starts_) + bytes(instances) +
                        bytes(placements) + bytes(material_opacity) +
                        masks_.capacity() * sizeof(MaskRange);
    std::apply(
        [&](const auto&... c) {
            ((total += bytes_outside(c.shapes) + bytes(c.placements) + bytes(c.materials) +
                       bytes(c.parts) + bytes(c.visible_to)),
             ...);
        },
        columns);
    for (const PlacedMesh& placed : meshes) {
        const TriangleMesh& mesh = *placed.mesh;
        total += bytes(mesh.positions) + bytes(mesh.triangles) + bytes(mesh.normals) +
                 bytes(mesh.uvs) + bytes(mesh.uvs2) + bytes(mesh.colors) + bytes(mesh.tangents) +
                 bytes(mesh.vertex_materials);
    }
    return total;
}

}  // namespace alhazen
