#include "alhazen/shading/lights/light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "alhazen/base/overloaded.h"
#include "alhazen/shading/lights/ies_profile.h"

namespace alhazen {

namespace {

/// Direction and distance to a position, and the attenuation over that distance.
struct Approach {
    Vec3 to_light;
    double distance;
    double attenuation;
};

Approach approach(const auto& light, const Vec3& point, bool clamp) {
    const Attenuation& a = light.attenuation;
    const Vec3 offset = light.position - point;
    const double d = length(offset);
    double factor = 1.0 / (a.constant + a.linear * d + a.quadratic * (d * d));
    // All three coefficients may be 0; clamping makes the quotient 1, as in the course.
    if (clamp && !(factor < 1.0)) factor = 1.0;
    if (light.range != kNoRange) {
        const double x = d / light.range;
        factor *= std::max(1.0 - (x * x) * (x * x), 0.0);
    }
    return {offset / d, d, factor};
}

/// The profile's factor, without a call for the many lights that have none.
double factor_of(const LightProfile& profile, const Vec3& from_light) {
    return profile.profile ? profile_factor(profile, from_light) : 1.0;
}

double spot_falloff(const SpotLight& light, const Vec3& to_light) {
    const double cosine = -dot(to_light, light.direction);
    if (cosine > light.sure.within) return 1.0;
    if (cosine < light.sure.beyond) return 0.0;
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (angle <= light.inner_angle) return 1.0;
    if (angle >= light.outer_angle) return 0.0;
    const double x = (light.outer_angle - angle) / (light.outer_angle - light.inner_angle);
    return x * x * (3.0 - 2.0 * x);
}

/// True if light of the inner side of a closed surface comes out through the rest of it: of an
/// unseen sphere of two sides. That of a seen one ends at its own surface.
bool shines_through(const AreaLight& light) {
    return light.two_sided && !light.seen && !light.is_part &&
           std::holds_alternative<SphereExtent>(light.extent);
}

/// True if the point is inside of a sphere or on it.
bool is_within(const SphereExtent& sphere, const Vec3& point) {
    return !(length_squared(sphere.center - point) > sphere.radius * sphere.radius);
}

}  // namespace

bool illuminates(const Light& light) {
    return place_of(light) != LightPlace::None;
}

LightPlace place_of(const Light& light) {
    return std::visit(Overloaded{[](const AmbientLight&) { return LightPlace::None; },
                                 [](const DirectionalLight&) { return LightPlace::Direction; },
                                 [](const PointLight&) { return LightPlace::Point; },
                                 [](const SpotLight&) { return LightPlace::Point; },
                                 [](const AreaLight&) { return LightPlace::Point; }},
                      light);
}

Light ready_to_sample(const Light& light) {
    Light result = light;
    std::visit(Overloaded{[](AmbientLight&) {},
                          [](DirectionalLight& l) { l.to_light = normalize(l.to_light); },
                          [](PointLight&) {},
                          [](SpotLight& l) {
                              constexpr double kMarginOfCosine = 1e-12;
                              l.direction = normalize(l.direction);
                              l.sure.within = std::cos(l.inner_angle) + kMarginOfCosine;
                              l.sure.beyond = std::cos(l.outer_angle) - kMarginOfCosine;
                          },
                          [](AreaLight& l) {
                              l.surface =
                                  std::make_shared<const LightSurface>(l.extent, l.two_sided);
                          }},
               result);
    return result;
}

LightSample sample(const Light& light, const Vec3& point, bool clamp_attenuation) {
    return std::visit(
        Overloaded{
            [](const AmbientLight&) { return LightSample{}; },
            [](const DirectionalLight& l) {
                return LightSample{l.to_light, std::numeric_limits<double>::infinity(), l.color,
                                   l.glints};
            },
            [&](const PointLight& l) {
                const Approach a = approach(l, point, clamp_attenuation);
                const double sent = a.attenuation * factor_of(l.profile, -a.to_light);
                return LightSample{a.to_light, a.distance, sent * l.color, l.glints};
            },
            [&](const SpotLight& l) {
                const Approach a = approach(l, point, clamp_attenuation);
                const double sent =
                    a.attenuation * spot_falloff(l, a.to_light) * factor_of(l.profile, -a.to_light);
                return LightSample{a.to_light, a.distance, sent * l.color};
            },
            [&](const AreaLight& l) {
                const Vec3 offset = l.surface->center() - point;
                const double d = length(offset);
                const double sides = shines_through(l) ? 2.0 : 1.0;
                const double solid = sides * l.surface->projected_area(offset / d) / (d * d);
                return LightSample{offset / d, d, (solid * std::numbers::inv_pi) * l.radiance};
            }},
        light);
}

LightSample sample_extent(const AreaLight& light, const Vec3& point, const Vec2& u) {
    if (shines_through(light) && !is_within(std::get<SphereExtent>(light.extent), point)) {
        // One of the two points in a direction of the cone, each with probability 1/2.
        const bool far_side = u.x < 0.5;
        const Vec2 rest{far_side ? 2.0 * u.x : 2.0 * u.x - 1.0, u.y};
        const ExtentSample near = light.surface->sample(point, rest);
        if (!(near.density > 0.0)) return {};
        const double sum = 2.0 * dot(light.surface->center() - point, near.to_light);
        return {near.to_light, far_side ? sum - near.distance : near.distance,
                (2.0 * std::numbers::inv_pi / near.density) * light.radiance};
    }
    const ExtentSample s = light.surface->sample(point, u);
    if (!(s.density > 0.0)) return {};
    return {s.to_light, s.distance, (std::numbers::inv_pi / s.density) * light.radiance};
}

Rgb ambient_of(const Light& light) {
    return std::visit([](const auto& l) { return l.ambient; }, light);
}

}  // namespace alhazen
