#include "alhazen/renderers/antialias/scene_objects.h"

#include <algorithm>
#include <cmath>

#include "alhazen/csg/solid_aggregate.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

constexpr std::uint64_t kCountless = std::uint64_t{1} << 62;

Box3 box_around(const Affine& to_from, const Box3& box) {
    if (box.empty() || !box.bounded()) return box.empty() ? box : kAllSpace;
    Box3 result;
    for (int i = 0; i < 8; ++i) result.include(to_from.point(box.corner(i)));
    return result;
}

/// Enlarges the extents of an object by those of a shape of the table.
void include_diagonals(const PrimitiveTable& table, std::uint32_t shape, const Affine& world,
                       SceneObject& object) {
    for (std::size_t k = 0; k < kDiagonals.size(); ++k) {
        const double shift = dot(kDiagonals[k], world.translation);
        const Interval inner = table.extent(shape, transpose_times(world.linear, kDiagonals[k]));
        const double pad =
            1e-15 * (std::abs(shift) + std::max(std::abs(inner.lo), std::abs(inner.hi)));
        object.diagonals[k].include(inner.lo + shift - pad);
        object.diagonals[k].include(inner.hi + shift + pad);
    }
}

std::uint32_t part_of_shape(const PrimitiveTable& table, PrimitiveId id) {
    return with_column(table.columns, table.kind(id), [&](const auto& column) -> std::uint32_t {
        return column.parts.empty() ? 0 : column.parts[table.index(id)];
    });
}

}  // namespace

struct SceneObjects::Layout {
    explicit Layout(const Aggregate& a) : aggregate(&a), shapes(a.primitives()) {}

    const Aggregate* aggregate;
    JoinedPolygons shapes;
    std::vector<const MeshPieces*> pieces;        ///< [mesh]
    std::vector<std::uint64_t> mesh_objects;      ///< [mesh] index of its first piece
    std::vector<const Layout*> inner;             ///< [instance] null: a single object
    std::vector<std::uint64_t> instance_objects;  ///< [instance] index of its first object
    int depth = 0;                                ///< levels of instances that are expanded
    std::uint64_t count = 0;                      ///< saturates

    [[nodiscard]] const PrimitiveTable& table() const { return aggregate->primitives(); }
};

/// A placed aggregate.
struct SceneObjects::Place {
    Affine world_from_inner{};
    const Instance* outermost = nullptr;
    bool of_shared_mesh = false;
    std::uint32_t part = 0;  ///< part of the enclosing instance
    bool is_seen = true;
};

SceneObjects::~SceneObjects() = default;

SceneObjects::SceneObjects(const Aggregate& root, std::uint64_t most) {
    if (dynamic_cast<const SolidAggregate*>(&root) != nullptr) {
        objects_.push_back({root.sphere(), root.box()});
        return;
    }
    root_ = layout_of(root, static_cast<int>(kMaxInstanceDepth));
    while (root_->count > most && root_->depth > 0) root_ = layout_of(root, root_->depth - 1);
    objects_.reserve(root_->count);
    add_objects(*root_, {});
    for (SceneObject& object : objects_) {
        if (!(object.sphere.radius < kInfinity)) continue;
        object.box.include(object.sphere.center);
        for (std::size_t k = 0; k < kDiagonals.size(); ++k) {
            object.diagonals[k].include(dot(kDiagonals[k], object.sphere.center));
        }
    }
}

const SceneObjects::Layout* SceneObjects::layout_of(const Aggregate& aggregate, int levels) {
    std::unique_ptr<Layout>& found = layouts_[{&aggregate, levels}];
    if (found) return found.get();
    found = std::make_unique<Layout>(aggregate);
    Layout& layout = *found;  // elements of the map are stable
    const PrimitiveTable& table = aggregate.primitives();
    layout.count = layout.shapes.objects;
    for (const PlacedMesh& mesh : table.meshes) {
        layout.mesh_objects.push_back(layout.count);
        layout.pieces.push_back(&pieces_of(*mesh.mesh));
        layout.count += layout.pieces.back()->pieces.size();
    }
    for (const Instance& instance : table.instances) {
        const bool single =
            levels == 0 || dynamic_cast<const SolidAggregate*>(instance.aggregate.get()) != nullptr;
        layout.inner.push_back(single ? nullptr : layout_of(*instance.aggregate, levels - 1));
        layout.instance_objects.push_back(layout.count);
        if (!single) layout.depth = std::max(layout.depth, layout.inner.back()->depth + 1);
        layout.count =
            std::min(kCountless, layout.count + (single ? 1 : layout.inner.back()->count));
    }
    return &layout;
}

const MeshPieces& SceneObjects::pieces_of(const TriangleMesh& mesh) {
    std::unique_ptr<MeshPieces>& found = pieces_[&mesh];
    if (!found) found = std::make_unique<MeshPieces>(mesh);
    return *found;
}

