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

std::uint32_t spheres(const SphereLanes& spheres, std::uint32_t wanted, LaneSurfaces& lanes) {
    const Vectors center = load_vectors(spheres.center);
    Mask sure = lanes_of_bits<double>(kAllLanes);
    const Vectors normal = unit_of(hit_points(lanes) - center, sure);
    const Vectors point = center + load_lanes(spheres.radius) * normal;
    return finish(point, normal, sure, wanted, lanes);
}

std::uint32_t sides(const FrustumLanes& frusta, std::uint32_t wanted, LaneSurfaces& lanes) {
    const Vectors center = load_vectors(frusta.center), axis = load_vectors(frusta.axis);
    const Doubles half_height = load_lanes(frusta.half_height), slope = load_lanes(frusta.slope),
                  middle_radius = load_lanes(frusta.middle_radius);
    Mask sure = lanes_of_bits<double>(kAllLanes);
    const Vectors from_center = hit_points(lanes) - center;
    const Doubles along = dot(axis, from_center);
    const Vectors across = from_center - along * axis, outward = unit_of(across, sure);
    const Doubles distance = sqrt(dot(across, across)) - (middle_radius + slope * along);
    const Doubles foot = along + slope * distance / (Doubles(1.0) + slope * slope);
    const Doubles height = select_lanes(foot < -half_height, -half_height,
                                        select_lanes(half_height < foot, half_height, foot));
    const Doubles radius = middle_radius + slope * height;
    const Vectors point = center + height * axis + radius * outward;
    const Vectors normal = unit_of(outward - slope * axis, sure);
    return finish(point, normal, sure, wanted, lanes);
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
