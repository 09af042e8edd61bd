#pragma once
/// Shadow rays from many points to one light, made in lanes.
///
/// Source: `sample` of a light, `onward_ray` and `reflected_fraction`, the same operations in the
/// same order.
/// Conventions: every target gives the bits of the scalar code.

#include <cstddef>
#include <cstdint>

#include "alhazen/geometry/ray.h"
#include "alhazen/shading/lights/light.h"
#include "alhazen/shading/shading_conventions.h"

namespace alhazen {

/// Points whose light is wanted, as columns.
struct alignas(64) ShadedPoints {
    static constexpr std::size_t kMost = 256;
    /// The number of points is rounded up to a multiple of this; those added are copies.
    static constexpr std::size_t kStep = 16;

    double point[3][kMost], normal[3][kMost];  ///< `normal`: the shading normal, to the viewer
    double view[3][kMost];                     ///< unit, towards the viewer
    double outward[3][kMost], margin[kMost];   ///< geometric normal and LeavingRays::margin
    double diffuse[3][kMost];
    std::uint16_t shiny[kMost / kStep];  ///< bit i of each: point i of the step has highlights
};

/// Shadow rays to a light, of the points that face it.
struct alignas(64) LightRays {
    static constexpr std::size_t kMost = ShadedPoints::kMost;

    Ray rays[kMost];
    std::uint16_t of[kMost];  ///< the point of each ray
    // ---- [point], of the points of rays
    double matt[3][kMost];  ///< the light reflected if it arrives, without highlights
    // ---- [point], of the points of rays that have highlights
    double intensity[3][kMost], cosine[kMost], highlight[kMost];
};

/// Sets `result` for the first `wanted` points; returns the number of rays. The points behind them,
/// up to a whole step, are read, too.
std::size_t aim_at_light(const ShadingConventions& conventions, const Light& light,
                         std::size_t wanted, const ShadedPoints& points, LightRays& result);

}  // namespace alhazen