void SceneObjects::add_objects(const Layout& layout, const Place& place) {
    add_shapes(layout, place);
    add_meshes(layout, place);
    const PrimitiveTable& table = layout.table();
    for (std::size_t i = 0; i < table.instances.size(); ++i) {
        const Instance& instance = table.instances[i];
        Place inside{place.world_from_inner * instance.placement.outer_from_inner,
                     place.outermost != nullptr ? place.outermost : &instance,
                     instance.of_shared_mesh, instance.part,
                     place.is_seen && (instance.visible_to & mask_of(RayKind::Eye)) != 0};
        if (layout.inner[i] != nullptr) {
            add_objects(*layout.inner[i], inside);
            continue;
        }
        const std::size_t id = table.first(kInstanceKind) + i;
        const BoundingSphere s = table.sphere(id);
        objects_.push_back({.sphere = {place.world_from_inner.point(s.center),
                                       stretch_bound(place.world_from_inner.linear) * s.radius},
                            .box = box_around(place.world_from_inner, table.box(id)),
                            .part = instance.part,
                            .instance = inside.outermost->part,
                            .is_seen = inside.is_seen});
    }
}

void SceneObjects::add_shapes(const Layout& layout, const Place& place) {
    const PrimitiveTable& table = layout.table();
    const double stretch = stretch_bound(place.world_from_inner.linear);
    const std::vector<std::uint32_t>& of_shape = layout.shapes.of_shape;
    const std::size_t first = objects_.size();
    for (std::uint32_t id = 0; id < table.first(kTriangleKind); ++id) {
        const std::size_t number = of_shape.empty() ? id : of_shape[id];
        const Box3 box = box_around(place.world_from_inner, table.box(id));
        if (first + number < objects_.size()) {
            // Another polygon of the object.
            SceneObject& joined = objects_[first + number];
            joined.box.include(box);
            include_diagonals(table, id, place.world_from_inner, joined);
            continue;
        }
        const PrimitiveId shape{id};
        const std::uint32_t part = part_of_shape(table, shape);
        SceneObject& object = objects_.emplace_back();
        object.part = part;
        object.instance = place.outermost != nullptr ? place.outermost->part : part;
        object.is_seen = place.is_seen && (table.visible_to(shape) & mask_of(RayKind::Eye)) != 0;
        object.box = box;
        object.sphere.radius = kInfinity;
        if (object.box.empty() || !object.box.bounded()) continue;
        const BoundingSphere sphere =
            of_shape.empty() ? table.sphere(id) : layout.shapes.spheres[number];
        object.sphere = {place.world_from_inner.point(sphere.center), stretch * sphere.radius};
        object.diagonals.fill({});
        include_diagonals(table, id, place.world_from_inner, object);
    }
}

void SceneObjects::add_meshes(const Layout& layout, const Place& place) {
    const double stretch = stretch_bound(place.world_from_inner.linear);
    for (std::size_t m = 0; m < layout.pieces.size(); ++m) {
        const PlacedMesh& mesh = layout.table().meshes[m];
        const std::uint32_t part = place.of_shared_mesh ? place.part : mesh.part;
        for (const MeshPieces::Piece& piece : layout.pieces[m]->pieces) {
            objects_.push_back(
                {.sphere = {place.world_from_inner.point(piece.sphere.center),
                            stretch * piece.sphere.radius},
                 .box = box_around(place.world_from_inner, piece.box),
                 .part = part,
                 .instance = place.outermost != nullptr ? place.outermost->part : part,
                 .is_seen = place.is_seen && (mesh.visible_to & mask_of(RayKind::Eye)) != 0});
        }
    }
}

std::uint32_t SceneObjects::number_of(const Hit& hit) const {
    const Layout* layout = root_;
    if (layout == nullptr) return 0;
    std::uint64_t first = 0;
    for (std::size_t i = hit.path.size(); i-- > 0;) {
        const std::uint32_t instance = layout->table().index(hit.path[i]);
        first += layout->instance_objects[instance];
        if (layout->inner[instance] == nullptr) return static_cast<std::uint32_t>(first);
        layout = layout->inner[instance];
    }
    const PrimitiveTable& table = layout->table();
    const std::uint32_t index = table.index(hit.primitive);
    if (table.kind(hit.primitive) != kTriangleKind) {
        const std::vector<std::uint32_t>& of_shape = layout->shapes.of_shape;
        const auto shape = static_cast<std::uint32_t>(hit.primitive);
        return static_cast<std::uint32_t>(first) + (of_shape.empty() ? shape : of_shape[shape]);
    }
    const PlacedMesh& mesh = table.mesh_of(index);
    const std::size_t m = static_cast<std::size_t>(&mesh - table.meshes.data());
    const std::uint32_t vertex = mesh.mesh->triangles[index - mesh.first_triangle][0];
    return static_cast<std::uint32_t>(first + layout->mesh_objects[m] +
                                      layout->pieces[m]->of_vertex[vertex]);
}

}  // namespace alhazen
