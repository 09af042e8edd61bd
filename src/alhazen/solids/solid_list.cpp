#include "alhazen/solids/solid_list.h"

#include <algorithm>

#include "alhazen/base/error.h"

namespace alhazen {

namespace {

constexpr std::uint64_t kMostSolids = std::uint64_t{1} << 63;

/// Calls f(shape, index in its column, placement, material, part) for every shape of the table.
template <class F>
void for_each_shape(const PrimitiveTable& table, F&& f) {
    std::uint32_t kind = 0;
    const auto visit = [&](const auto& column) {
        const std::uint32_t first = table.first(kind++);
        for (std::uint32_t i = 0; i < column.shapes.size(); ++i) {
            f(column, i, PrimitiveId{first + i});
        }
    };
    std::apply([&](const auto&... column) { (visit(column), ...); }, table.columns);
}

/// Calls f(column, index) for one shape.
template <class F>
void with_column(const PrimitiveTable& table, PrimitiveId id, F&& f) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t index = table.index(id);
    std::uint32_t k = 0;
    const auto visit = [&](const auto& column) {
        if (k++ == kind) f(column, index);
    };
    std::apply([&](const auto&... column) { (visit(column), ...); }, table.columns);
}

template <class Column>
Ray inner_ray(const PrimitiveTable& table, const Column& column, std::uint32_t i, const Ray& ray) {
    const std::uint32_t placement = column.placements[i];
    return placement == kNoPlacement
               ? ray
               : transformed(table.placements[placement].inner_from_outer, ray);
}

template <class S>
bool begins_inside(const S& shape, const Ray& ray) {
    if constexpr (requires { shape.inside_at_minus_infinity(ray); }) {
        return shape.inside_at_minus_infinity(ray);
    } else {
        return false;
    }
}

/// The material of the first primitive in a table of leaves, nested tables included.
MaterialId first_material(const PrimitiveTable& table) {
    std::optional<MaterialId> first;
    for_each_shape(table, [&](const auto& column, std::uint32_t i, PrimitiveId) {
        if (!first) first = column.materials[i];
    });
    if (first) return *first;
    if (!table.meshes.empty()) return table.meshes.front().material;
    if (!table.instances.empty()) {
        return first_material(table.instances.front().aggregate->primitives());
    }
    return MaterialId{0};
}

}  // namespace

SolidList::SolidList(std::shared_ptr<const Aggregate> scene) : root_(build(scene)) {}

const SolidList::Node* SolidList::build(const std::shared_ptr<const Aggregate>& aggregate) {
    const auto known = nodes_.find(aggregate.get());
    if (known != nodes_.end()) return known->second.get();
    auto node = std::make_unique<Node>();
    node->aggregate = aggregate;
    node->csg = dynamic_cast<const SolidAggregate*>(aggregate.get());
    if (node->csg != nullptr) {
        node->count = 1;
        node->has_unbounded = true;
    } else {
        add_shapes(*node);
        add_meshes(*node);
        add_instances(*node);
    }
    return (nodes_[aggregate.get()] = std::move(node)).get();
}

void SolidList::add_shapes(Node& node) {
    const PrimitiveTable& table = node.aggregate->primitives();
    node.shape_number.assign(table.first(kTriangleKind), kOpen);
    for_each_shape(table, [&](const auto& column, std::uint32_t i, PrimitiveId id) {
        const auto& shape = column.shapes[i];
        if (!shape.closed()) {
            ++open_surfaces_;
            return;
        }
        node.shape_number[static_cast<std::uint32_t>(id)] =
            static_cast<std::uint32_t>(node.count++);
        node.solid_shapes.push_back(id);
        if constexpr (requires(const Ray& ray) { shape.inside_at_minus_infinity(ray); }) {
            node.unbounded.push_back(id);
            node.has_unbounded = true;
        }
    });
}

void SolidList::add_meshes(Node& node) {
    std::uint32_t index = 0;
    for (const PlacedMesh& placed : node.aggregate->primitives().meshes) {
        const auto [known, fresh] = closed_meshes_.try_emplace(placed.mesh.get(), false);
        if (fresh) {
            known->second = placed.mesh->closed();
            if (!known->second) open_meshes_.push_back({placed.mesh.get(), placed.part});
        }
        const bool closed = known->second;
        node.mesh_number.push_back(closed ? static_cast<std::uint32_t>(node.count++) : kOpen);
        if (closed) node.solid_meshes.push_back(index);
        open_surfaces_ += closed ? 0 : 1;
        ++index;
    }
}

void SolidList::add_instances(Node& node) {
    for (const Instance& instance : node.aggregate->primitives().instances) {
        const std::size_t open_before = open_meshes_.size();
        const Node* inner = build(instance.aggregate);
        if (instance.of_shared_mesh && open_meshes_.size() > open_before) {
            open_meshes_.back().part = instance.part;
        }
        node.instance_number.push_back(node.count);
        node.instances.push_back(inner);
        node.has_unbounded = node.has_unbounded || inner->has_unbounded;
        if (inner->count > kMostSolids - node.count) {
            throw Error(ErrorKind::Resource, "more than 2^63 solids in the scene");
        }
        node.count += inner->count;
    }
}

