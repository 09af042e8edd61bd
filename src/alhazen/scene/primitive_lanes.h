#pragma once
/// The test of eight rays that lie side by side with one primitive of a table.
///
/// Source: shapes/first_hits.h, csg_lanes.h, where the primitive has one of these. Differs: others
/// are tested ray by ray. Conventions: those of `PrimitiveTable::closest`, whose hits they are, bit
/// for bit. Threads: const functions may be called from many threads.

#include <hwy/cache_control.h>

#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/scene/lane_solid.h"
#include "alhazen/scene/primitive_table.h"

namespace alhazen {

/// Whether eight rays take less time than one after the other; never for triangles.
[[nodiscard]] bool takes_lanes(const PrimitiveTable& table, PrimitiveId id);

/// Fetches what the test of an instance reads, ahead of use.
inline void prefetch_lanes(const PrimitiveTable& table, PrimitiveId id) {
    const auto i = static_cast<std::uint32_t>(id);
    const std::uint32_t first_instance = table.first(kInstanceKind);
    if (i < first_instance) return;
    const LaneSolid* const solid = table.instances[i - first_instance].lane_solid;
    if (solid == nullptr) return;
    for (std::size_t at = 0; at < LaneSolid::kReadBytes; at += 64) {
        hwy::Prefetch(reinterpret_cast<const std::byte*>(solid) + at);
    }
}

/// Makes `best` [lane] the better of itself and the primitive's nearest hit, for the rays of
/// `wanted`, which are valid, and shrinks their t_max to it. Those whose t_max that changed. Other
/// lanes may hold anything.
std::uint32_t closest_of_lanes(const PrimitiveTable& table, PrimitiveId id, RayLanes& rays,
                               std::uint32_t wanted, std::span<Hit> best, RayQuery query);

}  // namespace alhazen
