#pragma once
/// What eight rays that lie side by side hit in an aggregate.
///
/// Conventions: numbers are doubles, for they are found in lanes of these; u and v of the hits are
/// 0, as of all shapes that are met so.

#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray_lanes.h"

namespace alhazen {

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

}  // namespace alhazen
