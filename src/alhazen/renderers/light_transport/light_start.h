#pragma once
/// How light paths begin, and the media along connections.

#include <cmath>

#include "alhazen/renderers/light_transport/random_walk.h"

namespace alhazen {

/// The walk of a ray of light. Its throughput is black where it carries nothing.
[[nodiscard]] inline WalkStart start_of(const LightRay& light, float time) {
    WalkStart start;
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
    start.density = light.infinite ? light.place_density : light.direction_density;
    return start;
}

/// Gives the vertices of a path from a point the light's own falloff over its first distance.
inline void set_falloff(const Illumination& lights, const LightRay& light,
                        std::vector<PathVertex>& vertices) {
    if (!light.singular_place || vertices.empty()) return;
    const double squared = vertices[0].distance * vertices[0].distance;
    const Rgb arrives = lights.irradiance(light.place, vertices[0].surface.point);
    Rgb factor;
    for (int i = 0; i < 3; ++i) {
        if (light.radiance[i] > 0.0) factor[i] = squared * arrives[i] / light.radiance[i];
    }
    for (PathVertex& v : vertices) v.throughput = v.throughput * factor;
}

/// Of the medium that light runs through from the vertex along `direction`.
[[nodiscard]] inline Rgb absorption_towards(const PathVertex& v, const Vec3& direction) {
    MediumStack media = v.media;
    if (dot(direction, v.scatter.geometric()) < 0.0) v.scatter.cross(media);
    const Medium* const medium = media.here();
    return medium != nullptr ? medium->absorption : Rgb{};
}

}  // namespace alhazen
