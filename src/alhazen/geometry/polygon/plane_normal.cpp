#include "alhazen/geometry/polygon/plane_normal.h"

#include <algorithm>
#include <cstddef>

#include "alhazen/math/interval.h"

namespace alhazen {

namespace {

/// Newell's normal is dropped where the vertices are this many times farther off its plane than off
/// that of their largest triangle, and farther than that share of their reach.
constexpr double kTimesFarther = 4.0, kShareOfReach = 1e-9;

/// The extent of the vertices along `normal`, times its length.
double extent_along(const Vec3& normal, std::span<const Vec3> vertices) {
    Interval range;
    for (const Vec3& v : vertices) range.include(dot(normal, v - vertices.front()));
    return range.width();
}

}  // namespace

Vec3 loops_normal(std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends) {
    Vec3 sum;
    const Vec3 origin = vertices.front();
    std::size_t first = 0;
    for (std::size_t k = 0; k < std::max<std::size_t>(loop_ends.size(), 1); ++k) {
        const std::size_t end = loop_ends.empty() ? vertices.size() : loop_ends[k];
        for (std::size_t i = first; i < end; ++i) {
            const Vec3& next = vertices[i + 1 < end ? i + 1 : first];
            sum += cross(vertices[i] - origin, next - origin);
        }
        first = end;
    }
    return sum;
}

Vec3 largest_triangle(std::span<const Vec3> vertices) {
    const Vec3 origin = vertices.front();
    Vec3 farthest, largest;
    for (const Vec3& v : vertices) {
        if (length_squared(v - origin) > length_squared(farthest)) farthest = v - origin;
    }
    for (const Vec3& v : vertices) {
        const Vec3 area = cross(farthest, v - origin);
        if (length_squared(area) > length_squared(largest)) largest = area;
    }
    return largest;
}

Vec3 plane_normal(std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends) {
    const Vec3 newell = loops_normal(vertices, loop_ends);
    const Vec3 spanned = largest_triangle(vertices);
    // A sum as long as that is not due to vertices off the plane.
    const double own = length(newell), wide = length(spanned);
    if (own >= wide) return newell;
    double reach = 0.0;
    for (const Vec3& v : vertices) reach = std::max(reach, length(v - vertices.front()));
    const double allowed =
        kTimesFarther * extent_along(spanned, vertices) + kShareOfReach * reach * wide;
    if (own > 0.0 && extent_along(newell, vertices) / own < allowed / wide) return newell;
    return dot(newell, spanned) < 0.0 ? -spanned : spanned;
}

}  // namespace alhazen
