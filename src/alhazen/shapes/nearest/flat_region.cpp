#include "alhazen/shapes/nearest/flat_region.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace alhazen {

FlatRegion::FlatRegion(std::vector<Vec3> vertices, std::vector<std::uint32_t> loop_ends,
                       const Vec3& point, const Vec3& normal)
    : vertices_(std::move(vertices)),
      loop_ends_(std::move(loop_ends)),
      point_(point),
      normal_(normal),
      x_axis_(perpendicular(normal)),
      y_axis_(cross(normal, x_axis_)) {
    if (loop_ends_.empty()) loop_ends_ = {static_cast<std::uint32_t>(vertices_.size())};
    for (Vec3& v : vertices_) {
        v -= dot(v - point_, normal_) * normal_;
        flat_.push_back(flat(v));
    }
}

Vec2 FlatRegion::flat(const Vec3& p) const {
    return {dot(p - point_, x_axis_), dot(p - point_, y_axis_)};
}

bool FlatRegion::holds(const Vec2& p) const {
    bool inside = false;
    std::uint32_t first = 0;
    for (const std::uint32_t end : loop_ends_) {
        for (std::uint32_t i = first, last = end - 1; i < end; last = i++) {
            const Vec2 &a = flat_[last], &b = flat_[i];
            if ((a.y > p.y) == (b.y > p.y)) continue;
            if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
        }
        first = end;
    }
    return inside;
}

PointOnSurface FlatRegion::nearest(const Vec3& from) const {
    const Vec3 foot = from - dot(from - point_, normal_) * normal_;
    if (holds(flat(foot))) return {foot, normal_, length_squared(foot - from)};
    PointOnSurface best{{}, normal_, std::numeric_limits<double>::infinity()};
    std::uint32_t first = 0;
    for (const std::uint32_t end : loop_ends_) {
        for (std::uint32_t i = first, last = end - 1; i < end; last = i++) {
            const Vec3 &a = vertices_[last], &b = vertices_[i];
            const double squared = length_squared(b - a);
            const double s =
                squared > 0.0 ? std::clamp(dot(from - a, b - a) / squared, 0.0, 1.0) : 0.0;
            // Interpolated from the nearer end, whose coordinates are thus exact.
            const Vec3 x = s <= 0.5 ? a + s * (b - a) : b + (s - 1.0) * (b - a);
            const double d = length_squared(x - from);
            if (d < best.squared) best = {x, normal_, d};
        }
        first = end;
    }
    return best;
}

}  // namespace alhazen
