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
    render_pixels(job, tile, film, counters, [&](const Ray& ray) {
        RayCount& count = counters[RayKind::Eye];
        ++count.cast;
        Hit hit;
        if (!job.scene.aggregate->closest(ray, hit, stats)) return job.scene.background;
        ++count.hit;
        return shade(job.scene, shading_point(job.scene, ray, hit, false));
    });
}

}  // namespace alhazen
