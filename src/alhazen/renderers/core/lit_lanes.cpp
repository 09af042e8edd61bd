#include "alhazen/renderers/core/lit_lanes.h"

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/renderers/core/lit_lanes.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace lit_lanes {

using Vectors = VectorLanes<kRayLanes>;
using Mask = LaneMask<double>;

HWY_INLINE Vectors vectors_of(const Vec3& v) {
    return {Doubles(v.x), Doubles(v.y), Doubles(v.z)};
}
HWY_INLINE Vectors vectors_of(const Rgb& c) {
    return {Doubles(c.r), Doubles(c.g), Doubles(c.b)};
}
HWY_INLINE Vectors products(const Vectors& a, const Vectors& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// LightSample in lanes.
struct Arriving {
    Vectors to_light, intensity;
};

HWY_INLINE Arriving arriving(const PointLight& light, bool clamp, const Vectors& point) {
    const Attenuation& a = light.attenuation;
    const Doubles unit(1.0), nothing(0.0);
    const Vectors offset = vectors_of(light.position) - point;
    const Doubles d = sqrt(dot(offset, offset));
    Doubles factor =
        unit / (Doubles(a.constant) + Doubles(a.linear) * d + Doubles(a.quadratic) * (d * d));
    if (clamp) factor = select_lanes(factor < unit, factor, unit);
    if (light.range != kNoRange) {
        const Doubles x = d / Doubles(light.range);
        const Doubles left = unit - (x * x) * (x * x);
        factor = factor * select_lanes(left < nothing, nothing, left);
    }
    return {offset / d, factor * vectors_of(light.color)};
}

/// Any light, lane by lane.
HWY_NOINLINE Arriving arriving_alone(const Light& light, bool clamp, std::size_t count,
                                     const LaneSurfaces& surfaces) {
    alignas(64) double to_light[3][kRayLanes], intensity[3][kRayLanes];
    for (std::size_t i = 0; i < kRayLanes; ++i) {
        const std::size_t from = i < count ? i : 0;
        const LightSample s = sample(
            light, {surfaces.point[0][from], surfaces.point[1][from], surfaces.point[2][from]},
            clamp);
        for (int k = 0; k < 3; ++k) {
            to_light[k][i] = s.to_light[k];
            intensity[k][i] = s.intensity[k];
        }
    }
    return {load_vectors(to_light), load_vectors(intensity)};
}

/// As `reflected_fraction`, with the matt fraction given, for the lanes in `set`.
HWY_NOINLINE Vectors with_highlights(const ShadingConventions& conventions, std::uint32_t set,
                                     const LitLanes& lanes, const Vectors& normal,
                                     const Vectors& to_light, const Doubles& cosine,
                                     const Vectors& matt) {
    const Vectors view = -load_vectors(lanes.direction);
    alignas(64) double fraction[3][kRayLanes], cosines[kRayLanes], highlights[kRayLanes];
    if (conventions.highlight == ShadingConventions::Highlight::BlinnPhong) {
        const Vectors sum = to_light + view;
        store_lanes(dot(normal, sum / sqrt(dot(sum, sum))), highlights);
    } else {
        const Vectors mirrored = (Doubles(2.0) * cosine) * normal - to_light;
        store_lanes(dot(mirrored, view), highlights);
    }
    store_vectors(matt, fraction);
    store_lanes(cosine, cosines);
    for_each_lane(set, [&](std::size_t i) {
        const Rgb whole =
            with_highlight(conventions, lanes.material[i]->sample, highlights[i], cosines[i],
                           {fraction[0][i], fraction[1][i], fraction[2][i]});
        for (int k = 0; k < 3; ++k) fraction[k][i] = whole[k];
    });
    return load_vectors(fraction);
}

void shade(const ShadingConventions& conventions, std::span<const Light* const> lights,
           std::size_t count, const LaneSurfaces& surfaces, LitLanes& lanes) {
    const bool clamp = conventions.clamp_attenuation;
    const Vectors point = load_vectors(surfaces.point);
    Vectors normal = load_lanes(lanes.side) * load_vectors(surfaces.normal);
    const Doubles along = dot(load_vectors(lanes.direction), normal);
    normal = select_lanes(along > Doubles(0.0), -normal, normal);
    Vectors sum = load_vectors(lanes.base);
    const Vectors diffuse = load_vectors(lanes.diffuse);
    for (const Light* light : lights) {
        Arriving a;
        const auto* at_point = std::get_if<PointLight>(light);
        if (at_point != nullptr && !at_point->profile.profile) {
            a = arriving(*at_point, clamp, point);
        } else if (const auto* far = std::get_if<DirectionalLight>(light)) {
            a = {vectors_of(far->to_light), vectors_of(far->color)};
        } else {
            a = arriving_alone(*light, clamp, count, surfaces);
        }
        const Doubles cosine = dot(normal, a.to_light);
        const Mask lit = cosine > Doubles(0.0);
        Vectors fraction = cosine * diffuse;
        if (lanes.shiny != 0) {
            const std::uint32_t set = lanes.shiny & bits_of(lit);
            if (set != 0) {
                fraction =
                    with_highlights(conventions, set, lanes, normal, a.to_light, cosine, fraction);
            }
        }
        sum = select_lanes(lit, sum + products(a.intensity, fraction), sum);
    }
    store_vectors(sum, lanes.radiance);
}

}  // namespace lit_lanes

auto shade_of_target() -> decltype(&lit_lanes::shade) {
    return &lit_lanes::shade;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(shade_of_target);

void shade_lanes(const ShadingConventions& conventions, std::span<const Light* const> lights,
                 std::size_t count, const LaneSurfaces& surfaces, LitLanes& lanes) {
    ALHAZEN_KERNEL(shade_of_target)()(conventions, lights, count, surfaces, lanes);
}

}  // namespace alhazen
#endif
