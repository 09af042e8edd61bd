// The light that paths of PathTracer bring: what they meet, what is sampled at their vertices, and
// its layers.

#include <algorithm>
#include <array>
#include <limits>

#include "alhazen/renderers/light_transport/emission_of.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"
#include "alhazen/renderers/path_tracing/path_tracer.h"

namespace alhazen {

void PathTracer::add(const EyePath& path, const Spectrum& light, Spectrum& sum) {
    if (settings_.polarization) {
        return add_polarized(path.sample, path.scatterings, path.first, light,
                             polarized_[path.sample].arrived());
    }
    const Spectrum shown = limited(light, path.scatterings);
    if (RecordedVertex* vertex = recorded(path)) vertex->found += waves(path).color(shown);
    if (layers_ != nullptr) parts_[path.sample].add(shown, path.scatterings, path.first);
    sum += shown;
}

void PathTracer::add_polarized(std::uint32_t sample, int scatterings, const FirstScattering& first,
                               const Spectrum& light, const StokesLight& to_eye) {
    StokesLight shown = to_eye * light;
    if (const double limit = limit_of(shown.i, scatterings); limit < 1.0) shown = limit * shown;
    if (layers_ != nullptr) {
        parts_[sample].add(shown.i, scatterings, first);
        if (camera_.is_mirrored()) shown.u = -1.0 * shown.u;
        parts_[sample].polarized += shown;
    }
    light_[sample] += shown.i;
}

Spectrum& PathTracer::place_of_joined(const EyePath& path, const FirstScattering& first,
                                      const ScatterPoint* scatter, const Vec3& direction,
                                      Spectrum& sum) {
    if (!joins_apart()) return sum;
    if (settings_.polarization) {
        const PolarizedPath& polarized = polarized_[path.sample];
        joined_to_eye_.push_back(scatter == nullptr
                                     ? polarized.arrived()
                                     : polarized.arrived(scatter->view(), direction,
                                                         scatter->polarization(direction, false)));
    }
    return joined_.emplace_back(JoinedLight{path.sample, path.scatterings + 1, first, Spectrum{}})
        .light;
}

void PathTracer::add_joined() {
    for (std::size_t i = 0; i < joined_to_eye_.size(); ++i) {
        const JoinedLight& joined = joined_[i];
        add_polarized(joined.sample, joined.scatterings, joined.first, joined.light,
                      joined_to_eye_[i]);
    }
    if (settings_.polarization) return;
    for (const JoinedLight& joined : joined_) {
        parts_[joined.sample].add(joined.light, joined.scatterings, joined.first);
        light_[joined.sample] += joined.light;
    }
}

FirstScattering PathTracer::first_along(const Vertex& vertex, const Vec3& direction) const {
    const ScatterPoint& scatter = vertex.scatter;
    if (layers_ == nullptr || vertex.path->scatterings > 0) return vertex.path->first;
    return {dot(direction, scatter.geometric()) < 0.0, scatter.diffuse_share(direction)};
}

double PathTracer::limit_of(const Spectrum& light, int scatterings) const {
    if (!(settings_.clamp > 0.0) || scatterings < 2) return 1.0;
    const double largest = light.max();
    return largest > settings_.clamp ? settings_.clamp / largest : 1.0;
}

void PathTracer::escape(const EyePath& path, const Ray& ray, Spectrum& sum) {
    Illumination::FarLight far;
    if (path.singular) {
        far.radiance = lights_.environment(ray.direction, waves(path));
    } else {
        far = lights_.far_light(path.from, ray.direction, waves(path));
    }
    add_far_light(path, far, sum);
}

void PathTracer::escape_all() {
    constexpr std::size_t kAtOnce = 16;
    std::array<Vec3, kAtOnce> directions;
    std::array<Illumination::FarLight, kAtOnce> lights;
    for (std::size_t done = 0; done < escaped_.size(); done += kAtOnce) {
        const std::size_t count = std::min(kAtOnce, escaped_.size() - done);
        const std::span<const std::uint32_t> some = std::span(escaped_).subspan(done, count);
        for (std::size_t i = 0; i < count; ++i) directions[i] = rays_[some[i]].direction;
        lights_.find_far_lights(std::span(directions).first(count), lights.data());
        for (std::size_t i = 0; i < count; ++i) {
            const EyePath& path = paths_[alive_[some[i]]];
            add_far_light(path, lights[i], light_[path.sample]);
        }
    }
    escaped_.clear();
}

void PathTracer::add_far_light(const EyePath& path, const Illumination::FarLight& far,
                               Spectrum& sum) {
    Spectrum light = path.throughput * far.radiance;
    if (light.is_black()) return;
    if (const Medium* medium = path.media.here();
        medium != nullptr && media_.in(*medium) == nullptr) {
        light = light * transmittance(waves(path).absorption(medium->absorption),
                                      std::numeric_limits<double>::infinity());
    }
    if (!path.singular) light = weights_.of_hit(path.density, far.density) * light;
    add(path, light, sum);
}

void PathTracer::add_emission(const EyePath& path, const Ray& ray, const Hit& hit,
                              const ShadingPoint& point, Spectrum& sum) {
    if (point.material->emission.is_black()) return;
    if (manifold_ != nullptr && manifold_->finds(path.trail, hit, point.surface, ray.direction)) {
        return;
    }
    Spectrum light = path.throughput * emission_of(scene_, point, waves(path));
    if (!path.singular) {
        // Unlit surfaces show their colour and emit no light.
        if (point.material->unlit) return;
        const double other = lights_.density(path.from, ray, hit, point.surface, path.travelled);
        light = weights_.of_hit(path.density, other) * light;
    }
    add(path, light, sum);
}

void PathTracer::add_direct_light(const Vertex& vertex, const LightDraw& drawn, Spectrum& sum) {
    const EyePath& path = *vertex.path;
    const ScatterPoint& scatter = vertex.scatter;
    if (!(drawn.density > 0.0) || drawn.radiance.is_black()) return;
    Spectrum light = scatter.value(drawn.to_light, Transport::Radiance) * drawn.radiance;
    if (light.is_black()) return;
    double weight = 1.0 / drawn.density;
    if (!drawn.singular) {
        weight *= weights_.of_shadow_ray(drawn.density, scatter.density(drawn.to_light));
    }
    light = path.throughput * (weight * light);
    const bool goes_behind = dot(drawn.to_light, scatter.geometric()) < 0.0;
    if (goes_behind) {
        behind_ = path.media;
        scatter.cross(behind_);
    }
    const Ray shadow =
        ray_to_light(lights_, vertex.place, vertex.leaving->along(drawn.to_light, drawn.distance),
                     drawn.distance, drawn.place, drawn.facing);
    const Spectrum shown = limited_joined(light, path.scatterings + 1);
    Spectrum* const waiting = record_shadow(path, shadow, shown);
    Spectrum& to = waiting != nullptr ? *waiting
                   : !joins_apart()   ? sum
                                      : place_of_joined(path, first_along(vertex, drawn.to_light),
                                                        &scatter, drawn.to_light, sum);
    shadows_.add(shadow, path.time, goes_behind ? behind_ : path.media, waves(path), shown, to);
}

void PathTracer::add_chains(const Vertex& vertex, Spectrum& sum) {
    const EyePath& path = *vertex.path;
    const ManifoldLight::Receiver at{vertex.point->surface,
                                     vertex.scatter,
                                     path.media,
                                     path.time,
                                     waves(path),
                                     settings_.depth - path.scatterings - 1,
                                     random_,
                                     ids_[path.sample],
                                     static_cast<std::uint32_t>(path.drawn)};
    chains_->find(at, [&](const ManifoldLight::Arrived& arrived) {
        const int scatterings = path.scatterings + 1 + arrived.bends;
        const Spectrum light = limited(path.throughput * arrived.light, scatterings);
        if (layers_ != nullptr) {
            parts_[path.sample].add(light, scatterings, first_along(vertex, arrived.direction));
        }
        sum += light;
    });
}

}  // namespace alhazen
