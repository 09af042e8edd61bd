#pragma once
/// The interface of solids that test eight rays in lanes faster than one by one.
///
/// Conventions: integer members of hits are stored as doubles, as the lanes compute them; u and v
/// are 0, as for all shapes tested in lanes. Bit i of a set of rays represents lane i.
/// Threads: const functions may be called from many threads.

#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// The hits of eight rays.
struct alignas(64) LaneHits {
    double t[kRayLanes];
    double part[kRayLanes];       ///< ShapeHit::part
    double primitive[kRayLanes];  ///< id in the aggregate itself

    void set(std::size_t lane, const Hit& hit) {
        t[lane] = hit.t;
        part[lane] = hit.part;
        primitive[lane] = static_cast<double>(hit.primitive);
    }
    [[nodiscard]] ShapeHit hit(std::size_t lane) const {
        return {t[lane], 0, 0, static_cast<std::uint32_t>(part[lane])};
    }
    [[nodiscard]] PrimitiveId id(std::size_t lane) const {
        return PrimitiveId{static_cast<std::uint32_t>(primitive[lane])};
    }
};

class LaneSolid {
  public:
    virtual ~LaneSolid() = default;
    /// Finds the nearest hits of the rays in `wanted`, which must be valid; returns the rays with a
    /// hit. Other lanes may hold any values.
    virtual std::uint32_t closest_of_lanes(const RayLanes& rays, std::uint32_t wanted,
                                           LaneHits& hits, RayQuery query) const = 0;
};

}  // namespace alhazen
