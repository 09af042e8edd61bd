#include "alhazen/renderers/volumes/media_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "alhazen/primitives/primitive_table.h"
#include "alhazen/renderers/core/coincident_surfaces.h"
#include "alhazen/renderers/core/local_shading.h"
#include "alhazen/renderers/volumes/volume_bounds.h"
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
                               [](const Material& m) { return has_inside(m); })) {
    if (!has_volumes_) return;
    const BoundingSphere sphere = sphere_around_bounded(scene);
    center_ = sphere.center;
    radius_ = sphere.radius;
    reaches_infinity_ = reaches_infinity(scene);
}

MediumStack MediaFinder::around(const Vec3& point, float time) const {
    return found_around(point, nullptr, time);
}

MediumStack MediaFinder::beside(const Vec3& point, const Vec3& normal, float time) const {
    return found_around(point, &normal, time);
}

MediumStack MediaFinder::found_around(const Vec3& point, const Vec3* side, float time) const {
    if (!has_volumes_ || !scene_.aggregate) return {};
    Found found = along(kFromAfar, point, side, time);
    if (reaches_infinity_) {
        found.all.surround(along(-kFromAfar, point, side, time).endless, found.endless);
    }
    return found.all;
}

MediumStack MediaFinder::without_end_around(const Vec3& point, float time) const {
    if (!has_volumes_ || !scene_.aggregate || !reaches_infinity_) return {};
    MediumStack media = along(kFromAfar, point, nullptr, time).endless;
    media.surround(along(-kFromAfar, point, nullptr, time).endless, media);
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

namespace {

/// The end of a ray: at `t`, or, with a `side`, beside the surface there, on the side of that
/// normal.
struct WalkEnd {
    double t = 0;
    const Vec3* side = nullptr;
    double resolution = 0;  ///< distance from a surface within which a point is on it

    [[nodiscard]] bool is_before(const Hit& hit, const Surface& surface,
                                 const Vec3& direction) const {
        if (side == nullptr) return t < hit.t;
        const double slope = dot(direction, surface.normal);
        const double near = (2.0 * LeavingRays::margin(surface) + resolution) /
                            std::max(std::abs(slope), kLeastSlope);
        if (std::abs(hit.t - t) > near) return t < hit.t;
        return (slope < 0.0) != (dot(*side, surface.normal) < 0.0);
    }
    static constexpr double kLeastSlope = 1e-3;
};

}  // namespace

/// Crosses the boundaries along a ray, whatever other surfaces are in front of them.
class MediaFinder::Crossings {
  public:
    Crossings(const MediaFinder& finder, const Ray& ray, const WalkEnd& end, float time)
        : scene_(finder.scene_),
          finder_(finder),
          faces_(finder.faces_),
          ray_(ray),
          end_(end),
          arrival_{false, 0.0, time, true} {}

    /// Crosses the boundaries at all hits; `hits` is sorted.
    void cross(const std::vector<Hit>& hits) {
        for (std::size_t i = 0; i < hits.size();) {
            here_.clear();
            const std::size_t first = i++;
            if (!add(hits[first], first_)) continue;
            // Within this distance they coincide.
            const double to =
                hits[first].t + CoincidentSurfaces::reach(first_.surface, ray_.direction);
            for (; i < hits.size() && hits[i].t <= to; ++i) add(hits[i], other_);
            cross_all_here();
        }
    }
    [[nodiscard]] const Found& found() const { return found_; }

  private:
    /// Adds the boundary at a hit. False if there is none before the end of the ray.
    bool add(const Hit& hit, ShadingPoint& at);
    void cross_all_here();

    const Scene& scene_;
    const MediaFinder& finder_;
    CoincidentFaces faces_;
    const Ray& ray_;
    const WalkEnd& end_;
    Arrival arrival_;
    Found found_;
    ShadingPoint first_, other_;
    OtherFaces here_;
};

bool MediaFinder::Crossings::add(const Hit& hit, ShadingPoint& at) {
    if (!faces_.may_bound(hit)) return false;
    set_shading_point(scene_, ray_, hit, arrival_, {}, at);
    if (end_.is_before(hit, at.surface, ray_.direction)) return false;
    const bool endless = finder_.reaches_infinity_ && finder_.is_endless(hit);
    const std::optional<Medium> inside = faces_.volume_behind(hit, at);
    if (!inside) return false;
    const bool entering = enters_volume(at), wall = is_wall(at.surface);
    const auto same = std::find_if(here_.begin(), here_.end(), [&](const OtherFace& face) {
        return face.inside.part == inside->part;
    });
    if (same == here_.end()) {
        here_.push_back(
            {.inside = *inside, .entering = entering, .wall = wall, .endless = endless});
    } else if (at.surface.media.known) {
        // Rays hit a wall twice; of several faces the first and the last count.
        const bool was_inside = !same->entering, is_inside = entering || wall;
        *same = {.inside = *inside,
                 .entering = !was_inside,
                 .wall = was_inside && is_inside,
                 .endless = same->endless};
        if (!was_inside && !is_inside) here_.erase(same);
    } else if (same->entering != entering) {
        // Else the edge between two pieces of a part.
        here_.erase(same);
    }
    return true;
}

void MediaFinder::Crossings::cross_all_here() {
    // Volumes are left before others are entered: new ones are innermost.
    for (const OtherFace& face : here_) {
        if (face.entering) continue;
        for (MediumStack* const found : {&found_.all, &found_.endless}) {
            if (found == &found_.endless && !face.endless) continue;
            face.wall ? found->change(face.inside) : found->leave(face.inside);
        }
    }
    faces_.sort(here_, first_, ray_.direction, arrival_);
    for (const OtherFace& face : here_) {
        if (!face.entering) continue;
        found_.all.enter(face.inside);
        if (face.endless) found_.endless.enter(face.inside);
    }
}

MediaFinder::Found MediaFinder::along(const Vec3& direction, const Vec3& point, const Vec3* side,
                                      float time) const {
    const double left = way_before_all(direction, point, time);
    WalkEnd end{left, side};
    Ray ray{point - left * direction, direction};
    ray.t_max = left;
    if (side != nullptr) {
        // Lights begin this far beside their surfaces, at most; the second term: rounding.
        const double scale = max_component(abs(point)) + 2.0 * radius_;
        end.resolution = 2e-11 * scale + 0x1p-50 * left;
        ray.t_max += 2.0 * end.resolution / WalkEnd::kLeastSlope;
    }
    std::vector<Hit> hits;
    scene_.aggregate->all_hits(ray, hits, {nullptr, kAllRays, time});
    Crossings crossings(*this, ray, end, time);
    crossings.cross(hits);
    return crossings.found();
}

RayMedium medium_within(const Scene& scene, const MediumStack& volumes, TintedMedia* media) {
    RayMedium result;
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        const Medium& volume = volumes[i];
        const Material& m = scene.materials[volume.material];
        if (!m.dielectric && !m.metallic_roughness) continue;
        result.inside = true;
        result.hidden = (volume.seen_by & mask_of(RayKind::Shadow)) == 0;
        result.absorption = volume.absorption;
        if (media == nullptr) continue;
        result.medium = media->enter({1, 1, 1}, volume.absorption, {volume.part, volume.material},
                                     result.medium);
        if (result.hidden) media->hide(result.medium);
    }
    return result;
}

}  // namespace alhazen
