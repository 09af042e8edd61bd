#include "alhazen/geometry/polygon/triangulate.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>

#include "alhazen/geometry/polygon/ear_clipper.h"
#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/sweep_triangulation.h"
#include "alhazen/math/orientation.h"

namespace alhazen {

namespace {

/// Range of coordinates in which products of two differences neither over- nor underflow.
constexpr double kSmall = 1e-100;
constexpr double kLarge = 1e100;

/// Twice the signed area of a triangle in the plane.
double cross_2d(Vec2 a, Vec2 b, Vec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The largest magnitude of a coordinate; NaN if a coordinate is not finite.
double largest_coordinate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
    double largest = 0.0;
    for (const std::uint32_t index : polygon) {
        const Vec3 size = abs(positions[index]);
        if (!is_finite(size)) return std::numeric_limits<double>::quiet_NaN();
        largest = std::max(largest, max_component(size));
    }
    return largest;
}

/// The vertices of the polygon, scaled by a power of two, which is exact.
std::vector<Vec3> scaled_to_one(std::span<const Vec3> positions,
                                std::span<const std::uint32_t> polygon, double reach) {
    const int exponent = -std::ilogb(reach);
    std::vector<Vec3> scaled;
    scaled.reserve(polygon.size());
    for (const std::uint32_t index : polygon) {
        const Vec3 p = positions[index];
        scaled.push_back(
            {std::scalbn(p.x, exponent), std::scalbn(p.y, exponent), std::scalbn(p.z, exponent)});
    }
    return scaled;
}

/// The polygon projected to the plane, counter-clockwise, with unchanged coordinates.
std::vector<Vec2> flatten(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon) {
    const Vec3 normal = plane_normal(positions, polygon);
    const int drop = dominant_axis(normal);
    const int a = (drop + 1) % 3;
    const int b = (drop + 2) % 3;
    const bool flip = normal[drop] < 0.0;
    std::vector<Vec2> flat;
    flat.reserve(polygon.size());
    for (const std::uint32_t index : polygon) {
        const Vec3& p = positions[index];
        flat.push_back(flip ? Vec2{p[b], p[a]} : Vec2{p[a], p[b]});
    }
    return flat;
}

/// Ear clipping makes better-shaped triangles and accepts any polygon; the sweep is always fast.
constexpr std::size_t kMostForEars = 1024;

/// True if the corner b is the tip of a spike or a slit without width.
bool turns_back(Vec2 a, Vec2 b, Vec2 c) {
    const Vec2 to = b - a, from = c - b;
    return to.x * from.x + to.y * from.y < 0.0 && orientation(a, b, c) == 0;
}

/// True if no corner turns right or back and the turns add up to one revolution (a star turns left
/// at every corner, but makes several revolutions).
bool is_convex(const std::vector<Vec2>& flat) {
    const std::size_t n = flat.size();
    // Relative to the first vertex: far from the origin the products would lose all digits.
    const Vec2 origin = flat[0];
    int x_changes = 0;
    double last_dx = 0.0;
    double first_dx = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 p = flat[i] - origin;
        const Vec2 q = flat[i + 1 < n ? i + 1 : 0] - origin;
        const Vec2 r = flat[i + 2 < n ? i + 2 : i + 2 - n] - origin;
        if (!(cross_2d(p, q, r) >= 0.0)) return false;
        if (turns_back(p, q, r)) return false;
        const double dx = q.x - p.x;
        if (dx == 0.0) continue;
        if (last_dx == 0.0) {
            first_dx = dx;
        } else if ((dx < 0.0) != (last_dx < 0.0)) {
            ++x_changes;
        }
        last_dx = dx;
    }
    if ((first_dx < 0.0) != (last_dx < 0.0)) ++x_changes;
    return x_changes <= 2;
}

}  // namespace

void triangulate(std::span<const Vec3> positions, std::span<const std::uint32_t> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto fan = [&] {
        for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
            triangles.push_back({polygon[0], polygon[i], polygon[i + 1]});
        }
    };
    if (polygon.size() == 3) return fan();
    const double reach = largest_coordinate(positions, polygon);
    if (!(reach > 0.0 && reach <= std::numeric_limits<double>::max())) return fan();
    std::vector<Vec2> flat;
    if (reach > kSmall && reach < kLarge) {
        flat = flatten(positions, polygon);
    } else {
        const std::vector<Vec3> scaled = scaled_to_one(positions, polygon, reach);
        std::vector<std::uint32_t> loop(polygon.size());
        std::iota(loop.begin(), loop.end(), 0u);
        flat = flatten(scaled, loop);
    }
    if (is_convex(flat)) return fan();
    std::optional<std::vector<std::array<std::uint32_t, 3>>> cut;
    if (flat.size() > kMostForEars) cut = triangulate_by_sweep(flat);
    if (!cut) cut = EarClipper(flat).clip();
    for (const auto& [a, b, c] : *cut) {
        triangles.push_back({polygon[a], polygon[b], polygon[c]});
    }
}

}  // namespace alhazen
