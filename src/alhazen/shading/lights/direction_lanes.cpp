#include "alhazen/shading/lights/direction_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shading/lights/direction_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/math/constants.h"
#include "alhazen/simd/angles-inl.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace direction_lanes {

template <std::size_t N>
HWY_INLINE void find_places(DirectionLanes& d) {
    using D = Lanes<double, N>;
    const D x = load_lanes<N>(d.x), y = load_lanes<N>(d.y);
    const D longitude = copysign(angle_from_axis(x, y), x);
    store_lanes(D(0.5) + longitude / D(2.0 * kPi), d.column);
    const D below = angle_from_axis(sqrt(x * x + y * y), load_lanes<N>(d.z));
    store_lanes(below / D(kPi), d.row);
}

template <std::size_t N>
HWY_INLINE void find_directions(DirectionLanes& d) {
    using D = Lanes<double, N>;
    const D z = load_lanes<N>(d.z), zero(0.0);
    const D rest = D(1.0) - z * z;
    const D across = sqrt(select_lanes(rest > zero, rest, zero));
    // Longitude 0 is in the middle of the picture.
    const SineCosine<N> from_edge = sine_cosine_after(load_lanes<N>(d.column));
    store_lanes(across * -from_edge.sine, d.x);
    store_lanes(across * -from_edge.cosine, d.y);
}

}  // namespace direction_lanes

void find_places_of_target(std::uint32_t used, DirectionLanes& lanes) {
    with_lane_count(used, [&](auto count) HWY_ATTR {
        direction_lanes::find_places<decltype(count)::value>(lanes);
    });
}
void find_directions_of_target(std::uint32_t used, DirectionLanes& lanes) {
    with_lane_count(used, [&](auto count) HWY_ATTR {
        direction_lanes::find_directions<decltype(count)::value>(lanes);
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(find_places_of_target);
ALHAZEN_KERNEL_TABLE(find_directions_of_target);

void DirectionLanes::find_places(std::size_t count) {
    ALHAZEN_KERNEL(find_places_of_target)((1u << count) - 1, *this);
}
void DirectionLanes::find_directions(std::size_t count) {
    ALHAZEN_KERNEL(find_directions_of_target)((1u << count) - 1, *this);
}

}  // namespace alhazen
#endif
