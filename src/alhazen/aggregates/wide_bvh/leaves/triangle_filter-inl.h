/// The triangle filter on a block: see triangle_filter.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and is
/// never sure.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#endif

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "alhazen/accel/wide_bvh/trace/slab_ray-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/rays_at_blocks-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_crossing-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Precondition: `slabs` and `axes` are of the same ray.
HWY_INLINE void make_triangle_filter_ray(const SlabRay& slabs, const AxisLanes& axes,
                                         TriangleFilterRay& filter) {
    // The positions of the axes x, y, z for main axis 0, 1 and 2; the fourth is arbitrary.
    HWY_ALIGN static constexpr std::int32_t kTurned[3][4] = {
        {1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};
    const std::uint32_t kz = axes.main_axis;
    const float sz = slabs.reciprocal[kz];
    const auto turned = [&](const AxisLanes::F& a) HWY_ATTR { return permuted(a, kTurned[kz]); };
    // The fourth of each is set below. Addressed relative to the whole object, not to the member,
    // beyond whose end it lies: where lanes are stored one by one, compilers notice.
    static_assert(offsetof(TriangleFilterRay, sx) == offsetof(TriangleFilterRay, origin) + 16);
    static_assert(offsetof(TriangleFilterRay, sure_max) ==
                  offsetof(TriangleFilterRay, sure_min) + sizeof(float));
    float* const origin = reinterpret_cast<float*>(&filter);
    store_lanes(turned(axes.origin), origin);
    store_lanes(turned(axes.direction) * AxisLanes::F(sz), origin + 4);
    std::memcpy(&filter.kx, kTurned[kz], sizeof(kTurned[kz]));
    filter.sz = sz;
    constexpr float e = 0x1p-24f;
    const float error = 13.2f * e * axes.reach + 4.0f * axes.delta;
    filter.near_error = 2.2f * e * axes.reach + 4.0f * axes.delta;
    filter.edge_slack = 5.12f * error;
    filter.edge_slack_min = 2.12f * error * error;
    filter.s_slack = (14.2f * e * axes.reach + 4.0f * axes.delta) * std::abs(sz);
    store_lanes(axes.sure, origin + offsetof(TriangleFilterRay, sure_min) / sizeof(float));
    if (HWY_UNLIKELY(!axes.regular)) {
        filter.edge_slack = filter.near_error = std::numeric_limits<float>::infinity();
    }
}

/// The filter. False if no triangle is hit for all one knows; then what was found is not set. If
/// `kAtOnce`, no branch depends on what is computed. Two rays take the finer bound alone.
template <bool kAtOnce, template <class> class In>
HWY_INLINE bool filter_triangles(const In<TriangleBlock>& in) {
    using F = typename In<TriangleBlock>::F;
    const AxisRows<F> origin = origin_of(in), slope = slopes_of(in);
    ShearedCorners<F> corners;
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        const auto of_block = [i](const auto& block) HWY_ATTR -> const auto& {
            return block.vertex[i];
        };
        corners.set(i, axis_rows(in, of_block) - origin, slope.x, slope.y);
    }
    TriangleCrossing<F> crossing(corners);
    std::uint32_t candidates = all_lanes_of(in);
    if constexpr (std::is_same_v<F, Floats>) {
        candidates &= ~bits_of(crossing.missed_by_far(
            in.number([](const auto& at) HWY_ATTR { return at.ray.edge_slack; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.edge_slack_min; })));
        // Few blocks pass, whose triangles' distance tightens the bound.
        if (!kAtOnce && candidates == 0) return false;
    }
    crossing.bound(parameter_unit(in),
                   in.number([](const auto& at) HWY_ATTR { return at.ray.near_error; }));
    candidates &=
        ~bits_of(crossing.missed(in.number([](const auto& at) HWY_ATTR { return at.s_min; }),
                                 in.number([](const auto& at) HWY_ATTR { return at.s_max; })));
    if (!kAtOnce && candidates == 0) return false;
    const std::uint32_t sure =
        candidates &
        bits_of(crossing.sure(in.number([](const auto& at) HWY_ATTR { return at.ray.sure_min; }),
                              in.number([](const auto& at) HWY_ATTR { return at.ray.sure_max; })));
    in.set_candidates(candidates);
    in.set_lo(crossing.lo);
    in.set_sure(sure, crossing.hi);
    return true;
}

template <bool kAtOnce = false>
HWY_INLINE bool filter_triangles(const TriangleBlock& block, const TriangleFilterRay& ray,
                                 float s_min, float s_max, FilteredTriangles& out) {
    return filter_triangles<kAtOnce>(RayAtBlock<TriangleBlock>{block, ray, s_min, s_max, out});
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
