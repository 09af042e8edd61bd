#include "alhazen/renderers/local_shading.h"

#include <cmath>

namespace alhazen {

MaterialSample material_at(const Scene& scene, const Surface& surface) {
    const auto sample = [&](std::size_t i) {
        return evaluate(scene.materials[static_cast<std::size_t>(surface.materials[i])],
                        scene.textures, surface.uv);
    };
    if (surface.material_count == 1) return sample(0);
    return weighted_sum(surface.weights[0], sample(0), surface.weights[1], sample(1),
                        surface.weights[2], sample(2));
}

ShadingPoint shading_point(const Scene& scene, const Ray& ray, const Hit& hit, bool inside) {
    ShadingPoint point;
    point.inside = inside;
    point.surface = surface_at(*scene.aggregate, ray, hit);
    point.material = material_at(scene, point.surface);
    point.view = -ray.direction;
    point.entering = dot(ray.direction, point.surface.normal) < 0.0;
    point.geometric = point.entering ? point.surface.normal : -point.surface.normal;
    // The interpolated normal is turned by its own sign: near silhouettes, and in meshes wound
    // against their normals, it may face the ray although the geometric one does not.
    const Vec3& shading = point.surface.shading_normal;
    point.normal = dot(ray.direction, shading) > 0.0 ? -shading : shading;
    return point;
}

Rgb unshadowed_terms(const Scene& scene, const ShadingPoint& point) {
    const ShadingConventions& conventions = scene.conventions;
    const MaterialSample& m = point.material;
    Rgb ambient_factor = conventions.ambient_factor == ShadingConventions::AmbientFactor::Diffuse
                             ? m.diffuse
                             : m.ambient;
    if (conventions.ambient_inside_times_kt && point.inside) {
        ambient_factor = ambient_factor * m.transmissive;
    }
    Rgb sum = m.emission;
    for (const Light& light : scene.lights) sum += ambient_factor * ambient_of(light);
    return sum;
}

Rgb reflected_fraction(const ShadingConventions& conventions, const ShadingPoint& point,
                       const Vec3& to_light, double cosine) {
    const MaterialSample& m = point.material;
    double highlight_cosine;
    if (conventions.highlight == ShadingConventions::Highlight::BlinnPhong) {
        highlight_cosine = dot(point.normal, normalize(to_light + point.view));
    } else {
        const Vec3 mirrored = 2.0 * cosine * point.normal - to_light;
        highlight_cosine = dot(mirrored, point.view);
    }
    Rgb fraction = cosine * m.diffuse;
    // 0^0 would light every point of a material without shininess from behind: only the lit side
    // counts.
    if (highlight_cosine > 0.0 && !m.specular.is_black()) {
        fraction += std::pow(highlight_cosine, m.shininess) * m.specular;
    }
    return fraction;
}

}  // namespace alhazen
