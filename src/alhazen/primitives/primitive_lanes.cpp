#include "alhazen/primitives/primitive_lanes.h"

#include <array>
#include <bit>

#include "alhazen/primitives/lane_solid.h"
#include "alhazen/primitives/nearest_hit.h"
#include "alhazen/primitives/primitive_columns.h"
#include "alhazen/primitives/unused_shear.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/core/first_hits.h"
#include "alhazen/shapes/polygons/polygon_lanes.h"

namespace alhazen {

namespace {

template <class S>
std::uint32_t shape_hits(const S& shape, const RayLanes& rays, std::uint32_t wanted,
                         ShapeHit* hits) {
    if constexpr (requires { first_hits(shape, rays, wanted, hits); }) {
        return first_hits(shape, rays, wanted, hits);
    } else if constexpr (HasPacketTest<S>) {
        std::array<Ray, kRayLanes> own;
        std::array<const Ray*, kRayLanes> places;
        std::array<std::size_t, kRayLanes> lanes;
        std::array<ShapeHit, kRayLanes> found;
        std::size_t count = 0;
        for_each_lane(wanted, [&](std::size_t lane) {
            own[count] = rays.ray(lane);
            places[count] = &own[count];
            lanes[count++] = lane;
        });
        std::uint32_t hit = 0;
        const std::span<const Ray* const> used = std::span(places).first(count);
        for_each_lane(first_hits(shape, used, found.data()), [&](std::size_t i) {
            hits[lanes[i]] = found[i];
            hit |= 1u << lanes[i];
        });
        return hit;
    } else {
        std::uint32_t hit = 0;
        for_each_lane(wanted, [&](std::size_t lane) {
            if (find_first_hit(shape, rays.ray(lane), hits[lane])) hit |= 1u << lane;
        });
        return hit;
    }
}

RayLanes transformed(const Affine& to_from, const RayLanes& rays) {
    RayLanes inner;
    for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
        inner.set(lane, transformed(to_from, rays.ray(lane)));
    }
    return inner;
}

std::uint32_t closest_of_shape(const PrimitiveTable& table, PrimitiveId id, RayLanes& rays,
                               std::uint32_t wanted, std::span<Hit> best, RayQuery query) {
    const std::uint32_t kind = table.kind(id);
    const std::uint32_t i = static_cast<std::uint32_t>(id) - table.first(kind);
    std::array<ShapeHit, kRayLanes> hits;
    const std::uint32_t hit = with_column(table.columns, kind, [&](const auto& column) {
        const auto test = [&](const RayLanes& inner) {
            return shape_hits(column.shapes[i], inner, wanted, hits.data());
        };
        const std::uint32_t placement = column.placements[i];
        if (placement == kNoPlacement) return test(rays);
        return test(transformed(table.placements[placement].inner_from_outer, rays));
    });
    if (query.stats != nullptr) {
        query.stats->primitive_tests += static_cast<std::uint64_t>(std::popcount(wanted));
        query.stats->primitive_hits += static_cast<std::uint64_t>(std::popcount(hit));
    }
    std::uint32_t changed = 0;
    for_each_lane(hit, [&](std::size_t lane) {
        Ray shrinking;
        offer_hit(hits[lane], id, shrinking, best[lane]);
        if (best[lane].t == rays.t_max[lane]) return;
        rays.t_max[lane] = best[lane].t;
        changed |= 1u << lane;
    });
    return changed;
}

// A separate function, as the transformed rays need much stack.
[[gnu::noinline]] std::uint32_t closest_of_moved(const Instance& instance, const RayLanes& rays,
                                                 std::uint32_t wanted, LaneHits& hits,
                                                 RayQuery query) {
    return instance.lane_solid->closest_of_lanes(
        transformed(instance.placement.inner_from_outer, rays), wanted, hits, query);
}

std::uint32_t closest_of_instance(const Instance& instance, PrimitiveId id, RayLanes& rays,
                                  std::uint32_t wanted, std::span<Hit> best, RayQuery query) {
    LaneHits hits;
    const std::uint32_t hit = instance.in_place
                                  ? instance.lane_solid->closest_of_lanes(rays, wanted, hits, query)
                                  : closest_of_moved(instance, rays, wanted, hits, query);
    std::uint32_t changed = 0;
    for_each_lane(hit, [&](std::size_t lane) {
        Hit& b = best[lane];
        const double t = hits.t[lane];
        if (!wins(t, id, b)) return;
        static_cast<ShapeHit&>(b) = hits.hit(lane);
        b.primitive = hits.id(lane);
        b.path.clear();
        b.path.push_back(id);
        if (t == rays.t_max[lane]) return;
        rays.t_max[lane] = t;
        changed |= 1u << lane;
    });
    return changed;
}

}  // namespace

bool takes_lanes(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind == kTriangleKind) return false;
    if (kind == kInstanceKind) return table.instances[table.index(id)].lane_solid != nullptr;
    return with_column(table.columns, kind, [](const auto& column) {
        return HasPacketTest<typename ShapeOfColumn<decltype(column)>::Type>;
    });
}

std::uint32_t closest_of_lanes(const PrimitiveTable& table, PrimitiveId id, RayLanes& rays,
                               std::uint32_t wanted, std::span<Hit> best, RayQuery query) {
    if (wanted == 0 || !table.is_seen(id, query.mask)) return 0;
    const auto i = static_cast<std::uint32_t>(id);
    if (i < table.first(kTriangleKind)) {
        return closest_of_shape(table, id, rays, wanted, best, query);
    }
    const std::uint32_t first_instance = table.first(kInstanceKind);
    if (i >= first_instance && table.instances[i - first_instance].lane_solid != nullptr) {
        return closest_of_instance(table.instances[i - first_instance], id, rays, wanted, best,
                                   query);
    }
    std::uint32_t changed = 0;
    for_each_lane(wanted, [&](std::size_t lane) {
        Ray ray = rays.ray(lane);
        const RayShear shear(ray.direction);
        with_stats(query.stats, [&](auto policy) {
            table.closest(id, ray, shear, best[lane], policy, query.mask);
        });
        if (ray.t_max == rays.t_max[lane]) return;
        rays.t_max[lane] = ray.t_max;
        changed |= 1u << lane;
    });
    return changed;
}

}  // namespace alhazen
