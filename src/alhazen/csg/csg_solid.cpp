#include "alhazen/csg/csg_solid.h"

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "alhazen/base/error.h"
#include "alhazen/csg/crossing_memo.h"
#include "alhazen/csg/csg_aggregate.h"
#include "alhazen/math/unit_vector.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/unused_shear.h"

namespace alhazen {

namespace {

/// Share of the distance from the origin in the tolerance: coordinates are rounded relative to
/// their size.
constexpr double kOffsetShare = 0x1p-8;

/// Adds the materials of all surfaces.
void add_materials(const Aggregate& aggregate, std::set<MaterialId>& all) {
    const PrimitiveTable& table = aggregate.primitives();
    std::apply(
        [&](const auto&... column) {
            (all.insert(column.materials.begin(), column.materials.end()), ...);
        },
        table.columns);
    for (const PlacedMesh& placed : table.meshes) {
        all.insert(placed.material);
        for (const std::uint32_t m : placed.mesh->vertex_materials) all.insert(MaterialId{m});
    }
    for (const Instance& instance : table.instances) add_materials(*instance.aggregate, all);
}

/// The plane of a half space in the frame of the table; nothing for other primitives.
std::optional<OrientedPlane> half_space_of(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind >= kTriangleKind) return std::nullopt;
    return with_column(table.columns, kind, [&](const auto& column) {
        using Shape = typename ShapeOfColumn<decltype(column)>::Type;
        std::optional<OrientedPlane> plane;
        if constexpr (std::is_same_v<Shape, HalfSpace>) {
            const HalfSpace& shape =
                column.shapes[static_cast<std::uint32_t>(id) - table.first(kind)];
            plane = OrientedPlane{shape.point, shape.face.unit_normal};
            if (const Placement* placed = table.placement_of(id)) {
                plane->point = placed->outer_from_inner.point(plane->point);
                plane->normal = transpose_times(placed->inner_from_outer.linear, plane->normal);
            }
            plane->normal = unit_or(plane->normal, {0, 0, 1});
        }
        return plane;
    });
}

}  // namespace

CsgSolid::CsgSolid(PrimitiveTable table, CsgExpression expression)
    : table_(std::move(table)),
      expression_(std::move(expression)),
      number_(CrossingMemo::number_of_solid()) {
    if (expression_.leaves.size() > kMaxCsgLeaves) {
        throw Error(ErrorKind::Resource, "more than 1073741823 leaves in one solid");
    }
    std::vector<Box3> boxes;
    boxes.reserve(leaf_count());
    for (std::uint32_t i = 0; i < leaf_count(); ++i) boxes.push_back(leaf_box(i));
    std::vector<std::optional<OrientedPlane>> planes;
    planes.reserve(leaf_count());
    for (const PrimitiveId id : expression_.leaves) planes.push_back(half_space_of(table_, id));
    tree_ = CsgTree(expression_, boxes, planes);
    for (const Instance& instance : table_.instances) {
        solids_.push_back(dynamic_cast<const SolidAggregate*>(instance.aggregate.get()));
    }
    find_media();
    find_walls();
    find_remembered();
    unbounded_ = std::any_of(boxes.begin(), boxes.end(),
                             [](const Box3& box) { return !box.empty() && !box.bounded(); });
    Box3 finite;
    for (const Box3& bound : tree_.bounds()) {
        if (!bound.empty() && bound.bounded()) finite.include(bound);
    }
    if (finite.empty()) return;
    center_ = finite.center();
    half_ = 0.5 * max_component(finite.size());
    offset_ = kOffsetShare * max_component(abs(center_));
}

void CsgSolid::find_media() {
    const std::uint32_t first_instance = table_.first(kInstanceKind);
    bool any = false;
    for (std::uint32_t leaf = 0; leaf < leaf_count(); ++leaf) {
        const PrimitiveId id = expression_.leaves[leaf];
        MaterialId material{};
        const CsgSolid* inner = nullptr;
        if (static_cast<std::uint32_t>(id) < first_instance) {
            material = table_.shape_material(id);
        } else {
            const Instance& instance =
                table_.instances[static_cast<std::uint32_t>(id) - first_instance];
            if (const auto* solid = dynamic_cast<const CsgAggregate*>(instance.aggregate.get())) {
                inner = &solid->solid();
                if (inner->leaf_count() > 0) material = inner->material(0);
            } else {
                material = instance.aggregate->primitives().meshes.front().material;
            }
        }
        media_.push_back(inner != nullptr           ? inner->only_medium()
                         : is_transparent(material) ? static_cast<std::uint32_t>(material)
                                                    : kOpaque);
        materials_.push_back(material);
        if (tree_.leaves()[leaf].complement) continue;
        if (any && media_.back() != only_medium_) has_media_ = true;
        only_medium_ = has_media_ ? kMixture : media_.back();
        any = true;
    }
}

