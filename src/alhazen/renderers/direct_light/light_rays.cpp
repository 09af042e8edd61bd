#include "alhazen/renderers/direct_light/light_rays.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "alhazen/primitives/surface.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/direct_light/light_rays.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/renderers/direct_light/light_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_rays {

static_assert(std::is_trivially_copyable_v<Ray> && offsetof(Ray, direction) == 24 &&
              offsetof(Ray, t_min) == 48 && offsetof(Ray, t_max) == 56);

#if HWY_CAP_GE512
inline constexpr std::size_t kAtOnce = 16;
#else
inline constexpr std::size_t kAtOnce = 8;
#endif
using Numbers = Lanes<double, kAtOnce>;
using Vectors = VectorLanes<kAtOnce>;
using Mask = LaneMask<double, kAtOnce>;

HWY_INLINE Vectors load(const double (&rows)[3][ShadedPoints::kMost], std::size_t first) {
    return {load_lanes<kAtOnce>(rows[0] + first), load_lanes<kAtOnce>(rows[1] + first),
            load_lanes<kAtOnce>(rows[2] + first)};
}
HWY_INLINE void store(const Vectors& v, std::size_t first, double (&rows)[3][LightRays::kMost]) {
    store_lanes(v.x, rows[0] + first);
    store_lanes(v.y, rows[1] + first);
    store_lanes(v.z, rows[2] + first);
}
HWY_INLINE Mask is_zero(const Numbers& a) {
    const Numbers nothing(0.0);
    return (a <= nothing) & (a >= nothing);
}

/// Appends the rays of the lanes in `set` to `result`.
HWY_INLINE std::size_t append(std::uint32_t set, std::size_t first, const Vectors& origin,
                              const Vectors& direction, const Numbers& t_min, const Numbers& t_max,
                              std::size_t count, LightRays& result) {
    const LaneTag<double, kAtOnce> d;
    constexpr std::size_t kLanes = hn::MaxLanes(LaneTag<double, kAtOnce>());
    for (std::size_t p = 0; p < kParts<double, kAtOnce>; ++p) {
        // The first four numbers of each ray, and the last four.
        HWY_ALIGN double halves[2][kLanes][4];
        hn::StoreInterleaved4(origin.x.part[p], origin.y.part[p], origin.z.part[p],
                              direction.x.part[p], d, halves[0][0]);
        hn::StoreInterleaved4(direction.y.part[p], direction.z.part[p], t_min.part[p],
                              t_max.part[p], d, halves[1][0]);
        std::uint32_t part = (set >> (p * kLanes)) & ((1u << kLanes) - 1);
        for (; part != 0; part &= part - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(part));
            auto* const ray = reinterpret_cast<std::byte*>(result.rays + count);
            std::memcpy(ray, halves[0][i], sizeof(halves[0][i]));
            std::memcpy(ray + sizeof(halves[0][i]), halves[1][i], sizeof(halves[1][i]));
            result.of[count++] = static_cast<std::uint16_t>(first + p * kLanes + i);
        }
    }
    return count;
}

/// The cosine on which the highlight depends, as in `reflected_fraction`.
HWY_INLINE Numbers highlight_cosine(const ShadingConventions& conventions, const Vectors& normal,
                                    const Vectors& view, const Vectors& to_light,
                                    const Numbers& cosine) {
    if (conventions.highlight == ShadingConventions::Highlight::BlinnPhong) {
        const Vectors sum = to_light + view;
        return dot(normal, sum / sqrt(dot(sum, sum)));
    }
    return dot((Numbers(2.0) * cosine) * normal - to_light, view);
}

std::size_t aim(const ShadingConventions& conventions, const Light& light, std::size_t wanted,
                const ShadedPoints& points, LightRays& result) {
    const Numbers nothing(0.0);
    const Numbers nearest(std::max(LeavingRays::kBeyondZero, conventions.min_distance));
    std::size_t count = 0;
    for (std::size_t first = 0; first < wanted; first += kAtOnce) {
        const std::size_t here = std::min(kAtOnce, wanted - first);
        const Vectors point = load(points.point, first), normal = load(points.normal, first);
        const light_lanes::Arriving<kAtOnce> a =
            light_lanes::arriving<kAtOnce>(light, conventions.clamp_attenuation, point, here);
        const Numbers cosine = dot(normal, a.to_light);
        const Mask dark = is_zero(a.intensity.x) & is_zero(a.intensity.y) & is_zero(a.intensity.z);
        const std::uint32_t set = bits_of((cosine > nothing) & !dark) & ((1u << here) - 1);
        if (set == 0) continue;

        const Vectors outward = load(points.outward, first);
        const Numbers margin = load_lanes<kAtOnce>(points.margin + first);
        const Mask leaves = dot(a.to_light, outward) >= nothing;
        const Vectors origin = point + select_lanes(leaves, margin, -margin) * outward;
        const Numbers t_min = select_lanes(a.distance < nearest, a.distance, nearest);
        count = append(set, first, origin, a.to_light, t_min, a.distance, count, result);

        const Vectors matt = cosine * load(points.diffuse, first);
        store({a.intensity.x * matt.x, a.intensity.y * matt.y, a.intensity.z * matt.z}, first,
              result.matt);
        const std::uint32_t shiny = std::uint32_t{points.shiny[first / ShadedPoints::kStep]} >>
                                    (first % ShadedPoints::kStep);
        if ((shiny & set) == 0) continue;
        store(a.intensity, first, result.intensity);
        store_lanes(cosine, result.cosine + first);
        store_lanes(
            highlight_cosine(conventions, normal, load(points.view, first), a.to_light, cosine),
            result.highlight + first);
    }
    return count;
}

}  // namespace light_rays

auto aim_of_target() -> decltype(&light_rays::aim) {
    return &light_rays::aim;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(aim_of_target);

std::size_t aim_at_light(const ShadingConventions& conventions, const Light& light,
                         std::size_t wanted, const ShadedPoints& points, LightRays& result) {
    return ALHAZEN_KERNEL(aim_of_target)()(conventions, light, wanted, points, result);
}

}  // namespace alhazen
#endif
