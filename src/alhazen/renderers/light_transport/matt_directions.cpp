#include "alhazen/renderers/light_transport/matt_directions.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/light_transport/matt_directions.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/angles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

void matt_directions_of_target(std::span<const Vec2> u, Vec3* directions) {
    static_assert(kMostMattDirections == kLaneCount);
    HWY_ALIGN double x[kLaneCount] = {}, y[kLaneCount] = {}, z[kLaneCount];
    for (std::size_t i = 0; i < u.size(); ++i) {
        x[i] = u[i].x;
        y[i] = u[i].y;
    }
    const Doubles share = load_lanes(x), radius = sqrt(share);
    const SineCosine angle = sine_cosine_after(load_lanes(y));
    store_lanes(radius * angle.cosine, x);
    store_lanes(radius * angle.sine, y);
    store_lanes(sqrt(Doubles(1.0) - share), z);
    for (std::size_t i = 0; i < u.size(); ++i) directions[i] = {x[i], y[i], z[i]};
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(matt_directions_of_target);

void set_matt_directions(std::span<const Vec2> u, Vec3* directions) {
    ALHAZEN_KERNEL(matt_directions_of_target)(u, directions);
}

}  // namespace alhazen
#endif