std::optional<SolidId> SolidList::solid_of(const Hit& hit) const {
    const Node* node = root_;
    std::uint64_t number = 0;
    for (std::size_t level = hit.path.size(); level-- > 0;) {
        if (node->csg != nullptr) return SolidId{number};
        const PrimitiveTable& table = node->aggregate->primitives();
        const std::uint32_t i =
            static_cast<std::uint32_t>(hit.path[level]) - table.first(kInstanceKind);
        number += node->instance_number[i];
        node = node->instances[i];
    }
    if (node->csg != nullptr) return SolidId{number};
    const PrimitiveTable& table = node->aggregate->primitives();
    const std::uint32_t id = static_cast<std::uint32_t>(hit.primitive);
    std::uint32_t own = kOpen;
    if (id < table.first(kTriangleKind)) {
        own = node->shape_number[id];
    } else {
        const PlacedMesh& mesh = table.mesh_of(id - table.first(kTriangleKind));
        own = node->mesh_number[static_cast<std::size_t>(&mesh - table.meshes.data())];
    }
    if (own == kOpen) return std::nullopt;
    return SolidId{number + own};
}

SolidPlace SolidList::place(SolidId id) const {
    SolidPlace place;
    const Node* node = root_;
    std::uint64_t number = static_cast<std::uint64_t>(id);
    bool of_shared_mesh = false;
    // A part that moves may take two levels.
    const auto add_part = [&](std::uint32_t part) {
        if (place.parts.empty() || place.parts.back() != part) place.parts.push_back(part);
    };
    // Finds the last instance whose solids begin at or before the number. Instances without solids
    // are skipped, because the next one begins at the same number.
    while (node->csg == nullptr && !node->instances.empty() &&
           number >= node->instance_number.front()) {
        const auto after =
            std::upper_bound(node->instance_number.begin(), node->instance_number.end(), number);
        const auto i = static_cast<std::size_t>(after - node->instance_number.begin()) - 1;
        const Instance& instance = node->aggregate->primitives().instances[i];
        number -= node->instance_number[i];
        of_shared_mesh = instance.of_shared_mesh;
        // What rests beside moving parts has no part of its own.
        if (!instance.holds_rest) add_part(instance.part);
        place.world = {place.world.outer_from_inner * instance.placement.outer_from_inner,
                       instance.placement.inner_from_outer * place.world.inner_from_outer};
        node = node->instances[i];
    }
    place.aggregate = node->aggregate;
    const PrimitiveTable& table = node->aggregate->primitives();
    if (node->csg != nullptr) {
        place.material = first_material(table);
    } else if (number < node->solid_shapes.size()) {
        place.kind = SolidPlace::Kind::Shape;
        place.shape = node->solid_shapes[number];
        with_column(table, place.shape, [&](const auto& column, std::uint32_t i) {
            place.material = column.materials[i];
            add_part(column.parts.empty() ? 0 : column.parts[i]);
        });
    } else {
        place.kind = SolidPlace::Kind::Mesh;
        place.mesh = node->solid_meshes[number - node->solid_shapes.size()];
        place.material = table.meshes[place.mesh].material;
        if (!of_shared_mesh) add_part(table.meshes[place.mesh].part);
    }
    return place;
}

void SolidList::inside_at_minus_infinity(const Ray& ray, std::vector<SolidId>& solids) const {
    collect_unbounded(*root_, ray, 0, solids);
}

void SolidList::collect_unbounded(const Node& node, const Ray& ray, std::uint64_t first,
                                  std::vector<SolidId>& solids) const {
    if (!node.has_unbounded) return;
    if (node.csg != nullptr) {
        if (node.csg->inside_at_minus_infinity(ray)) solids.push_back(SolidId{first});
        return;
    }
    const PrimitiveTable& table = node.aggregate->primitives();
    for (const PrimitiveId id : node.unbounded) {
        with_column(table, id, [&](const auto& column, std::uint32_t i) {
            if (begins_inside(column.shapes[i], inner_ray(table, column, i, ray))) {
                const std::uint32_t own = node.shape_number[static_cast<std::uint32_t>(id)];
                solids.push_back(SolidId{first + own});
            }
        });
    }
    for (std::size_t i = 0; i < node.instances.size(); ++i) {
        if (!node.instances[i]->has_unbounded) continue;
        const Instance& instance = table.instances[i];
        collect_unbounded(*node.instances[i], transformed(instance.placement.inner_from_outer, ray),
                          first + node.instance_number[i], solids);
    }
}

}  // namespace alhazen
