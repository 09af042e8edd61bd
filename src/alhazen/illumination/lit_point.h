#pragma once
/// A point at which light is gathered: on a surface, or inside a scattering volume.

#include <cstddef>
#include <cstdint>

#include "alhazen/math/vec.h"

namespace alhazen {

struct LitPoint {
    Vec3 point;
    Vec3 normal;              ///< unit, shading, on the side of the view
    bool both_sides = false;  ///< light from behind counts, too
    bool in_volume = false;   ///< light from all directions counts alike; no normal

    [[nodiscard]] static LitPoint inside_volume(const Vec3& point) {
        return {point, {}, true, true};
    }
};

/// Several of them in lanes.
template <std::size_t kLanes>
struct LitPoints {
    static constexpr std::size_t kMost = kLanes;

    void set(std::size_t lane, const LitPoint& at) {
        for (int k = 0; k < 3; ++k) {
            point[k][lane] = at.point[k];
            normal[k][lane] = at.normal[k];
        }
        const std::uint32_t bit = 1u << lane;
        both_sides = at.both_sides ? both_sides | bit : both_sides & ~bit;
        in_volume = at.in_volume ? in_volume | bit : in_volume & ~bit;
    }
    [[nodiscard]] Vec3 point_of(std::size_t lane) const {
        return {point[0][lane], point[1][lane], point[2][lane]};
    }
    [[nodiscard]] LitPoint operator[](std::size_t lane) const {
        return {point_of(lane),
                {normal[0][lane], normal[1][lane], normal[2][lane]},
                (both_sides >> lane & 1u) != 0,
                (in_volume >> lane & 1u) != 0};
    }

    alignas(64) double point[3][kMost] = {}, normal[3][kMost] = {};  ///< [axis][lane]
    std::uint32_t both_sides = 0, in_volume = 0;                     ///< bits of lanes
};
using LitPointLanes = LitPoints<16>;

}  // namespace alhazen
