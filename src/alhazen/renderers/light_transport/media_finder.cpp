#include "alhazen/renderers/light_transport/media_finder.h"

#include <algorithm>
#include <iterator>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/scene/scene_sphere.h"

namespace alhazen {

namespace {

/// Unlikely to be parallel to an edge of the model.
const Vec3 kFromAfar = normalize(Vec3{0.7548776662, 0.5698402910, -0.3247179572});

}  // namespace

MediaFinder::MediaFinder(const Scene& scene)
    : scene_(scene),
      faces_(scene),
      has_volumes_(std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const Material& m) { return !m.is_opaque(); })) {
    if (!has_volumes_) return;
    const BoundingSphere sphere = sphere_around_bounded(scene);
    center_ = sphere.center;
    radius_ = sphere.radius;
    reaches_infinity_ = reaches_infinity(scene);
}

MediumStack MediaFinder::around(const Vec3& point, float time) const {
    if (!has_volumes_ || !scene_.aggregate) return {};
    Found found = along(kFromAfar, point, time);
    if (reaches_infinity_) {
        found.all.surround(along(-kFromAfar, point, time).endless, found.endless);
    }
    return found.all;
}

MediumStack MediaFinder::without_end_around(const Vec3& point, float time) const {
    if (!has_volumes_ || !scene_.aggregate || !reaches_infinity_) return {};
    MediumStack media = along(kFromAfar, point, time).endless;
    media.surround(along(-kFromAfar, point, time).endless, media);
    return media;
}

double MediaFinder::way_before_all(const Vec3& direction, const Vec3& point, float time) const {
    const double way = length(point - center_) + 2.0 * radius_;
    if (!reaches_infinity_) return way;
    // At larger distances, coordinates do not resolve the point.
    constexpr double kMostRadii = 1e8;
    std::vector<Hit> crossings;
    scene_.aggregate->all_hits({point, -direction, 0.0, kMostRadii * radius_}, crossings,
                               {nullptr, kAllRays, time});
    return crossings.empty() ? way : std::max(way, crossings.back().t + radius_);
}

bool MediaFinder::is_endless(const Hit& hit) const {
    return !scene_.aggregate->primitives().box(static_cast<std::size_t>(hit.top())).bounded();
}

MediaFinder::Found MediaFinder::along(const Vec3& direction, const Vec3& point, float time) const {
    Found found;
    MediumStack& media = found.all;
    double left = way_before_all(direction, point, time);
    Ray ray{point - left * direction, direction};
    ray.t_max = left;
    ShadingPoint at;
    ScatterPoint scatter;
    CoincidentFaces faces(faces_);
    OtherFaces endless;
    const auto cross_endless = [&](const Hit& hit, MediumStack& around) {
        if (!is_endless(hit)) {
            for (const OtherFace& other : faces.others()) {
                if (!other.endless) continue;
                other.entering ? around.enter(other.inside) : around.leave(other.inside);
            }
            return;
        }
        endless.clear();
        std::copy_if(faces.others().begin(), faces.others().end(), std::back_inserter(endless),
                     [](const OtherFace& other) { return other.endless; });
        scatter.set(scene_, at, around, kColorChannels, false, nullptr, &endless);
        scatter.cross(around);
    };
    for (int passed = 0; passed < kMaxPassedSurfaces; ++passed) {
        Hit hit;
        if (!scene_.aggregate->closest(ray, hit, {nullptr, kAllRays, time})) break;
        const Arrival arrival{!media.empty(), 0.0, time, true};
        set_shading_point(scene_, ray, hit, arrival, {}, at);
        faces.find(at, direction, arrival, kAllRays);
        scatter.set(scene_, at, media, kColorChannels, false, nullptr, &faces.others());
        if (scatter.bounds_volume()) {
            scatter.cross(media);
            if (reaches_infinity_) cross_endless(hit, found.endless);
        }
        left -= hit.t;
        if (!(left > 0.0)) break;
        ray = leaving_ray(at.surface, direction, left);
    }
    return found;
}

}  // namespace alhazen
