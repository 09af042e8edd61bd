#include "alhazen/renderers/antialias/search_spheres.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

namespace {

constexpr std::size_t kRowsOfATask = 4;

/// The interval of a ray between planes.
struct Stretch {
    double enter, leave;

    /// `origin`, `direction`: of the ray along the normal of two planes at `lo` and `hi`.
    void narrow(double lo, double hi, double origin, double direction) {
        const double a = lo - origin, b = hi - origin;
        if (direction == 0.0) {
            if (a > 0.0 || b < 0.0) leave = -kInfinity;
            return;
        }
        const double ta = a / direction, tb = b / direction;
        enter = std::max(enter, std::min(ta, tb) * (1.0 - 1e-14));
        leave = std::min(leave, std::max(ta, tb) * (1.0 + 1e-14));
    }
};

/// True if the ray meets the bounds of the object, enlarged by `margin`, in [0, distance].
bool meets_bounds(const SceneObject& object, double margin, const Ray& ray, double distance) {
    Stretch stretch{0.0, distance};
    for (int k = 0; k < 3; ++k) {
        stretch.narrow(object.box.lo[k] - margin, object.box.hi[k] + margin, ray.origin[k],
                       ray.direction[k]);
    }
    for (std::size_t k = 0; k < kDiagonals.size() && stretch.enter <= stretch.leave; ++k) {
        const Interval& extent = object.diagonals[k];
        stretch.narrow(extent.lo - margin, extent.hi + margin, dot(kDiagonals[k], ray.origin),
                       dot(kDiagonals[k], ray.direction));
    }
    return stretch.enter <= stretch.leave;
}

}  // namespace

SearchSpheres::SearchSpheres(const std::vector<SceneObject>& objects,
                             const std::vector<std::uint8_t>& met, const PictureGrid& picture,
                             bool behind_all)
    : objects_(objects), met_(met), picture_(picture), behind_all_(behind_all) {
    PrimitiveTable table;
    auto& column = std::get<ShapeColumn<Sphere>>(table.columns);
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
        const SceneObject& object = objects[i];
        if (met[i] != 0 || !object.is_seen || !(object.sphere.radius < kInfinity)) continue;
        const double r = (1.0 + 1e-9) * (object.sphere.radius + margin(object, 0));
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

double SearchSpheres::margin(const SceneObject& object, int level) const {
    const double nearest = picture_.distance(object.sphere.center);
    return picture_.least_radius(level, nearest + object.sphere.radius);
}

bool SearchSpheres::may_hide(std::uint32_t object, int level, GridPoint cell,
                             double farthest) const {
    const SceneObject& o = objects_[object];
    const Ray ray = picture_.ray(level + 1, {2 * cell.x + 1, 2 * cell.y + 1});
    const Vec3 to_center = o.sphere.center - ray.origin;
    const Vec3 across = cross(to_center, ray.direction);
    const double around = margin(o, level), r = o.sphere.radius + around;
    const double within = r * r - dot(across, across);
    if (!(within >= 0.0)) return false;
    const double middle = dot(to_center, ray.direction), half = std::sqrt(within);
    if (!(middle - half < reach(farthest)) || middle + half < 0.0) return false;
    return meets_bounds(o, around, ray, reach(farthest));
}

std::vector<WatchedObject> SearchSpheres::around(const AdaptiveGrid& grid) const {
    const std::uint32_t width = grid.width(), height = grid.height();
    std::vector<std::vector<WatchedObject>> found((height + kRowsOfATask - 1) / kRowsOfATask);
    parallel_for(height, kRowsOfATask, [&](std::size_t begin, std::size_t end) {
        std::vector<Hit> hits;
        std::vector<std::uint32_t> hiding;
        std::vector<WatchedObject>& list = found[begin / kRowsOfATask];
        for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
            for (int x = 0; x < static_cast<int>(width); ++x) {
                const double farthest = grid.farthest_of_pixel(x, y);
                Ray ray = picture_.ray(1, {2 * x + 1, 2 * y + 1});
                ray.t_min = t_min_;
                ray.t_max = reach(farthest);
                hits.clear();
                tree_->all_hits(ray, hits, nullptr);
                hiding.clear();
                for (const Hit& hit : hits) {
                    const std::uint32_t object = sought_[static_cast<std::size_t>(hit.primitive)];
                    if (may_hide(object, 0, {x, y}, farthest)) hiding.push_back(object);
                }
                std::sort(hiding.begin(), hiding.end());
                hiding.erase(std::unique(hiding.begin(), hiding.end()), hiding.end());
                const std::uint32_t pixel = std::uint32_t(y) * width + std::uint32_t(x);
                for (const std::uint32_t object : hiding) list.push_back({pixel, object});
            }
        }
    });
    std::vector<WatchedObject> all;
    for (const auto& list : found) all.insert(all.end(), list.begin(), list.end());
    return all;
}

}  // namespace alhazen
