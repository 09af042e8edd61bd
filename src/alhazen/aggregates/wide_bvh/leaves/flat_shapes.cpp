#include "alhazen/aggregates/wide_bvh/leaves/flat_shapes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "alhazen/math/constants.h"
#include "alhazen/math/unit_vector.h"

namespace alhazen {
namespace {

/// Largest number of edges along which a side of the rectangle around a polygon is tried.
constexpr std::size_t kMostEdges = 16;

/// Calls `f` with the ends of every edge, as indices.
template <class F>
void for_each_edge(std::span<const std::uint32_t> loop_ends, F&& f) {
    std::size_t first = 0;
    for (const std::size_t end : loop_ends) {
        for (std::size_t i = first; i < end; ++i) f(i, i + 1 < end ? i + 1 : first);
        first = end;
    }
}

Interval range_along(const Vec3& direction, const Polygon& polygon) {
    Interval range;
    for (const Vec3& v : polygon.vertices) range.include(dot(direction, v - polygon.point));
    return range;
}

/// How deep a point lies in the rectangle; negative outside.
double depth(const SlabPoint& p, double half_u, double half_v) {
    return std::min(half_u - std::abs(p.u), half_v - std::abs(p.v));
}

/// The largest depth of a point of an edge. The depth is concave and linear between the points
/// where an absolute value or the minimum changes.
double deepest(const SlabPoint& a, const SlabPoint& b, double half_u, double half_v) {
    double most = std::max(depth(a, half_u, half_v), depth(b, half_u, half_v));
    const auto try_at = [&](double from, double to) {
        if (!(std::min(from, to) < 0.0 && std::max(from, to) > 0.0)) return;
        const double at = from / (from - to);
        const SlabPoint p{a.u + at * (b.u - a.u), a.v + at * (b.v - a.v)};
        most = std::max(most, depth(p, half_u, half_v));
    };
    try_at(a.u, b.u);
    try_at(a.v, b.v);
    for (const double su : {-1.0, 1.0}) {
        for (const double sv : {-1.0, 1.0}) {
            const auto difference = [&](const SlabPoint& p) {
                return half_u - su * p.u - (half_v - sv * p.v);
            };
            try_at(difference(a), difference(b));
        }
    }
    return most;
}

/// Whether the middle is inside, by crossings of the positive u axis and the odd-even rule.
bool holds_middle(std::span<const SlabPoint> corners, std::span<const std::uint32_t> loop_ends) {
    bool inside = false;
    for_each_edge(loop_ends, [&](std::size_t i, std::size_t k) {
        const SlabPoint &a = corners[i], &b = corners[k];
        if ((a.v > 0.0) == (b.v > 0.0)) return;
        inside ^= a.u + a.v / (a.v - b.v) * (b.u - a.u) > 0.0;
    });
    return inside;
}

}  // namespace

FlatOutline flat_outline(const PrimitiveTable& table, PrimitiveId id) {
    const std::uint32_t kind = table.kind(id);
    if (kind == column_of<Polygon>()) {
        const Polygon& p = std::get<ShapeColumn<Polygon>>(table.columns).shapes[table.index(id)];
        return {p.vertices, p.loop_ends};
    }
    if (kind == column_of<Rectangle>()) {
        const Rectangle& r =
            std::get<ShapeColumn<Rectangle>>(table.columns).shapes[table.index(id)];
        const Vec3 far = r.corner + r.edge_u + r.edge_v;
        return {{r.corner, r.corner + r.edge_u, far, r.corner + r.edge_v}, {4}};
    }
    return {};
}

SlantedBounds bounds_of(const Polygon& polygon) {
    const Vec3& normal = polygon.normal;
    // The hit lies in the plane of `point`.
    Interval across = range_along(normal, polygon);
    across.include(0.0);
    double least = kInfinity;
    Vec3 u_axis, v_axis;
    Interval u, v;
    const auto attempt = [&](const Vec3& along) {
        const Vec3 aside = cross(normal, along);
        const Interval here_u = range_along(along, polygon), here_v = range_along(aside, polygon);
        const double area = (here_u.hi - here_u.lo) * (here_v.hi - here_v.lo);
        if (!(area < least)) return;
        least = area;
        u_axis = along;
        v_axis = aside;
        u = here_u;
        v = here_v;
    };
    // Of an edge along the normal only rounding is left in the plane: no direction across it.
    constexpr double kLeastShare = 1e-12;  // squared
    const std::size_t step = (polygon.vertices.size() + kMostEdges - 1) / kMostEdges;
    for_each_edge(polygon.loop_ends, [&](std::size_t a, std::size_t b) {
        if (a % step != 0) return;
        const Vec3 edge = polygon.vertices[b] - polygon.vertices[a];
        const Vec3 in_plane = edge - dot(edge, normal) * normal;
        if (!(length_squared(in_plane) > kLeastShare * length_squared(edge))) return;
        attempt(unit_or(in_plane, polygon.u_axis));
    });
    if (!(least < kInfinity)) attempt(polygon.u_axis);
    SlantedBounds bounds;
    bounds.corner = polygon.point + u.lo * u_axis + v.lo * v_axis + across.lo * normal;
    bounds.edge[0] = (u.hi - u.lo) * u_axis;
    bounds.edge[1] = (v.hi - v.lo) * v_axis;
    bounds.edge[2] = (across.hi - across.lo) * normal;
    bounds.direction[0] = u_axis;
    bounds.direction[1] = v_axis;
    bounds.direction[2] = normal;
    bounds.flat = true;
    return bounds;
}

double inset_of(std::span<const SlabPoint> corners, std::span<const std::uint32_t> loop_ends,
                double half_u, double half_v) {
    double inset = 0;
    for_each_edge(loop_ends, [&](std::size_t i, std::size_t k) {
        inset = std::max(inset, deepest(corners[i], corners[k], half_u, half_v));
    });
    // Where the middle is near an edge the rectangle is empty, whatever side it is on.
    return inset < std::min(half_u, half_v) && holds_middle(corners, loop_ends) ? inset : kInfinity;
}

double inner_radius_of(std::span<const SlabPoint> corners,
                       std::span<const std::uint32_t> loop_ends) {
    if (!holds_middle(corners, loop_ends)) return 0;
    double least = kInfinity;  // squared
    for_each_edge(loop_ends, [&](std::size_t i, std::size_t k) {
        const SlabPoint &a = corners[i], &b = corners[k];
        const double u = b.u - a.u, v = b.v - a.v, length = u * u + v * v;
        const double at = length > 0 ? -(a.u * u + a.v * v) / length : 0.0;
        const double nearest = std::clamp(at, 0.0, 1.0);
        const double pu = a.u + nearest * u, pv = a.v + nearest * v;
        least = std::min(least, pu * pu + pv * pv);
    });
    return std::sqrt(least);
}

}  // namespace alhazen
