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

template <std::size_t N>
HWY_INLINE void carry_from(const Placement* placement, std::size_t first, LaneSurfaces& lanes) {
    VectorLanes<N> normal = load_from<N>(lanes.normal, first);
    if (placement != nullptr) {
        const Affine& outer = placement->outer_from_inner;
        const VectorLanes<N> point = load_from<N>(lanes.point, first);
        store_from(times(outer.linear, point) + vectors_of<N>(outer.translation), lanes.point,
                   first);
        normal = transpose_times(placement->inner_from_outer.linear, normal);
    }
    store_from(normal / sqrt(dot(normal, normal)), lanes.normal, first);
}

void carry(const Placement* placement, std::size_t count, LaneSurfaces& lanes) {
    for_lane_blocks((1u << count) - 1, [&](auto n, std::size_t first, std::uint32_t set) HWY_ATTR {
        carry_from<n()>(placement, first, lanes);
        return set;
    });
}

}  // namespace carried_lanes

auto carry_of_target() -> void (*)(const Placement*, std::size_t, LaneSurfaces&) {
    return &carried_lanes::carry;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(carry_of_target);

void carry_lanes_outward(const Placement& placement, std::size_t count, LaneSurfaces& lanes) {
    ALHAZEN_KERNEL(carry_of_target)()(&placement, count, lanes);
}
void carry_lanes_in_place(std::size_t count, LaneSurfaces& lanes) {
    ALHAZEN_KERNEL(carry_of_target)()(nullptr, count, lanes);
}

}  // namespace alhazen
#endif
