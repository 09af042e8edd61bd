#include "alhazen/primitives/surface_group.h"

#include <type_traits>

#include "alhazen/primitives/primitive_columns.h"

namespace alhazen {

namespace {

using Kind = SurfaceSource::Kind;

template <class S>
void set_shape(const S& shape, SurfaceSource& source) {
    source.shape = &shape;
    if constexpr (std::is_same_v<S, Sphere>) {
        source.kind = Kind::Sphere;
    } else if constexpr (requires { shape.frustum; }) {
        source.kind = Kind::Side;
        source.shape = &shape.frustum;
    } else if constexpr (HasLaneSurfaces<S>) {
        source.kind = Kind::OneShape;
        source.find = [](const void* s, std::uint32_t wanted, LaneSurfaces& lanes) {
            return lane_surfaces(*static_cast<const S*>(s), wanted, lanes);
        };
    }
}

/// Sets the source of a primitive that is no instance, in its own aggregate.
void set_own_source(const Aggregate& aggregate, PrimitiveId id, SurfaceSource& source) {
    const PrimitiveTable& table = aggregate.primitives();
    const std::uint32_t kind = table.kind(id);
    if (kind >= kTriangleKind || aggregate.changes_materials()) return;
    const std::uint32_t index = table.index(id);
    with_column(table.columns, kind, [&](const auto& column) {
        set_shape(column.shapes[index], source);
        if (column.placements[index] != kNoPlacement) {
            source.own = &table.placements[column.placements[index]];
        }
        source.material = column.materials[index];
    });
    if (aggregate.turns_normal(id)) source.turned = !source.turned;
}

}  // namespace

SurfaceSource surface_source(const Aggregate& aggregate, const Hit& hit) {
    SurfaceSource source;
    if (hit.path.empty()) {
        set_own_source(aggregate, hit.primitive, source);
        return source;
    }
    if (hit.path.size() > 1 || aggregate.changes_materials()) return source;
    const PrimitiveTable& table = aggregate.primitives();
    const Instance& instance = table.instances[table.index(hit.path[0])];
    if (instance.motion) return source;
    set_own_source(*instance.aggregate, hit.primitive, source);
    source.in_place = instance.in_place && instance.placement.outer_from_inner == Affine{};
    if (!source.in_place) source.instance = &instance.placement;
    if (aggregate.turns_normal(hit.path[0])) source.turned = !source.turned;
    return source;
}

void SurfaceGroup::set_placed(std::size_t lane, const SurfaceSource& source, const Ray& ray,
                              const ShapeHit& hit) {
    Ray inner = ray;
    if (source.instance != nullptr) inner = transformed(source.instance->inner_from_outer, inner);
    if (source.own != nullptr) inner = transformed(source.own->inner_from_outer, inner);
    surfaces_.set(lane, inner, hit);
}

std::uint32_t SurfaceGroup::find() {
    const std::uint32_t wanted = (1u << count_) - 1;
    if (count_ < kSurfaceLanes) {
        fill_lanes(surfaces_.origin, count_);
        fill_lanes(surfaces_.direction, count_);
        fill_lanes(surfaces_.t, count_);
        fill_lanes(surfaces_.v, count_);
    }
    std::uint32_t found = 0;
    switch (first_.kind) {
        case Kind::None:
            return 0;
        case Kind::Sphere:
            fill_lanes(spheres_.center, count_);
            fill_lanes(spheres_.radius, count_);
            found = sphere_surfaces(spheres_, wanted, surfaces_);
            break;
        case Kind::Side:
            fill_lanes(frusta_.center, count_);
            fill_lanes(frusta_.axis, count_);
            fill_lanes(frusta_.half_height, count_);
            fill_lanes(frusta_.middle_radius, count_);
            fill_lanes(frusta_.slope, count_);
            found = side_surfaces(frusta_, wanted, surfaces_);
            break;
        case Kind::OneShape:
            found = first_.find(first_.shape, wanted, surfaces_);
            break;
    }
    if (found == 0) return 0;
    if (first_.own != nullptr) carry_lanes_outward(*first_.own, count_, surfaces_);
    if (first_.instance != nullptr) carry_lanes_outward(*first_.instance, count_, surfaces_);
    if (first_.in_place) carry_lanes_in_place(count_, surfaces_);
    return found;
}

}  // namespace alhazen
