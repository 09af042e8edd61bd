#include "alhazen/shapes/nearest/flat_region.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "alhazen/math/odd_segments.h"

namespace alhazen {

namespace {

/// The coordinates across the longest component of the normal, unchanged: points on one line of the
/// plane lie on one line in them.
Vec2 seen_along(const Vec3& normal, const Vec3& p) {
    const Vec3 size = abs(normal);
    if (size.z >= size.x && size.z >= size.y) return {p.x, p.y};
    return size.y >= size.x ? Vec2{p.x, p.z} : Vec2{p.y, p.z};
}

}  // namespace

FlatRegion::FlatRegion(const std::vector<Vec3>& vertices, std::vector<std::uint32_t> loop_ends,
                       const Vec3& point, const Vec3& normal)
    : point_(point),
      normal_(normal),
      x_axis_(perpendicular(normal)),
      y_axis_(cross(normal, x_axis_)) {
    if (loop_ends.empty()) loop_ends = {static_cast<std::uint32_t>(vertices.size())};
    std::vector<PlaneSegment> segments;
    std::vector<std::uint32_t> ends;  // [end of a segment] its vertex
    std::uint32_t first = 0;
    for (const std::uint32_t end : loop_ends) {
        for (std::uint32_t i = first, last = end - 1; i < end; last = i++) {
            segments.push_back(
                {seen_along(normal, vertices[last]), seen_along(normal, vertices[i])});
            ends.insert(ends.end(), {last, i});
        }
        first = end;
    }
    for (const SegmentPart& part : odd_segments(segments)) {
        Edge& edge = edges_.emplace_back();
        for (std::size_t k = 0; k < 2; ++k) {
            Vec3 v = vertices[ends[k == 0 ? part.from : part.to]];
            v -= dot(v - point_, normal_) * normal_;
            edge.ends[k] = v;
            edge.flat[k] = flat(v);
        }
    }
}

Vec2 FlatRegion::flat(const Vec3& p) const {
    return {dot(p - point_, x_axis_), dot(p - point_, y_axis_)};
}

bool FlatRegion::holds(const Vec2& p) const {
    bool inside = false;
    for (const Edge& edge : edges_) {
        const Vec2 &a = edge.flat[0], &b = edge.flat[1];
        if ((a.y > p.y) == (b.y > p.y)) continue;
        if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
    return inside;
}

PointOnSurface FlatRegion::nearest(const Vec3& from) const {
    const Vec3 foot = from - dot(from - point_, normal_) * normal_;
    if (holds(flat(foot))) return {foot, normal_, length_squared(foot - from)};
    PointOnSurface best{{}, normal_, std::numeric_limits<double>::infinity()};
    for (const Edge& edge : edges_) {
        const Vec3 &a = edge.ends[0], &b = edge.ends[1];
        const double squared = length_squared(b - a);
        const double s = squared > 0.0 ? std::clamp(dot(from - a, b - a) / squared, 0.0, 1.0) : 0.0;
        // Interpolated from the nearer end, whose coordinates are thus exact.
        const Vec3 x = s <= 0.5 ? a + s * (b - a) : b + (s - 1.0) * (b - a);
        const double d = length_squared(x - from);
        if (d < best.squared) best = {x, normal_, d};
    }
    return best;
}

}  // namespace alhazen
