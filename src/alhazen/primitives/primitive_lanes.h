#pragma once
/// Tests eight rays in lanes against one primitive of a table.
///
/// Source: shapes/core/first_hits.h, csg_lanes.h, for primitives with one of these tests.
/// Differs: other primitives are tested ray by ray.
/// Conventions: those of `PrimitiveTable::closest`; the hits are bit-identical to its hits.
/// Threads: const functions may be called from many threads.

#include <span>

#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// True if a test of eight rays is faster than single tests; always false for triangles.
[[nodiscard]] bool takes_lanes(const PrimitiveTable& table, PrimitiveId id);

/// Updates `best` [lane] to the primitive's nearest hit for the rays in `wanted`, which must be
/// valid, and shrinks their t_max to it. Returns the rays whose t_max changed. Other lanes may hold
/// any values.
std::uint32_t closest_of_lanes(const PrimitiveTable& table, PrimitiveId id, RayLanes& rays,
                               std::uint32_t wanted, std::span<Hit> best, RayQuery query);

}  // namespace alhazen
