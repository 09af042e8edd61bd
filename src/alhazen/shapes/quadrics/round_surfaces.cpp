#include "alhazen/shapes/quadrics/round_surfaces.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/quadrics/round_surfaces.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/core/lane_surface_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace round_surfaces {

using namespace lane_surface_formulas;
template <std::size_t N>
using Mask = LaneMask<double, N>;

template <std::size_t N>
HWY_INLINE std::uint32_t spheres_of(const SphereLanes& spheres, std::uint32_t wanted,
                                    std::size_t first, LaneSurfaces& lanes) {
    const VectorLanes<N> center = load_from<N>(spheres.center, first);
    Mask<N> sure = lanes_of_bits<double, N>((1u << N) - 1);
    const VectorLanes<N> normal = unit_of(hit_points<N>(lanes, first) - center, sure);
    const VectorLanes<N> point = center + load_lanes<N>(spheres.radius + first) * normal;
    return finish(point, normal, sure, wanted, first, lanes);
}

template <std::size_t N>
HWY_INLINE std::uint32_t sides_of(const FrustumLanes& frusta, std::uint32_t wanted,
                                  std::size_t first, LaneSurfaces& lanes) {
    const VectorLanes<N> center = load_from<N>(frusta.center, first),
                         axis = load_from<N>(frusta.axis, first);
    const Numbers<N> half_height = load_lanes<N>(frusta.half_height + first),
                     slope = load_lanes<N>(frusta.slope + first),
                     middle_radius = load_lanes<N>(frusta.middle_radius + first);
    Mask<N> sure = lanes_of_bits<double, N>((1u << N) - 1);
    const VectorLanes<N> from_center = hit_points<N>(lanes, first) - center;
    const Numbers<N> along = dot(axis, from_center);
    const VectorLanes<N> across = from_center - along * axis, outward = unit_of(across, sure);
    const Numbers<N> distance = sqrt(dot(across, across)) - (middle_radius + slope * along);
    const Numbers<N> foot = along + slope * distance / (Numbers<N>(1.0) + slope * slope);
    const Numbers<N> height = select_lanes(foot < -half_height, -half_height,
                                           select_lanes(half_height < foot, half_height, foot));
    const Numbers<N> radius = middle_radius + slope * height;
    const VectorLanes<N> point = center + height * axis + radius * outward;
    const VectorLanes<N> normal = unit_of(outward - slope * axis, sure);
    return finish(point, normal, sure, wanted, first, lanes);
}

std::uint32_t spheres(const SphereLanes& spheres, std::uint32_t wanted, LaneSurfaces& lanes) {
    return for_lane_blocks(wanted, [&](auto n, std::size_t first, std::uint32_t set) HWY_ATTR {
        return spheres_of<n()>(spheres, set, first, lanes);
    });
}
std::uint32_t sides(const FrustumLanes& frusta, std::uint32_t wanted, LaneSurfaces& lanes) {
    return for_lane_blocks(wanted, [&](auto n, std::size_t first, std::uint32_t set) HWY_ATTR {
        return sides_of<n()>(frusta, set, first, lanes);
    });
}

}  // namespace round_surfaces

auto sphere_surfaces_of_target()
    -> std::uint32_t (*)(const SphereLanes&, std::uint32_t, LaneSurfaces&) {
    return &round_surfaces::spheres;
}
auto side_surfaces_of_target()
    -> std::uint32_t (*)(const FrustumLanes&, std::uint32_t, LaneSurfaces&) {
    return &round_surfaces::sides;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(sphere_surfaces_of_target);
ALHAZEN_KERNEL_TABLE(side_surfaces_of_target);

std::uint32_t sphere_surfaces(const SphereLanes& spheres, std::uint32_t wanted,
                              LaneSurfaces& lanes) {
    return ALHAZEN_KERNEL(sphere_surfaces_of_target)()(spheres, wanted, lanes);
}
std::uint32_t side_surfaces(const FrustumLanes& frusta, std::uint32_t wanted, LaneSurfaces& lanes) {
    return ALHAZEN_KERNEL(side_surfaces_of_target)()(frusta, wanted, lanes);
}

}  // namespace alhazen
#endif
