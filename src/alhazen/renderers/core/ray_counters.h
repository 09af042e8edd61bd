#pragma once
/// Counts of rays by kind.

#include <array>
#include <cstdint>

#include "alhazen/accel/core/traversal_stats.h"
#include "alhazen/geometry/ray_mask.h"

namespace alhazen {

/// `hit` counts rays that hit a surface; of shadow rays those with any surface before the light.
struct RayCount {
    std::uint64_t cast = 0, hit = 0;
};

struct RayCounters {
    std::array<RayCount, kRayKindCount> rays;
    std::uint64_t total_internal = 0;  ///< refractions that were total internal reflections
    std::uint64_t non_finite = 0;      ///< samples whose radiance was not finite
    std::uint64_t aov_rays = 0;        ///< eye rays cast again for AOVs; counted nowhere else
    TraversalStats tests;

    [[nodiscard]] RayCount& operator[](RayKind kind) {
        return rays[static_cast<std::size_t>(kind)];
    }
    [[nodiscard]] const RayCount& operator[](RayKind kind) const {
        return rays[static_cast<std::size_t>(kind)];
    }
    [[nodiscard]] std::uint64_t total_cast() const {
        std::uint64_t total = 0;
        for (const RayCount& count : rays) total += count.cast;
        return total;
    }
    RayCounters& operator+=(const RayCounters& other) {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            rays[i].cast += other.rays[i].cast;
            rays[i].hit += other.rays[i].hit;
        }
        total_internal += other.total_internal;
        non_finite += other.non_finite;
        aov_rays += other.aov_rays;
        tests += other.tests;
        return *this;
    }
};

}  // namespace alhazen
