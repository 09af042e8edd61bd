#pragma once
/// The test of eight rays that lie side by side with one primitive of a table.
///
/// Source: shapes/core/first_hits.h, csg_lanes.h, where the primitive has one of these. Differs:
/// others are tested ray by ray. Conventions: those of `PrimitiveTable::closest`, whose hits they
/// are, bit for bit. Threads: const functions may be called from many threads.

#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// Whether eight rays take less time than one after the other; never for triangles.
[[nodiscard]] bool takes_lanes(const PrimitiveTable& table, PrimitiveId id);

/// Makes `best` [lane] the better of itself and the primitive's nearest hit, for the rays of
/// `wanted`, which are valid, and shrinks their t_max to it. Those whose t_max that changed. Other
/// lanes may hold anything.
std::uint32_t closest_of_lanes(const PrimitiveTable& table, PrimitiveId id, RayLanes& rays,
                               std::uint32_t wanted, std::span<Hit> best, RayQuery query);

}  // namespace alhazen
