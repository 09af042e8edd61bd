#include "alhazen/explain/tree/ray_tree.h"

namespace alhazen {

Rgb color_of(const SurfaceNode& surface) {
    Rgb own = surface.emission;
    if (!surface.lit) return own;
    for (const Rgb& term : surface.ambient) own += surface.ambient_factor * term;
    Rgb direct;
    for (const LightTerm& light : surface.lights) {
        if (light.blocked()) continue;
        direct += light.through * light.intensity * (light.diffuse + light.highlight);
    }
    const auto beyond = [](const std::vector<RayNode>& ray) {
        return ray.empty() ? Rgb{} : ray.front().radiance;
    };
    const Rgb color = own + direct + surface.reflected_factor * beyond(surface.reflected) +
                      surface.refracted_factor * beyond(surface.refracted);
    return surface.filtered ? color * surface.filter : color;
}

Rgb radiance_of(const RayNode& ray, const Rgb& background) {
    Rgb sum;
    for (const SurfaceNode& surface : ray.surfaces) sum += surface.share * color_of(surface);
    return ray.escaped ? sum + ray.left * background : sum;
}

RayCensus census_of(const RayNode& ray) {
    RayCensus census;
    (ray.kind == RayKind::Eye          ? census.eye
     : ray.kind == RayKind::Reflection ? census.reflection
                                       : census.refraction) = 1;
    const auto add = [&](const RayNode& child) {
        const RayCensus of_child = census_of(child);
        census.shadow += of_child.shadow;
        census.reflection += of_child.reflection;
        census.refraction += of_child.refraction;
    };
    for (const SurfaceNode& surface : ray.surfaces) {
        for (const LightTerm& light : surface.lights) census.shadow += light.cast;
        for (const RayNode& child : surface.reflected) add(child);
        for (const RayNode& child : surface.refracted) add(child);
    }
    return census;
}

}  // namespace alhazen
