#include "alhazen/shapes/core/lane_surfaces.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/core/lane_surfaces.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/shapes/core/lane_surface_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace carried_lanes {

using namespace lane_surface_formulas;

HWY_INLINE Vectors normalized(const Vectors& v) {
    return v / sqrt(dot(v, v));
}

void carry(const Placement* placement, LaneSurfaces& lanes) {
    const Vectors normal = load_vectors(lanes.normal);
    if (placement == nullptr) return store_vectors(normalized(normal), lanes.normal);
    const Affine &outer = placement->outer_from_inner, &inner = placement->inner_from_outer;
    store_vectors(normalized(transpose_times(inner.linear, normal)), lanes.normal);
    const Vectors point = load_vectors(lanes.point);
    store_vectors(times(outer.linear, point) + vectors_of(outer.translation), lanes.point);
}

}  // namespace carried_lanes

auto carry_of_target() -> void (*)(const Placement*, LaneSurfaces&) {
    return &carried_lanes::carry;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(carry_of_target);

void carry_lanes_outward(const Placement& placement, LaneSurfaces& lanes) {
    ALHAZEN_KERNEL(carry_of_target)()(&placement, lanes);
}
void carry_lanes_in_place(LaneSurfaces& lanes) {
    ALHAZEN_KERNEL(carry_of_target)()(nullptr, lanes);
}

}  // namespace alhazen
#endif
