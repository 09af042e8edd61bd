#include <cmath>

#include "alhazen/illumination/illumination_data.h"
#include "alhazen/math/constants.h"

namespace alhazen {

namespace {

/// The unit outer normal of an emitter at one of its points.
Vec3 normal_at(const Emitter& e, const Vec3& point, const Vec2& parameters) {
    switch (e.form) {
        case EmitterForm::Sphere:
        case EmitterForm::Tube: {
            const Mat3 own_from_world = inverse(e.world_from_own.linear);
            Vec3 own = own_from_world * (point - e.world_from_own.translation);
            if (e.form == EmitterForm::Tube) own.z = 0.0;
            return normalize(transpose_times(own_from_world, own));
        }
        case EmitterForm::Patch:
            return point_of(e, parameters).normal;
        default:
            return e.world_from_own.linear.z_axis;
    }
}

}  // namespace

Illumination::LightPoint Illumination::point_of_light(const PlaceInLight& place,
                                                      const Vec3& point) const {
    const Data& d = *data_;
    LightPoint at{.source = place.source, .parameters = place.parameters};
    if (d.light_at_point(place.source) != nullptr) return at;
    if (place.source >= d.near_count()) {
        at.infinite = true;
        at.is_hit = d.is_environment(place.source - d.near_count());
    } else {
        at.normal = normal_at(d.emitter(place.source), point, place.parameters);
        at.is_hit = place.source < d.emitters.size();
    }
    return at;
}

Vec3 Illumination::before_surface(const PlaceInLight& place, const Vec3& point,
                                  const Vec3& from) const {
    const Data& d = *data_;
    if (place.source >= d.emitters.size()) return point;
    const Emitter& e = d.emitters[place.source];
    const Vec3 normal = normal_at(e, point, place.parameters);
    const double away = d.emitters.rounding(place.source);
    return point + (dot(from - point, normal) < 0.0 ? -away : away) * normal;
}

Spectrum Illumination::irradiance(const PlaceInLight& place, const Vec3& point,
                                  const Wavelengths& waves) const {
    const Light* const light = data_->light_at_point(place.source);
    if (light == nullptr) return {};
    const bool clamp = data_->scene->conventions.shading.clamp_attenuation;
    return waves.emission(kPi * sample(*light, point, clamp).intensity);
}

double Illumination::density(const LitPoint& at, const LightPoint& light, const Vec3& to_light,
                             double distance) const {
    const Data& d = *data_;
    if (light.source >= d.near_count()) {
        const std::size_t far_light = light.source - d.near_count();
        return d.is_environment(far_light) ? environment_density(at, to_light)
                                           : (1.0 - d.near_share) * d.far.probability(far_light);
    }
    const double probability = d.near_share * d.probability_of_near(at, light.source);
    if (!(probability > 0.0) || d.point_light(light.source) != nullptr) return probability;
    const EmitterHit there{to_light, distance, light.normal, light.parameters};
    return probability * alhazen::density(d.emitter(light.source), at.point, there);
}

}  // namespace alhazen
