#include "alhazen/geometry/polygon/polygon_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "alhazen/math/interval.h"

namespace alhazen {

namespace {

/// Newell's normal is dropped where the corners are this many times farther off its plane than off
/// that of their largest triangle, and farther than that share of their reach.
constexpr double kTimesFarther = 4.0, kShareOfReach = 1e-9;

/// The corners of a loop of indices.
struct IndexedCorners {
    std::span<const Vec3> positions;
    std::span<const std::uint32_t> polygon;
    [[nodiscard]] std::size_t size() const { return polygon.size(); }
    [[nodiscard]] const Vec3& operator[](std::size_t k) const { return positions[polygon[k]]; }
};

/// Of the triangles of the first corner and the one farthest from it, twice the vector area of the
/// largest.
template <class Corners>
Vec3 largest_of(const Corners& corners) {
    const Vec3 origin = corners[0];
    Vec3 farthest, largest;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 offset = corners[k] - origin;
        if (length_squared(offset) > length_squared(farthest)) farthest = offset;
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec3 area = cross(farthest, corners[k] - origin);
        if (length_squared(area) > length_squared(largest)) largest = area;
    }
    return largest;
}

/// The extent of the corners along `normal`, times its length.
template <class Corners>
double extent_along(const Vec3& normal, const Corners& corners) {
    Interval range;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        range.include(dot(normal, corners[k] - corners[0]));
    }
    return range.width();
}

/// Newell's normal or that of the largest triangle.
template <class Corners>
Vec3 chosen_normal(const Vec3& newell, const Corners& corners) {
    const Vec3 spanned = largest_of(corners);
    // A sum as long as that is not due to corners off the plane.
    const double own = length(newell), wide = length(spanned);
    if (own >= wide) return newell;
    double reach = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        reach = std::max(reach, length(corners[k] - corners[0]));
    }
    const double allowed =
        kTimesFarther * extent_along(spanned, corners) + kShareOfReach * reach * wide;
    if (own > 0.0 && extent_along(newell, corners) / own < allowed / wide) return newell;
    return dot(newell, spanned) < 0.0 ? -spanned : spanned;
}

}  // namespace

Vec3 newell_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
    const Vec3 origin = positions[polygon[0]];
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += cross(positions[polygon[i]] - origin, positions[polygon[i + 1]] - origin);
    }
    return sum;
}

Vec3 newell_normal_of_loops(std::span<const Vec3> vertices,
                            std::span<const std::uint32_t> loop_ends) {
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

Vec3 plane_normal(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
    return chosen_normal(newell_normal(positions, polygon), IndexedCorners{positions, polygon});
}

Vec3 plane_normal_of_loops(std::span<const Vec3> vertices,
                           std::span<const std::uint32_t> loop_ends) {
    return chosen_normal(newell_normal_of_loops(vertices, loop_ends), vertices);
}

Vec3 largest_triangle(std::span<const Vec3> vertices) {
    return largest_of(vertices);
}

bool edges_cancel(std::span<const Vec3> vertices, std::span<const std::uint32_t> loop_ends) {
    using Edge = std::array<double, 6>;
    std::vector<Edge> edges;
    std::size_t first = 0;
    for (const std::size_t end : loop_ends) {
        for (std::size_t i = first; i < end; ++i) {
            const Vec3& a = vertices[i];
            const Vec3& b = vertices[i + 1 < end ? i + 1 : first];
            edges.push_back(
                std::min(Edge{a.x, a.y, a.z, b.x, b.y, b.z}, Edge{b.x, b.y, b.z, a.x, a.y, a.z}));
        }
        first = end;
    }
    std::sort(edges.begin(), edges.end());
    for (auto run = edges.begin(); run != edges.end();) {
        const auto next = std::upper_bound(run, edges.end(), *run);
        if ((next - run) % 2 != 0) return false;
        run = next;
    }
    return true;
}

bool is_flat(std::span<const Vec3> vertices, const Vec3& unit_normal) {
    constexpr double kMostOff = 1e-4;
    double reach = 0.0, off = 0.0;
    for (const Vec3& p : vertices) {
        const Vec3 d = p - vertices.front();
        reach = std::max(reach, max_component(abs(d)));
        off = std::max(off, std::abs(dot(unit_normal, d)));
    }
    return off <= kMostOff * reach;
}

}  // namespace alhazen
