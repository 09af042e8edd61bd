#include <cmath>

#include "alhazen/illumination/illumination_data.h"
#include "alhazen/math/constants.h"

namespace alhazen {

bool Illumination::picks_any() const {
    return data_->picked.total() > 0.0;
}

Illumination::LightPick Illumination::pick(double choice, const Vec2& u) const {
    const Data& d = *data_;
    const ChosenLight chosen = d.picked.choose(choice);
    LightPick pick;
    pick.place.source = chosen.light;
    if (!(chosen.probability > 0.0)) return pick;
    if (chosen.light >= d.near_count()) {
        const Light& sun = d.scene->lights[d.parallel[chosen.light - d.near_count()]];
        pick.at = std::get<DirectionalLight>(sun).to_light;
        pick.infinite = true;
        pick.density = chosen.probability;
    } else if (const Light* light = d.point_light(chosen.light)) {
        const auto* spot = std::get_if<SpotLight>(light);
        pick.at = spot != nullptr ? spot->position : std::get<PointLight>(*light).position;
        pick.density = chosen.probability;
    } else {
        const EmitterPoint p = point_of(d.emitter(chosen.light), u);
        if (!(p.density > 0.0) || !std::isfinite(p.density)) return pick;
        pick.at = p.point;
        pick.normal = p.normal;
        pick.place.parameters = p.parameters;
        pick.is_hit = chosen.light < d.emitters.size();
        pick.density = chosen.probability * p.density;
    }
    return pick;
}

Spectrum Illumination::sent(const LightPick& from, const Vec3& to, const Wavelengths& waves) const {
    const Data& d = *data_;
    if (from.infinite) {
        const std::size_t far_light = from.place.source - d.near_count();
        const Light& sun = d.scene->lights[d.parallel[far_light]];
        return waves.emission(kPi * std::get<DirectionalLight>(sun).color);
    }
    const Vec3 way = to - from.at;
    const double distance = length(way);
    if (!(distance > 0.0)) return {};
    if (d.light_at_point(from.place.source) != nullptr) {
        return (distance * distance) * irradiance(from.place, to, waves);
    }
    const Emitter& e = d.emitter(from.place.source);
    const double cosine = dot(from.normal, way) / distance;
    if (!e.two_sided && !(cosine > 0.0)) return {};
    const Rgb radiance = from.is_hit ? d.emitters.radiance(from.place.source, to, -way / distance,
                                                           distance, from.place.parameters)
                                     : e.radiance;
    return std::abs(cosine) * waves.emission(radiance);
}

bool Illumination::may_pick(const Hit& hit, const Surface& surface, const Vec3& direction) const {
    const std::optional<std::size_t> found = data_->emitters.find(hit);
    return found && data_->picked.probability(*found) > 0.0 &&
           (data_->emitters[*found].two_sided || dot(surface.normal, direction) < 0.0);
}

}  // namespace alhazen
