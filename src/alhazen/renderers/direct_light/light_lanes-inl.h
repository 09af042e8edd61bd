/// The light that arrives at points in lanes, unhindered: `sample` of a light for N points, with
/// the same operations in the same order.
///
/// Differs: lights other than points and directions are sampled lane by lane.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_RENDERERS_LIGHT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_RENDERERS_LIGHT_LANES_INL_H_
#undef ALHAZEN_RENDERERS_LIGHT_LANES_INL_H_
#else
#define ALHAZEN_RENDERERS_LIGHT_LANES_INL_H_
#endif

#include <limits>

#include "alhazen/shading/lights/light.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace light_lanes {

/// LightSample in lanes.
template <std::size_t N>
struct Arriving {
    VectorLanes<N> to_light, intensity;
    Lanes<double, N> distance;
};

template <std::size_t N>
HWY_INLINE VectorLanes<N> vectors_of(const Vec3& v) {
    return {Lanes<double, N>(v.x), Lanes<double, N>(v.y), Lanes<double, N>(v.z)};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> vectors_of(const Rgb& c) {
    return {Lanes<double, N>(c.r), Lanes<double, N>(c.g), Lanes<double, N>(c.b)};
}

template <std::size_t N>
HWY_INLINE Arriving<N> arriving_from(const PointLight& light, bool clamp,
                                     const VectorLanes<N>& point) {
    using Numbers = Lanes<double, N>;
    const Attenuation& a = light.attenuation;
    const Numbers unit(1.0), nothing(0.0);
    const VectorLanes<N> offset = vectors_of<N>(light.position) - point;
    const Numbers d = sqrt(dot(offset, offset));
    Numbers factor =
        unit / (Numbers(a.constant) + Numbers(a.linear) * d + Numbers(a.quadratic) * (d * d));
    if (clamp) factor = select_lanes(factor < unit, factor, unit);
    if (light.range != kNoRange) {
        const Numbers x = d / Numbers(light.range);
        const Numbers left = unit - (x * x) * (x * x);
        factor = factor * select_lanes(left < nothing, nothing, left);
    }
    return {offset / d, factor * vectors_of<N>(light.color), d};
}

/// Any light, lane by lane; lanes from `count` on are as the first.
template <std::size_t N>
HWY_NOINLINE Arriving<N> arriving_alone(const Light& light, bool clamp, const VectorLanes<N>& point,
                                        std::size_t count) {
    alignas(64) double points[3][N], to_light[3][N], intensity[3][N], distance[N];
    store_vectors(point, points);
    for (std::size_t i = 0; i < N; ++i) {
        const std::size_t at = i < count ? i : 0;
        const LightSample s = sample(light, {points[0][at], points[1][at], points[2][at]}, clamp);
        for (int k = 0; k < 3; ++k) {
            to_light[k][i] = s.to_light[k];
            intensity[k][i] = s.intensity[k];
        }
        distance[i] = s.distance;
    }
    return {load_vectors<N>(to_light), load_vectors<N>(intensity), load_lanes<N>(distance)};
}

/// Of the first `count` lanes.
template <std::size_t N>
HWY_INLINE Arriving<N> arriving(const Light& light, bool clamp, const VectorLanes<N>& point,
                                std::size_t count) {
    const auto* at_point = std::get_if<PointLight>(&light);
    if (at_point != nullptr && !at_point->profile.profile) {
        return arriving_from<N>(*at_point, clamp, point);
    }
    if (const auto* far = std::get_if<DirectionalLight>(&light)) {
        return {vectors_of<N>(far->to_light), vectors_of<N>(far->color),
                Lanes<double, N>(std::numeric_limits<double>::infinity())};
    }
    return arriving_alone<N>(light, clamp, point, count);
}

}  // namespace light_lanes
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
