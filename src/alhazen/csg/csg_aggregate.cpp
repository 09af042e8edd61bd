#include "alhazen/csg/csg_aggregate.h"

#include "alhazen/math/constants.h"
#include "alhazen/primitives/primitive_columns.h"

#include <utility>

namespace alhazen {

namespace {

/// The innermost table of a hit's path.
const PrimitiveTable& table_of(const PrimitiveTable& outer, const Hit& hit) {
    const PrimitiveTable* table = &outer;
    for (std::size_t i = hit.path.size(); i-- > 0;) {
        table = &table->instances[table->index(hit.path[i])].aggregate->primitives();
    }
    return *table;
}

/// The number of the part that placed a primitive of a solid.
std::uint32_t part_of(const PrimitiveTable& table, PrimitiveId primitive) {
    const std::uint32_t kind = table.kind(primitive), index = table.index(primitive);
    if (kind == kInstanceKind) return table.instances[index].part;
    if (kind == kTriangleKind) return table.mesh_of(index).part;
    return with_column(table.columns, kind, [&](const auto& column) {
        return column.parts.empty() ? 0 : column.parts[index];
    });
}

/// True if a closed mesh is wound so that its normals point inward.
bool wound_inward(const Aggregate& meshes) {
    double volume = 0.0;
    for (const PlacedMesh& placed : meshes.primitives().meshes) {
        volume += signed_volume(*placed.mesh);
    }
    return volume < 0.0;
}

}  // namespace

CsgAggregate::CsgAggregate(PrimitiveTable table, CsgExpression expression,
                           const std::string& evaluator)
    : solid_(std::move(table), std::move(expression)),
      sphere_(find_sphere()),
      evaluator_(find_csg_evaluator(evaluator).make(solid_)),
      turned_(solid_.table().size(), false) {
    if (solid_.leaf_count() > 0) {
        number_ = part_of(primitives(), solid_.expression().leaves.front()) + std::uint64_t{1};
    }
    if (!solid_.expression().shows_minuend.empty()) {
        shows_minuend_.resize(solid_.table().size(), false);
        for (std::uint32_t i = 0; i < solid_.leaf_count(); ++i) {
            shows_minuend_[static_cast<std::size_t>(solid_.expression().leaves[i])] =
                solid_.expression().shows_minuend[i];
        }
    }
    const std::vector<CsgTree::Leaf>& leaves = solid_.tree().leaves();
    const std::uint32_t first_instance = primitives().first(kInstanceKind);
    for (std::uint32_t i = 0; i < solid_.leaf_count(); ++i) {
        const auto primitive = static_cast<std::uint32_t>(solid_.expression().leaves[i]);
        turned_[primitive] = leaves[i].complement;
        if (solid_.cuts_walls(i)) {
            cuts_.resize(solid_.table().size(), false);
            cuts_[primitive] = true;
        }
        if (primitive < first_instance) continue;
        const Instance& instance = primitives().instances[primitive - first_instance];
        if (instance.of_shared_mesh && wound_inward(*instance.aggregate)) {
            turned_[primitive] = !turned_[primitive];
        }
    }
}

Box3 CsgAggregate::box() const {
    // Crossings with leaves that coincide with the bound may lie slightly outside it.
    return padded(solid_.tree().box(), 1e-15);
}

/// The smallest known sphere: around the box, or of a leaf that contains the solid.
BoundingSphere CsgAggregate::find_sphere() const {
    BoundingSphere smallest = bounding_sphere(box());
    for (std::uint32_t i = 0; i < solid_.leaf_count(); ++i) {
        if (!solid_.tree().leaves()[i].holds) continue;
        const auto primitive = static_cast<std::size_t>(solid_.expression().leaves[i]);
        const BoundingSphere sphere = primitives().sphere(primitive);
        if (sphere.radius < smallest.radius) smallest = sphere;
    }
    // A transition lies at any of the crossings that count as one.
    smallest.radius += 4.0 * solid_.tolerance();
    return smallest;
}

std::size_t CsgAggregate::memory_bytes() const {
    return solid_.memory_bytes() + evaluator_->memory_bytes() + turned_.size() / 8;
}

bool CsgAggregate::closest(const Ray& ray, Hit& hit, RayQuery query) const {
    hit = Hit{};
    return is_valid(ray) && evaluator_->first(solid_.prepare(ray, query.mask), hit, query.stats);
}

bool CsgAggregate::occluded(const Ray& ray, RayQuery query) const {
    Hit hit;
    return is_valid(ray) && evaluator_->first(solid_.prepare(ray, query.mask), hit, query.stats);
}

void CsgAggregate::all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const {
    if (is_valid(ray)) evaluator_->all(solid_.prepare(ray, query.mask), hits, query.stats);
}

bool CsgAggregate::shadowed(const Ray& ray, std::vector<Hit>& crossings, RayQuery query) const {
    if (!is_valid(ray)) return false;
    const std::size_t before = crossings.size();
    const CsgRay prepared = solid_.prepare(ray, query.mask);
    bool leaves = evaluator_->all(prepared, crossings, query.stats);
    std::size_t kept = before;
    for (std::size_t i = before; i < crossings.size(); ++i, leaves = !leaves) {
        switch (opacity(prepared, crossings[i])) {
            case Opacity::Opaque:
                return true;
            case Opacity::OpaqueFromFront:
                // The front of a solid is its outside, regardless of the winding of its parts.
                if (leaves) return true;
                break;
            case Opacity::Transparent:
                if (kept != i) crossings[kept] = crossings[i];
                ++kept;
        }
    }
    crossings.resize(kept);
    return false;
}

bool CsgAggregate::inside_at_minus_infinity(const Ray& ray) const {
    if (box().bounded()) return false;
    std::vector<Hit> none;
    return evaluator_->all(solid_.prepare({ray.origin, ray.direction, -kInfinity, -kInfinity}),
                           none, nullptr);
}

CsgAggregate::Look CsgAggregate::look(const CsgRay& ray, double t, PrimitiveId primitive) const {
    Look look;
    const bool of_minuend =
        !shows_minuend_.empty() && shows_minuend_[static_cast<std::size_t>(primitive)];
    if (!solid_.has_media() && !of_minuend) return look;
    const CsgSides sides = evaluator_->sides(ray, t);
    const auto material_of = [&](std::uint32_t leaf) -> std::optional<MaterialId> {
        if (leaf == CsgTree::kNone) return std::nullopt;
        return solid_.material(leaf);
    };
    look.media = {solid_.has_media(), material_of(sides.before), material_of(sides.after), number_};
    const bool is_wall = look.media.before && look.media.after;
    if (of_minuend) {
        look.material = look.media.after ? look.media.after : look.media.before;
    } else if (is_wall && solid_.medium(sides.after) != CsgSolid::kMixture) {
        // The entered medium is visible, except when a ray leaves an opaque one.
        const bool opaque_before = solid_.medium(sides.before) == CsgSolid::kOpaque;
        look.material = opaque_before ? look.media.before : look.media.after;
    }
    return look;
}

Opacity CsgAggregate::opacity(const CsgRay& ray, const Hit& hit) const {
    const PrimitiveId own = hit.path.empty() ? hit.primitive : hit.path.back();
    if (const auto material = look(ray, hit.t, own).material) {
        return primitives().material_opacity[static_cast<std::size_t>(*material)];
    }
    return table_of(primitives(), hit).opacity(hit.primitive);
}

void CsgAggregate::set_volume(Surface& surface) const {
    const MaterialId volume{solid_.only_medium()};
    if (!solid_.is_clear(surface.materials[0])) return;
    // An instanced solid may have stated its own inside, which is outside of this one.
    surface.media = {};
    surface.volume.reset();
    if (surface.material_count > 1 || surface.materials[0] != volume) surface.volume = volume;
    surface.has_extras = true;
}

void CsgAggregate::complete(const Ray& ray, double t, PrimitiveId primitive,
                            Surface& surface) const {
    const Look seen = changes_materials() ? look(solid_.prepare(ray), t, primitive) : Look{};
    if (seen.media.known) {
        surface.media = seen.media;
        surface.volume.reset();
        surface.has_extras = true;
    }
    if (!cuts_.empty() && cuts_[static_cast<std::size_t>(primitive)]) set_volume(surface);
    if (seen.material) {
        surface.materials[0] = *seen.material;
        surface.material_count = 1;
        surface.weights = {1, 0, 0};
    }
    if (turns_normal(primitive)) {
        surface.normal = -surface.normal;
        surface.shading_normal = -surface.shading_normal;
    }
    // Rays that leave the surface start beyond all surfaces that coincide with it.
    const double error = 0x1p-4 * solid_.tolerance();
    surface.error += Vec3{error, error, error};
}

}  // namespace alhazen
