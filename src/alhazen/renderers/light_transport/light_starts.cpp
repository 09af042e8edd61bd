#include "alhazen/renderers/light_transport/light_starts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "alhazen/scene/scene_sphere.h"

namespace alhazen {

LightStarts::LightStarts(const Scene& scene)
    : scene_(scene),
      media_(scene),
      scattering_(scene),
      is_endless_(reaches_infinity(scene)),
      radius_(is_endless_ ? sphere_around_bounded(scene).radius : 0.0) {}

WalkStart LightStarts::of(const LightRay& light, float time, const Wavelengths& waves) const {
    WalkStart start;
    start.waves = &waves;
    start.ray = light.ray;
    start.time = time;
    const double densities = light.place_density * light.direction_density;
    if (!(densities > 0.0)) {
        start.throughput = {};
        return start;
    }
    const bool across = light.singular_place || light.infinite;
    const double cosine = across ? 1.0 : std::abs(dot(light.ray.direction, light.normal));
    start.throughput = (cosine / densities) * light.radiance;
    start.parallel = light.infinite;
    start.as_connection = !light.is_hit;
    start.of_either = light.is_hit && scene_.hides_lights_from_some;
    if (light.infinite) {
        if (is_endless_) begin_from_infinity(start);
    } else {
        start.media = light.singular_place ? media_.around(light.ray.origin, time)
                                           : media_.beside(light.ray.origin, light.normal, time);
    }
    start.density = light.infinite ? light.place_density : light.direction_density;
    return start;
}

void LightStarts::begin_from_infinity(WalkStart& start) const {
    if (!begin_before_all(start.ray, start.time)) {
        start.throughput = {};
        return;
    }
    start.media = media_.without_end_around(start.ray.origin, start.time);
    const Extinction taken = scattering_.extinction(start.media.here());
    if (taken.is_black()) return;
    start.throughput = start.throughput * transmittance(taken.of(*start.waves),
                                                        std::numeric_limits<double>::infinity());
}

bool LightStarts::begin_before_all(Ray& ray, float time) const {
    // At larger distances, coordinates do not resolve the bounded geometry.
    constexpr double kMostRadii = 1e8;
    const double far = kMostRadii * radius_;
    const RayQuery query{nullptr, kAllRays, time};
    std::vector<Hit> crossings;
    const Ray beyond{ray.origin, -ray.direction, far, std::numeric_limits<double>::infinity()};
    if (scene_.aggregate->shadowed(beyond, crossings, query)) return false;
    crossings.clear();
    const Ray back{ray.origin, -ray.direction, 0.0, far};
    scene_.aggregate->all_hits(back, crossings, query);
    if (!crossings.empty()) ray.origin = back.at(crossings.back().t + radius_);
    return true;
}

void set_falloff(const Illumination& lights, const LightRay& light, const Wavelengths& waves,
                 std::vector<PathVertex>& vertices) {
    if (!light.singular_place || vertices.empty()) return;
    const double squared = vertices[0].distance * vertices[0].distance;
    const Spectrum arrives = lights.irradiance(light.place, vertices[0].point(), waves);
    Spectrum factor;
    for (int i = 0; i < Spectrum::kCount; ++i) {
        if (light.radiance[i] > 0.0) factor[i] = squared * arrives[i] / light.radiance[i];
    }
    for (PathVertex& v : vertices) v.throughput = v.throughput * factor;
}

}  // namespace alhazen
