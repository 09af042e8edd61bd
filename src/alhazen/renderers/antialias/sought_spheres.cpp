#include "alhazen/renderers/antialias/sought_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

constexpr std::size_t kRaysOfATask = 4096;

/// Whether the ray meets the box, widened by `room`, in [0, distance].
bool meets_box(const Box3& box, double room, const Ray& ray, double distance) {
    double enter = 0.0, leave = distance;
    for (int k = 0; k < 3; ++k) {
        const double a = box.lo[k] - room - ray.origin[k], b = box.hi[k] + room - ray.origin[k];
        if (ray.direction[k] == 0.0) {
            if (a > 0.0 || b < 0.0) return false;
            continue;
        }
        const double ta = a / ray.direction[k], tb = b / ray.direction[k];
        enter = std::max(enter, std::min(ta, tb) * (1.0 - 1e-14));
        leave = std::min(leave, std::max(ta, tb) * (1.0 + 1e-14));
    }
    return enter <= leave;
}

}  // namespace

SoughtSpheres::SoughtSpheres(const std::vector<SceneObject>& objects,
                             const std::vector<std::uint8_t>& met, const PictureGrid& picture)
    : objects_(objects), met_(met), picture_(picture) {
    PrimitiveTable table;
    auto& column = std::get<ShapeColumn<Sphere>>(table.columns);
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        const SceneObject& object = objects[i];
        if (met[i] != 0 || !object.is_seen || !(object.sphere.radius < kInfinity)) continue;
        const double r = (1.0 + 1e-9) * radius(object, 0);
        sought_.push_back(i);
        column.shapes.push_back({object.sphere.center, r});
        column.placements.push_back(kNoPlacement);
        column.materials.push_back(MaterialId{0});
        if (picture.is_parallel() || picture.distance(object.sphere.center) <= r) {
            t_min_ = -kInfinity;
        }
    }
    table.material_opacity.push_back(Opacity::Opaque);
    table.finish();
    if (!sought_.empty()) tree_ = make_aggregate(kDefaultAccelerator, std::move(table));
}

double SoughtSpheres::radius(const SceneObject& object, int level) const {
    const double distance = picture_.distance(object.sphere.center);
    return std::max(object.sphere.radius, picture_.least_radius(level, distance));
}

bool SoughtSpheres::passes(std::uint32_t object, int level, const Ray& ray, double distance) const {
    const SceneObject& o = objects_[object];
    const Vec3 to_center = o.sphere.center - ray.origin;
    const Vec3 across = cross(to_center, ray.direction);
    const double r = radius(o, level);
    const double within = r * r - dot(across, across);
    if (!(within >= 0.0)) return false;
    const double middle = dot(to_center, ray.direction), half = std::sqrt(within);
    if (!(middle - half < distance) || middle + half < 0.0) return false;
    const double room = picture_.least_radius(level, picture_.distance(o.sphere.center));
    return meets_box(o.box, room, ray, distance);
}

std::vector<WatchedObject> SoughtSpheres::around(std::span<const GridPoint> points, int depth,
                                                 std::span<const double> distances, int width,
                                                 int height) const {
    std::vector<std::vector<WatchedObject>> found((points.size() + kRaysOfATask - 1) /
                                                  kRaysOfATask);
    const auto add_pixels = [&](GridPoint p, std::uint32_t object,
                                std::vector<WatchedObject>& list) {
        for (int y = std::max(p.y - 1, 0); y <= std::min(p.y, height - 1); ++y) {
            for (int x = std::max(p.x - 1, 0); x <= std::min(p.x, width - 1); ++x) {
                list.push_back(
                    {std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x), object});
            }
        }
    };
    parallel_for(points.size(), kRaysOfATask, [&](std::size_t begin, std::size_t end) {
        std::vector<Hit> hits;
        std::vector<WatchedObject>& list = found[begin / kRaysOfATask];
        for (std::size_t i = begin; i < end; ++i) {
            const GridPoint corner{points[i].x >> depth, points[i].y >> depth};
            Ray ray = picture_.ray(0, corner);
            ray.t_min = t_min_;
            ray.t_max = distances[i];
            hits.clear();
            tree_->all_hits(ray, hits, nullptr);
            for (const Hit& hit : hits) {
                const std::uint32_t object = sought_[static_cast<std::size_t>(hit.primitive)];
                if (passes(object, 0, ray, distances[i])) add_pixels(corner, object, list);
            }
        }
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    });
    std::vector<WatchedObject> all;
    for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

}  // namespace alhazen
