#include "alhazen/renderers/photon_mapping/gathering_eye.h"

#include <algorithm>
#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/even_numbers.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

Spectrum GatheringEye::photon_light(const SeenPoint& at) {
    const Vec3& point = at.surface.point;
    const PhotonMapPair& maps = maps_.pairs[at.waves];
    const bool hero_only = at.path.waves->hero_only();
    const Spectrum caustic =
        density_.radiance(maps.caustic, at.scatter, point, LightPart::NotGlossy, hero_only);
    if (gather_ > 0) {
        const std::optional<Spectrum> matt =
            cache_ != nullptr ? at.scatter.lambert() : std::nullopt;
        return caustic + (matt ? matt_light(at, *matt) : gathered(at));
    }
    return caustic +
           density_.radiance(maps.global, at.scatter, point, LightPart::NotGlossy, hero_only);
}

Spectrum GatheringEye::photon_light(const SeenVolume& at) {
    return volume_light(at.place, at.waves, at.path.waves->hero_only());
}

Spectrum GatheringEye::volume_light(const VolumePoint& at, std::size_t waves, bool hero_only) {
    const PhotonMapPair& maps = maps_.pairs[waves];
    return density_.radiance(maps.caustic_in_volumes, at, hero_only) +
           density_.radiance(maps.global_in_volumes, at, hero_only);
}

Spectrum GatheringEye::matt_light(const SeenPoint& at, const Spectrum& reflectance) {
    std::optional<Spectrum> irradiance = cache_->irradiance(at.surface.point, at.scatter.normal());
    if (!irradiance) {
        const IrradianceRecord record = record_at(at);
        if (records_ != nullptr) records_->push_back(record);
        irradiance = record.irradiance;
    }
    return (1.0 / kPi) * (reflectance * *irradiance);
}

IrradianceRecord GatheringEye::record_at(const SeenPoint& at) {
    IrradianceRecord record{at.surface.point, at.scatter.normal(), {}, 0.0};
    const Vec3 x = perpendicular(record.normal), y = cross(record.normal, x);
    const Vec2 shift{at.numbers.at(0), at.numbers.at(1)};
    double inverse = 0.0;
    for (int k = 0; k < gather_; ++k) {
        const double squared = fraction(static_cast<double>(k) / gather_ + shift.x);
        const double angle = 2.0 * kPi * (mirrored_bits(static_cast<std::uint32_t>(k)) + shift.y);
        const double across = std::sqrt(squared);
        const Vec3 along =
            normalize((across * std::cos(angle)) * x + (across * std::sin(angle)) * y +
                      std::sqrt(1.0 - squared) * record.normal);
        if (!(dot(along, at.scatter.geometric()) > 0.0)) continue;
        PathEnd path;
        path.time = at.path.time;
        path.media = at.path.media;
        path.kind = RayKind::Reflection;
        path.ray = leaving_ray(at.surface, along);
        const PathNumbers numbers{mix64(at.numbers.seed) + static_cast<std::uint64_t>(k),
                                  at.numbers.path, at.numbers.part};
        double distance = kInfinity;
        record.irradiance += (kPi / gather_) * arriving(path, at, numbers, distance);
        inverse += 1.0 / (gather_ * distance);
    }
    // Least and largest reach of a record, in pixels.
    constexpr double kLeastPixels = 2.0, kMostPixels = 64.0;
    const double pixel = at.path.cone.width / cache_->error();
    record.distance = 1.0 / inverse;
    if (pixel > 0.0) {
        record.distance = std::clamp(record.distance, kLeastPixels * pixel, kMostPixels * pixel);
    }
    return record;
}

Spectrum GatheringEye::gathered(const SeenPoint& at) {
    constexpr double kGolden = 0.6180339887498949;
    const Vec3 shift{at.numbers.at(0), at.numbers.at(1), at.numbers.at(2)};
    Spectrum sum;
    for (int k = 0; k < gather_; ++k) {
        const Vec2 u{fraction(static_cast<double>(k) / gather_ + shift.x),
                     fraction(mirrored_bits(static_cast<std::uint32_t>(k)) + shift.y)};
        const auto drawn =
            at.scatter.sample(fraction(k * kGolden + shift.z), u, Transport::Radiance);
        if (!drawn || drawn->singular || drawn->density > kGlossyDensity) continue;
        PathEnd path;
        path.time = at.path.time;
        path.media = at.path.media;
        NextSurface::go_on(path, at.surface, at.scatter, *drawn);
        const PathNumbers numbers{mix64(at.numbers.seed) + static_cast<std::uint64_t>(k),
                                  at.numbers.path, at.numbers.part};
        double distance = 0.0;
        sum += arriving(path, at, numbers, distance);
    }
    return (1.0 / gather_) * sum;
}

Spectrum GatheringEye::arriving(PathEnd& path, const SeenPoint& at, const PathNumbers& numbers,
                                double& distance) {
    along_ = *at.path.waves;
    path.waves = &along_;
    Spectrum sum;
    int scatterings = 0;
    // Events are also surfaces that are passed straight.
    for (std::uint64_t event = 0; scatterings < settings_.depth; ++event) {
        const std::uint64_t first = 3 * event;
        const PathMeets meets = next_.find(path, numbers);
        if (meets == PathMeets::Nothing) return sum;
        if (event == 0) distance = path.travelled;
        if (meets == PathMeets::Volume) {
            const VolumePoint& place = next_.volume();
            Spectrum light = volume_light(place, at.waves, along_.hero_only());
            const DirectLight straight = direct_light(
                place, numbers.at(first), {numbers.at(first + 1), numbers.at(first + 2)}, along_);
            if (!straight.light.is_black()) {
                light +=
                    straight.light * shadows_.passing(straight.ray, path.time, path.media, along_);
            }
            return sum + path.throughput * light;
        }
        const ShadingPoint& point = next_.point();
        if (point.material->unlit) return sum;
        met_.set(scene_, point, path.media, along_, false, nullptr, &next_.others(), next_.sheet());
        if (met_.needs_hero()) along_.keep_hero(path.throughput);
        if (met_.has_density()) {
            sum += path.throughput * density_.radiance(maps_.pairs[at.waves].global, met_,
                                                       point.surface.point, LightPart::All,
                                                       along_.hero_only());
        }
        const auto drawn = met_.sample(
            numbers.at(first), {numbers.at(first + 1), numbers.at(first + 2)}, Transport::Radiance);
        if (!drawn || !drawn->singular || drawn->weight.is_black()) return sum;
        if (drawn->straight) {
            if (path.met > kMaxPassedSurfaces) return sum;
        } else {
            ++scatterings;
        }
        NextSurface::go_on(path, point.surface, met_, *drawn);
        if (drawn->dispersed) along_.keep_hero(path.throughput);
    }
    return sum;
}

}  // namespace alhazen
