#pragma once
/// Eight rays in lanes, for kernels that test several rays against one shape.
///
/// Conventions: bit i of a set of lanes stands for lane i. Lanes outside the queried sets may hold
/// any values.

#include <bit>
#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/ray.h"

namespace alhazen {

inline constexpr std::size_t kRayLanes = 8;
inline constexpr std::uint32_t kAllRayLanes = (1u << kRayLanes) - 1;

struct alignas(64) RayLanes {
    double origin[3][kRayLanes], direction[3][kRayLanes];  ///< [axis][lane]
    double t_min[kRayLanes], t_max[kRayLanes];

    void set(std::size_t lane, const Ray& ray) {
        for (int k = 0; k < 3; ++k) {
            origin[k][lane] = ray.origin[k];
            direction[k][lane] = ray.direction[k];
        }
        t_min[lane] = ray.t_min;
        t_max[lane] = ray.t_max;
    }
    [[nodiscard]] Ray ray(std::size_t lane) const {
        return {{origin[0][lane], origin[1][lane], origin[2][lane]},
                {direction[0][lane], direction[1][lane], direction[2][lane]},
                t_min[lane],
                t_max[lane]};
    }
};

/// Calls f(lane) for each lane of a set.
template <class F>
inline void for_each_lane(std::uint32_t set, F&& f) {
    for (; set != 0; set &= set - 1) f(static_cast<std::size_t>(std::countr_zero(set)));
}

}  // namespace alhazen