/// Marks the subtracted leaves whose surfaces bound the only medium of the solid without being of
/// its material.
void CsgSolid::find_walls() {
    cuts_.resize(leaf_count(), false);
    if (has_media_ || only_medium_ >= kMixture || !is_clear(MaterialId{only_medium_})) return;
    const std::uint32_t first_instance = table_.first(kInstanceKind);
    for (std::uint32_t leaf = 0; leaf < leaf_count(); ++leaf) {
        if (!tree_.leaves()[leaf].complement) continue;
        if (!expression_.shows_minuend.empty() && expression_.shows_minuend[leaf]) continue;
        const auto id = static_cast<std::uint32_t>(expression_.leaves[leaf]);
        std::set<MaterialId> materials;
        if (id < first_instance) {
            materials.insert(materials_[leaf]);
        } else {
            add_materials(*table_.instances[id - first_instance].aggregate, materials);
        }
        for (const MaterialId material : materials) {
            if (material == MaterialId{only_medium_} || !is_clear(material)) continue;
            cuts_[leaf] = true;
            wall_materials_.insert(material);
        }
    }
}

/// Marks the leaves that may have more than two crossings, if hits need their media.
void CsgSolid::find_remembered() {
    remembered_.resize(leaf_count(), false);
    if (!has_media_) return;
    for (std::uint32_t leaf = 0; leaf < leaf_count(); ++leaf) {
        const std::uint32_t kind = table_.kind(expression_.leaves[leaf]);
        if (kind >= kTriangleKind) continue;
        remembered_[leaf] = with_column(table_.columns, kind, [](const auto& column) {
            return ShapeOfColumn<decltype(column)>::Type::kMaxHits > 2;
        });
    }
}

void CsgSolid::intersect(std::uint32_t leaf, const Ray& line, ShapeHits& found) const {
    const PrimitiveId id = expression_.leaves[leaf];
    if (!remembered_[leaf]) return table_.intersect(id, line, kUnusedShear, found);
    const CrossingMemo::Key key(number_, leaf, line);
    CrossingMemo& memo = CrossingMemo::of_thread();
    if (const CrossingMemo::Found known = memo.find(key); known.known) {
        for (const ShapeHit& hit : known.hits) found.push_back(hit);
        return;
    }
    table_.intersect(id, line, kUnusedShear, found);
    memo.keep(key, {found.begin(), found.end()});
}

bool CsgSolid::cross(std::uint32_t leaf, const CsgRay& ray, std::vector<CsgCrossing>& crossings,
                     std::vector<Hit>& hits, TraversalStats* stats) const {
    const PrimitiveId id = expression_.leaves[leaf];
    if (!table_.is_seen(id, ray.mask)) return false;
    const std::uint32_t first_instance = table_.first(kInstanceKind);
    if (static_cast<std::uint32_t>(id) < first_instance) {
        ShapeHits found;
        intersect(leaf, ray.line, found);
        if (stats != nullptr) {
            ++stats->primitive_tests;
            stats->primitive_hits += !found.empty();
        }
        for (const ShapeHit& hit : found) {
            crossings.push_back({hit.t, hit.u, hit.v, hit.part, leaf});
        }
        return unbounded_ && table_.inside_at_minus_infinity(id, ray.line);
    }
    const std::uint32_t index = static_cast<std::uint32_t>(id) - first_instance;
    const Instance& instance = table_.instances[index];
    const Ray inner = inner_ray(instance, ray.line);
    const std::size_t before = hits.size();
    instance.aggregate->all_hits(inner, hits, {stats, ray.mask});
    for (std::size_t i = before; i < hits.size(); ++i) {
        hits[i].path.push_back(id);
        crossings.push_back({hits[i].t, 0, 0, static_cast<std::uint32_t>(i), leaf});
    }
    return solids_[index] != nullptr && solids_[index]->inside_at_minus_infinity(inner);
}

void CsgSolid::fill(const CsgCrossing& crossing, const std::vector<Hit>& hits, Hit& hit) const {
    const PrimitiveId id = expression_.leaves[crossing.leaf];
    if (static_cast<std::uint32_t>(id) >= table_.first(kInstanceKind)) {
        hit = hits[crossing.part];
        return;
    }
    static_cast<ShapeHit&>(hit) = {crossing.t, crossing.u, crossing.v, crossing.part};
    hit.primitive = id;
    hit.path.clear();
}

std::size_t CsgSolid::memory_bytes() const {
    std::size_t bytes = tree_.memory_bytes() + materials_.capacity() * sizeof(MaterialId) +
                        cuts_.capacity() / 8 + wall_materials_.size() * sizeof(MaterialId) +
                        media_.capacity() * sizeof(std::uint32_t) + remembered_.capacity() / 8 +
                        expression_.leaves.capacity() * sizeof(PrimitiveId) +
                        expression_.nodes.capacity() * sizeof(CsgExpression::Node) +
                        solids_.capacity() * sizeof(void*);
    for (const CsgExpression::Node& node : expression_.nodes) {
        bytes += node.operands.capacity() * sizeof(CsgOperand);
    }
    return bytes;
}

}  // namespace alhazen
