#include "alhazen/renderers/light_transport/media_finder.h"

#include <algorithm>

#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/scene/scene_sphere.h"

namespace alhazen {

namespace {

/// Along no axis and no diagonal of what people build.
const Vec3 kFromAfar = normalize(Vec3{0.7548776662, 0.5698402910, -0.3247179572});

}  // namespace

MediaFinder::MediaFinder(const Scene& scene)
    : scene_(scene),
      has_volumes_(std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const Material& m) { return !m.is_opaque(); })) {
    if (!has_volumes_) return;
    const BoundingSphere sphere = sphere_around_bounded(scene);
    center_ = sphere.center;
    radius_ = sphere.radius;
}

MediumStack MediaFinder::around(const Vec3& point, float time) const {
    MediumStack media;
    if (!has_volumes_ || !scene_.aggregate) return media;
    double left = length(point - center_) + 2.0 * radius_;
    Ray ray{point - left * kFromAfar, kFromAfar};
    ray.t_max = left;
    ShadingPoint at;
    ScatterPoint scatter;
    for (int passed = 0; passed < kMaxPassedSurfaces; ++passed) {
        Hit hit;
        if (!scene_.aggregate->closest(ray, hit, {nullptr, kAllRays, time})) break;
        set_shading_point(scene_, ray, hit, {!media.empty(), 0.0, time, true}, {}, at);
        scatter.set(scene_, at, media, kColorChannels);
        if (at.material->coverage > 0.0 && scatter.bounds_volume()) scatter.cross(media);
        left -= hit.t;
        if (!(left > 0.0)) break;
        ray = leaving_ray(at.surface, kFromAfar, left);
    }
    return media;
}

}  // namespace alhazen
