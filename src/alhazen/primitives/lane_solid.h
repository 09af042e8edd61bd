#pragma once
/// A solid that eight rays that lie side by side are tested with at once, faster than one after the
/// other.
///
/// Source: none. Differs: nothing. Conventions: numbers of the hits are doubles, for they are found
/// in lanes of these; u and v are 0, as of all shapes that are met so. Bit i of a set of rays
/// stands for lane i. Threads: const functions may be called from many threads.

#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray_lanes.h"
#include "alhazen/primitives/aggregate.h"

namespace alhazen {

/// What eight rays hit.
struct alignas(64) LaneHits {
    double t[kRayLanes];
    double part[kRayLanes];       ///< ShapeHit::part
    double primitive[kRayLanes];  ///< of the aggregate itself

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
    /// The nearest hits of the rays of `wanted`, which are valid: those that have one. Lanes of
    /// others may hold anything.
    virtual std::uint32_t closest_of_lanes(const RayLanes& rays, std::uint32_t wanted,
                                           LaneHits& hits, RayQuery query) const = 0;
};

}  // namespace alhazen
