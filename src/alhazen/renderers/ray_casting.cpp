#include "alhazen/renderers/ray_casting.h"

#include "alhazen/renderers/local_shading.h"
#include "alhazen/renderers/pixel_loop.h"

namespace alhazen {

namespace {

Rgb shade(const Scene& scene, const ShadingPoint& point) {
    Rgb sum = unshadowed_terms(scene, point);
    for (const Light& light : scene.lights) {
        if (!illuminates(light)) continue;
        const LightSample l =
            sample(light, point.surface.point, scene.conventions.clamp_attenuation);
        const double cosine = dot(point.normal, l.to_light);
        if (cosine > 0.0) {
            sum += l.intensity * reflected_fraction(scene.conventions, point, l.to_light, cosine);
        }
    }
    return sum;
}

}  // namespace

void RayCasting::render_tile(const RenderJob& job, const PixelBox& tile, Film& film,
                             RayCounters& counters) const {
    TraversalStats* stats = job.count_tests ? &counters.tests : nullptr;
    render_pixels(job, tile, film, counters, [&](const Ray& eye) {
        RayCount& count = counters[RayKind::Eye];
        ++count.cast;
        Ray ray = eye;
        RayCone cone = job.cone;
        VisibleHit found;
        Rgb sum;
        double left = 1.0;
        int met = 0;
        while (met < kMaxPassedSurfaces &&
               first_visible_hit(job.scene, ray, cone, false, stats, found)) {
            ++met;
            const double coverage = found.point.material.coverage;
            sum += (left * coverage) * shade(job.scene, found.point);
            left *= 1.0 - coverage;
            if (!(left >= kLeastTransmittance)) break;
            ray = leaving_ray(found.point.surface, ray.direction);
            cone = cone.from(found.t);
        }
        count.hit += met > 0;
        return left >= kLeastTransmittance ? sum + left * job.scene.background : sum;
    });
}

}  // namespace alhazen
