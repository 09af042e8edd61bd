#include <algorithm>
#include <cmath>

#include "alhazen/base/overloaded.h"
#include "alhazen/illumination/illumination_data.h"
#include "alhazen/math/constants.h"
#include "alhazen/shading/lights/ies_profile.h"
#include "alhazen/shading/lights/light_extent.h"

namespace alhazen {

namespace {

double mean_power(const Rgb& c) {
    return (c.r + c.g + c.b) / 3.0;
}

/// Cosine of the half angle of the cone into which a point or spot light emits; -1: all.
double cosine_of_cone(const Light& light) {
    const auto* spot = std::get_if<SpotLight>(&light);
    return spot != nullptr ? std::cos(spot->outer_angle) : -1.0;
}

Vec3 axis_of_cone(const Light& light) {
    const auto* spot = std::get_if<SpotLight>(&light);
    return spot != nullptr ? spot->direction : Vec3{0, 0, 1};
}

Vec3 position_of(const Light& light) {
    const auto* spot = std::get_if<SpotLight>(&light);
    return spot != nullptr ? spot->position : std::get<PointLight>(light).position;
}

/// The intensity of a point or spot light with inverse-square falloff. Of others that with a
/// quadratic term of 1 instead; `set_falloff` (light_starts.h) corrects the falloff.
Rgb intensity_towards(const Light& light, const Vec3& direction) {
    Light plain = light;
    const auto set = [](auto& l) {
        l.attenuation = {0, 0, l.attenuation.quadratic > 0.0 ? l.attenuation.quadratic : 1.0};
        l.range = kNoRange;
    };
    std::visit(
        Overloaded{[&](PointLight& l) { set(l); }, [&](SpotLight& l) { set(l); }, [](auto&) {}},
        plain);
    return kPi * sample(plain, position_of(light) + direction, false).intensity;
}

/// A ray along `direction` from a point of the disc in front of the sphere.
Ray ray_from_afar(const Vec3& center, double radius, const Vec3& direction, const Vec2& place) {
    const Vec2 p = on_unit_disc(place);
    const Vec3 a = perpendicular(direction), b = cross(direction, a);
    return {center + radius * (p.x * a + p.y * b - direction), direction};
}

/// The power of a point or spot light. Without a quadratic term: of the light with inverse-square
/// falloff that gives the same at the squared distance `squared`.
double power_of_point(const Light& light, double squared) {
    const double solid = 2.0 * kPi * (1.0 - cosine_of_cone(light));
    const auto power = [&](const Rgb& color, const Attenuation& falloff) {
        const double constant = falloff.constant > 0.0 ? falloff.constant : 1.0;
        const double scale = falloff.quadratic > 0.0 ? 1.0 / falloff.quadratic : squared / constant;
        return kPi * solid * scale * mean_power(color);
    };
    return std::visit(Overloaded{[&](const PointLight& l) {
                                     return power(mean_factor(l.profile) * l.color, l.attenuation);
                                 },
                                 [&](const SpotLight& l) {
                                     return power(largest_factor(l.profile) * l.color,
                                                  l.attenuation);
                                 },
                                 [](const auto&) { return 0.0; }},
                      light);
}

LightRay emit_from_point(const Light& light, double probability, const Vec2& direction,
                         const Wavelengths& waves) {
    LightRay out;
    const double cosine = cosine_of_cone(light);
    const Vec3 d = direction_in_cone(axis_of_cone(light), 1.0 - cosine, direction);
    out.ray = {position_of(light), d};
    out.normal = d;
    out.radiance = waves.emission(intensity_towards(light, d));
    out.place_density = probability;
    out.direction_density = 1.0 / (2.0 * kPi * (1.0 - cosine));
    out.singular_place = true;
    return out;
}

}  // namespace

void Illumination::Data::set_sources() {
    std::vector<double> powers;
    for (std::size_t i = 0; i < near_count(); ++i) {
        if (const Light* light = point_light(i)) {
            powers.push_back(power_of_point(*light, 1.0));
        } else {
            const Emitter& e = emitter(i);
            powers.push_back((e.two_sided ? 2.0 : 1.0) * kPi * e.area * mean_power(e.radiance));
        }
    }
    const double disc = kPi * radius * radius;
    for (const std::size_t i : parallel) {
        const auto* sun = std::get_if<DirectionalLight>(&scene->lights[i]);
        // A point light without falloff counts by its light at the radius of the scene.
        powers.push_back(sun != nullptr ? kPi * disc * mean_power(sun->color)
                                        : power_of_point(scene->lights[i], radius * radius));
    }
    if (environment) powers.push_back(4.0 * kPi * disc * mean_power(environment->mean()));
    sources = LightChooser(powers);
    for (std::size_t i = 0; i < parallel.size(); ++i) {
        if (light_at_point(near_count() + i) != nullptr) powers[near_count() + i] = 0.0;
    }
    if (environment) powers.pop_back();
    picked = LightChooser(powers);
}

LightRay Illumination::emit(double choice, const Vec2& place, const Vec2& direction,
                            const Wavelengths& waves) const {
    const Data& d = *data_;
    const ChosenLight chosen = d.sources.choose(choice);
    LightRay out;
    if (!(chosen.probability > 0.0)) return out;
    if (const Light* light = d.light_at_point(chosen.light)) {
        out = emit_from_point(*light, chosen.probability, direction, waves);
        out.place.source = chosen.light;
        return out;
    }
    out.place.source = chosen.light;
    if (chosen.light >= d.near_count()) {
        const std::size_t far_light = chosen.light - d.near_count();
        out.infinite = true;
        out.place_density = chosen.probability / (kPi * d.radius * d.radius);
        if (d.is_environment(far_light)) {
            const Vec3 from = d.environment->sample(direction);
            out.ray = ray_from_afar(d.center, d.radius, -from, place);
            const Environment::Sight sight = d.environment->sight(from);
            out.radiance = waves.emission(sight.radiance);
            out.direction_density = sight.density;
            out.is_hit = true;
        } else {
            const auto& sun = std::get<DirectionalLight>(d.scene->lights[d.parallel[far_light]]);
            out.ray = ray_from_afar(d.center, d.radius, -sun.to_light, place);
            out.radiance = waves.emission(kPi * sun.color);
            out.direction_density = 1.0;
        }
        out.normal = out.ray.direction;
        return out;
    }
    const Emitter& e = d.emitter(chosen.light);
    const EmitterPoint p = point_of(e, place);
    if (!(p.density > 0.0)) return out;
    out.place.parameters = p.parameters;
    Vec2 u = direction;
    const bool behind = e.two_sided && u.x < 0.5;
    if (e.two_sided) u.x = behind ? 2.0 * u.x : 2.0 * u.x - 1.0;
    out.normal = behind ? -p.normal : p.normal;
    const Vec2 q = on_unit_disc(u);
    const double cosine = std::sqrt(std::max(0.0, 1.0 - q.x * q.x - q.y * q.y));
    const Vec3 a = perpendicular(out.normal), b = cross(out.normal, a);
    const Vec3 along = normalize(q.x * a + q.y * b + cosine * out.normal);
    out.place_density = chosen.probability * p.density;
    out.is_hit = chosen.light < d.emitters.size();
    out.direction_density = cosine / (e.two_sided ? 2.0 * kPi : kPi);
    const EmitterList::Start start =
        out.is_hit ? d.emitters.start(chosen.light, p, along)
                   : EmitterList::Start{leaving_ray(p, along, rounding_within(bounds_of(e).box)),
                                        e.radiance};
    out.ray = start.ray;
    out.radiance = waves.emission(start.radiance, e.illuminant);
    return out;
}

Illumination::EmitDensity Illumination::emit_density(const Hit& hit, const Surface& surface,
                                                     const Vec3& direction) const {
    const std::optional<std::size_t> found = data_->emitters.find(hit);
    if (!found) return {};
    const Emitter& e = data_->emitters[*found];
    const double cosine = dot(surface.normal, direction);
    if (!e.two_sided && !(cosine > 0.0)) return {};
    return {data_->sources.probability(*found) * area_density(e, surface.normal, {hit.u, hit.v}),
            std::abs(cosine) / (e.two_sided ? 2.0 * kPi : kPi)};
}

Illumination::EmitDensity Illumination::environment_emit_density(const Vec3& direction,
                                                                 const Vec3& lit) const {
    if (!data_->environment || !data_->reaches(direction, lit)) return {};
    const double probability =
        data_->sources.probability(data_->near_count() + data_->parallel.size());
    return {probability / (kPi * data_->radius * data_->radius),
            data_->environment->density(-direction)};
}

Illumination::EmitDensity Illumination::emit_density(const LightPoint& from, const Vec3& direction,
                                                     const Vec3& lit) const {
    const Data& d = *data_;
    const double probability = d.sources.probability(from.source);
    if (const Light* light = d.light_at_point(from.source)) {
        return {probability, 1.0 / (2.0 * kPi * (1.0 - cosine_of_cone(*light)))};
    }
    if (from.source >= d.near_count()) {
        if (d.is_environment(from.source - d.near_count())) {
            return environment_emit_density(direction, lit);
        }
        if (!d.reaches(direction, lit)) return {};
        return {probability / (kPi * d.radius * d.radius), 1.0};
    }
    const Emitter& e = d.emitter(from.source);
    const double cosine = dot(from.normal, direction);
    if (!e.two_sided && !(cosine > 0.0)) return {};
    return {probability * area_density(e, from.normal, from.parameters),
            std::abs(cosine) / (e.two_sided ? 2.0 * kPi : kPi)};
}

}  // namespace alhazen
