#include "alhazen/shading/lights/direction_lanes.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shading/lights/direction_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/simd/lane_vectors-inl.h"
#include "alhazen/simd/trigonometry-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace direction_lanes {

template <std::size_t N>
HWY_INLINE void find_places(DirectionLanes& d) {
    using D = Lanes<double, N>;
    const D angle = atan2_of_lanes(load_lanes<N>(d.x), load_lanes<N>(d.y));
    store_lanes(D(0.5) + angle / D(2.0 * kPi), d.column);
    const D below = atan2_of_lanes(load_lanes<N>(d.across), load_lanes<N>(d.z));
    store_lanes(below / D(kPi), d.row);
}

template <std::size_t N>
HWY_INLINE void find_directions(DirectionLanes& d) {
    using D = Lanes<double, N>;
    const D longitude = load_lanes<N>(d.longitude), z = load_lanes<N>(d.z), zero(0.0);
    const D rest = D(1.0) - z * z;
    const D across = sqrt(select_lanes(rest > zero, rest, zero));
    const SineCosine angle = sine_cosine_of_lanes(abs(longitude));
    store_lanes(across * select_lanes(longitude < zero, -angle.sine, angle.sine), d.x);
    store_lanes(across * angle.cosine, d.y);
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
    // The library's function is not correctly rounded, and fast.
    for (std::size_t i = 0; i < count; ++i) across[i] = std::hypot(x[i], y[i]);
    ALHAZEN_KERNEL(find_places_of_target)((1u << count) - 1, *this);
}
void DirectionLanes::find_directions(std::size_t count) {
    ALHAZEN_KERNEL(find_directions_of_target)((1u << count) - 1, *this);
}

}  // namespace alhazen
#endif
