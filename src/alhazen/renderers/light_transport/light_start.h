#pragma once
/// How light paths begin and are joined to the lens.

#include <cmath>

#include "alhazen/renderers/light_transport/camera_lens.h"
#include "alhazen/renderers/light_transport/camera_rays.h"
#include "alhazen/renderers/light_transport/light_batch.h"
#include "alhazen/renderers/light_transport/media_finder.h"
#include "alhazen/renderers/light_transport/random_walk.h"

namespace alhazen {

/// The walk of a ray of light. Its throughput is black where it carries nothing.
[[nodiscard]] inline WalkStart start_of(const LightRay& light, float time, const MediaFinder& media,
                                        const Wavelengths& waves) {
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
    if (!light.infinite) start.media = media.around(light.ray.origin, time);
    start.density = light.infinite ? light.place_density : light.direction_density;
    return start;
}

/// Gives the vertices of a path from a point the light's own falloff over its first distance.
inline void set_falloff(const Illumination& lights, const LightRay& light, const Wavelengths& waves,
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

/// The ray from the lens to a vertex, which ends before it.
[[nodiscard]] inline Ray from_lens(const PathVertex& v, const LensConnection& joined) {
    const Ray back = v.leaving(joined.to_lens, joined.distance);
    const Vec3 lens = back.at(joined.distance);
    Ray ray{lens, -joined.to_lens};
    ray.t_max = kBeforeEnd * length(lens - back.origin);
    return ray;
}

/// The volumes around the start of that ray. Where none scatters, those at the vertex: one is all
/// along it. `behind`: as of PathVertex::media_along; the result may be in it.
[[nodiscard]] inline const MediumStack& media_from_lens(const Scene& scene,
                                                        const CameraRays& camera, const Ray& ray,
                                                        float time, const PathVertex& v,
                                                        MediumStack& behind) {
    if (!scene.has_scattering) return v.media_along(-ray.direction, behind);
    behind = camera.media(ray, time);
    return behind;
}

}  // namespace alhazen
