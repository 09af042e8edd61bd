#include "alhazen/shapes/polygons/polygon.h"

#include <algorithm>
#include <array>
#include <bit>

#include "alhazen/geometry/polygon/plane_normal.h"
#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/polygons/polygon_cells.h"
#include "alhazen/shapes/polygons/polygon_sides.h"

namespace alhazen {

namespace {

constexpr double kLeastQuotient = 1e-280;

/// True if every edge occurs an even number of times: by the odd-even rule nothing is inside.
bool edges_cancel(const Polygon& polygon) {
    using Edge = std::array<double, 6>;
    std::vector<Edge> edges;
    std::size_t first = 0;
    for (const std::size_t end : polygon.loop_ends) {
        for (std::size_t i = first; i < end; ++i) {
            const Vec3& a = polygon.vertices[i];
            const Vec3& b = polygon.vertices[i + 1 < end ? i + 1 : first];
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

/// Sums differences from the first vertex: exact for a plane along two axes.
Vec3 mean_vertex(const std::vector<Vec3>& vertices) {
    Vec3 sum;
    for (const Vec3& v : vertices) sum += v - vertices.front();
    return vertices.front() + sum / static_cast<double>(vertices.size());
}

Vec3 first_edge_direction(const Polygon& polygon) {
    for (std::size_t i = 1; i < polygon.vertices.size(); ++i) {
        const Vec3 edge = polygon.vertices[i] - polygon.vertices.front();
        const Vec3 in_plane = edge - dot(edge, polygon.normal) * polygon.normal;
        if (length_squared(in_plane) > 1e-12 * length_squared(edge)) {
            return unit_or(in_plane, perpendicular(polygon.normal));
        }
    }
    return perpendicular(polygon.normal);
}

/// A polygon's vertices in the sheared space of a ray.
class ShearedPolygon {
  public:
    ShearedPolygon(const Polygon& polygon, const Ray& ray)
        : polygon_(polygon), origin_(ray.origin), shear_(ray.direction) {}

    /// Odd-even rule around the ray.
    [[nodiscard]] bool surrounds_ray() const {
        bool inside = false;
        std::size_t first = 0;
        for (const std::size_t end : polygon_.loop_ends) {
            inside ^= polygon_.cells ? crossed_of_many(first, end) : crossed_of_few(first, end);
            first = end;
        }
        return inside;
    }

  private:
    [[nodiscard]] ShearedVertex<double> vertex(std::size_t i) const {
        const Vec3& p = polygon_.vertices.data()[i];
        return sheared<double>(p[shear_.kx], p[shear_.ky], p[shear_.kz], origin_[shear_.kx],
                               origin_[shear_.ky], origin_[shear_.kz], shear_.sx, shear_.sy);
    }
    /// True if an edge, whose ends lie on different sides, crosses the positive x axis; usually
    /// decided by the signs of x.
    [[nodiscard]] static bool crosses(const ShearedVertex<double>& a,
                                      const ShearedVertex<double>& b) {
        if (a.x > 0.0 && b.x > 0.0) return true;
        if (a.x < 0.0 && b.x < 0.0) return false;
        return (resolved_edge_sign(a, b) > 0) == (b.y > 0.0);
    }
    /// Whether an odd number of the edges of a loop crosses the positive x axis.
    [[nodiscard]] bool crossed_of_few(std::size_t first, std::size_t end) const {
        bool odd = false;
        bool before = vertex(end - 1).y > 0.0;
        for (std::size_t i = first; i < end; ++i) {
            // Computes only y for most edges.
            const bool here = vertex(i).y > 0.0;
            if (before != here) odd ^= crosses(vertex(i > first ? i - 1 : end - 1), vertex(i));
            before = here;
        }
        return odd;
    }
    [[nodiscard]] bool crossed_of_many(std::size_t first, std::size_t end) const {
        const SideRay ray{shear_.kz, origin_[shear_.ky], origin_[shear_.kz], shear_.sy};
        bool odd = false;
        std::uint64_t before = vertex(end - 1).y > 0.0;
        for (std::size_t at = first; at < end; at += kMostSides) {
            const std::size_t count = std::min(end - at, kMostSides);
            const std::uint64_t above =
                corners_above(std::span(polygon_.vertices).subspan(at, count), ray);
            std::uint64_t changes = above ^ (above << 1 | before);
            changes &= ~std::uint64_t{0} >> (kMostSides - count);
            before = above >> (count - 1) & 1;
            for (; changes != 0; changes &= changes - 1) {
                const std::size_t i = at + static_cast<std::size_t>(std::countr_zero(changes));
                odd ^= crosses(vertex(i > first ? i - 1 : end - 1), vertex(i));
            }
        }
        return odd;
    }

    const Polygon& polygon_;
    const Vec3& origin_;
    RayShear shear_;
};

/// Where the cells place a ray that meets the plane at t; NearEdge: `ShearedPolygon` decides.
/// `size`: as in `intersect`.
///
/// The sheared vertices of ShearedPolygon are those that the ray sees at points within e1 =
/// gamma_4 (|point - o| + R) of the vertices along each axis, R the reach of the bounds. Such a
/// point is within off_plane + gamma_6 R + 2 e1 of the plane, and moves by that over the cosine
/// times d along the ray. The crossing at t is off by gamma_16 (size_x + size_y + size_z) over the
/// cosine times d, and by the rounding of o + t d. Together that is less than along_ray |d| /
/// |cosine| and what `room` has less than the margin, even if the cosine is off by half; where it
/// is off by more, the former exceeds the margin along one of the axes. While point and edges are
/// off by less than the margin no edge passes over the point, so that the number of edges on one
/// side of it keeps its parity.
PolygonCells::Place place_in_cells(const Polygon& polygon, const Ray& ray, double t, double cosine,
                                   const Vec3& size) {
    const PolygonCells& cells = *polygon.cells;
    const double slack = gamma_bound(16) * (size.x + size.y + size.z + cells.reach());
    const double along_ray = PolygonCells::kAlongRay * (polygon.off_plane + slack);
    double at[2];
    for (std::size_t k = 0; k < 2; ++k) {
        const int axis = cells.axes()[k];
        const double o = ray.origin[axis], d = ray.direction[axis];
        at[k] = o + t * d;
        const double room =
            cells.margin()[k] - PolygonCells::kAcross * (slack + gamma_bound(16) * std::abs(o));
        const double across = room * std::abs(cosine);
        // Written so that NaN is near an edge.
        if (!(along_ray * std::abs(d) <= across && across > PolygonCells::kLeastRoom)) {
            return PolygonCells::Place::NearEdge;
        }
    }
    if (!(std::abs(cosine) > PolygonCells::kLeastCosine)) return PolygonCells::Place::NearEdge;
    return cells.place_of(at[0], at[1]);
}

/// The part of the line in the slabs of `box` along the axes whose bits are set.
Interval range_in_box(const Ray& ray, const Box3& box, std::uint32_t axes) {
    Interval range{-kInfinity, kInfinity};
    for (int k = 0; k < 3; ++k) {
        const double d = ray.direction[k];
        if ((axes >> k & 1) == 0 || d == 0.0) continue;
        range.lo = std::max(range.lo, ((d > 0.0 ? box.lo[k] : box.hi[k]) - ray.origin[k]) / d);
        range.hi = std::min(range.hi, ((d > 0.0 ? box.hi[k] : box.lo[k]) - ray.origin[k]) / d);
    }
    return range;
}

/// Clamps `t` to the range where the line is in `box`. For a ray nearly in the polygon's plane t is
/// mostly rounding; this keeps the hit on the polygon. `near_faces`: along the other axes the line
/// is in the box at t for certain, by more than the quotients are off.
double clamped_to_box(double t, const Ray& ray, const Box3& box, std::uint32_t near_faces) {
    const Interval near = range_in_box(ray, box, near_faces);
    if (near.lo < t && t <= near.hi) return t;
    const auto [lo, hi] = range_in_box(ray, box, 7);
    if (!(lo <= hi)) return 0.5 * lo + 0.5 * hi;
    return t > lo ? std::min(t, hi) : lo;  // NaN (edge on) becomes lo
}

}  // namespace

void Polygon::prepare() {
    if (loop_ends.empty()) loop_ends = {static_cast<std::uint32_t>(vertices.size())};
    normal = unit_or(plane_normal(vertices, loop_ends), {0, 0, 1});
    point = mean_vertex(vertices);
    u_axis = first_edge_direction(*this);
    bounds = {};
    off_plane = 0.0;
    for (const Vec3& v : vertices) {
        const double distance = dot(normal, v - point);
        bounds.include(v);
        bounds.include(v - distance * normal);
        off_plane = std::max(off_plane, std::abs(distance));
    }
    bounds = padded(bounds, gamma_bound(16));
    cells = PolygonCells::make(vertices, loop_ends, normal, bounds);
}

void Polygon::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    for (const Vec3& v : vertices) {
        checks.point("each vertex", v);
        if (!checks.ok()) return;
    }
    const auto count = vertices.size();
    Polygon loops{.vertices = {}, .loop_ends = loop_ends};
    if (loop_ends.empty()) loops.loop_ends = {static_cast<std::uint32_t>(count)};
    std::size_t first = 0;
    for (const std::size_t end : loops.loop_ends) {
        if (end > count || end < first + 3) {
            checks.fail(
                "each loop needs three vertices or more, and its end must lie past the one before");
            return;
        }
        first = end;
    }
    if (first != count) checks.fail("the last loop must end at the last vertex");
    if (!checks.ok()) return;
    loops.vertices = vertices;
    Box3 box;
    for (const Vec3& v : vertices) box.include(v);
    const double size = max_component(box.size());
    const double least = 1e-14 * size * size;
    if (max_component(abs(loops_normal(vertices, loops.loop_ends))) > least) return;
    const double spanned = max_component(abs(largest_triangle(vertices)));
    if (!(spanned > least) || edges_cancel(loops)) checks.fail("the vertices enclose no area");
}

Box3 Polygon::box() const {
    return bounds;
}

Interval Polygon::extent(const Vec3& axis) const {
    Interval range;
    const double foot = dot(axis, normal);
    Vec3 reach = abs(point);
    for (const Vec3& v : vertices) {
        const double at_vertex = dot(axis, v);
        range.include(at_vertex);
        range.include(at_vertex - dot(normal, v - point) * foot);
        const Vec3 m = abs(v);
        reach = {std::max(reach.x, m.x), std::max(reach.y, m.y), std::max(reach.z, m.z)};
    }
    const double pad = gamma_bound(16) * dot(abs(axis), reach);
    return {range.lo - pad, range.hi + pad};
}

int Polygon::intersect(const Ray& ray, ShapeHit* hits) const {
    const Vec3 to_plane = point - ray.origin;
    const double cosine = dot(normal, ray.direction);
    const double t = dot(normal, to_plane) / cosine;
    // Bound of the error of t: by rounding, and by vertices off the plane. Both tests with it only
    // cull, and never reject a hit; the sheared test below is exact.
    const Vec3 size = abs(to_plane) + std::abs(t) * abs(ray.direction);
    const double t_slack =
        (off_plane + gamma_bound(16) * (size.x + size.y + size.z)) / std::abs(cosine);
    if (t + t_slack < ray.t_min || t - t_slack > ray.t_max) return 0;
    // Quotients that underflow may be off by more.
    std::uint32_t near_faces = std::abs(t) > kLeastQuotient ? 0 : 7;
    for (int k = 0; k < 3; ++k) {
        const double p = ray.origin[k] + t * ray.direction[k];
        const double slack = t_slack * std::abs(ray.direction[k]) +
                             gamma_bound(16) * (std::abs(ray.origin[k]) + size[k]);
        if (p + slack < bounds.lo[k] || p - slack > bounds.hi[k]) return 0;
        const bool from_low = bounds.lo[k] < p - slack, from_high = p + slack < bounds.hi[k];
        const bool within = from_low & from_high;  // no branch
        near_faces |= std::uint32_t{!within} << k;
    }
    // Most rays that start this near to the polygon leave it.
    if (!ray.covers(t) && !ray.covers(clamped_to_box(t, ray, bounds, near_faces))) return 0;
    const PolygonCells::Place place =
        cells ? place_in_cells(*this, ray, t, cosine, size) : PolygonCells::Place::NearEdge;
    if (place == PolygonCells::Place::Outside) return 0;
    if (place == PolygonCells::Place::NearEdge && !ShearedPolygon(*this, ray).surrounds_ray()) {
        return 0;
    }
    return report_crossing(ray, {clamped_to_box(t, ray, bounds, near_faces), 0, 0, 0}, hits);
}

ShapeSurface Polygon::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = surface_on_plane(ray.at(hit.t), point, normal);
    const Vec3 offset = surface.point - vertices.front();
    surface.dpdu = u_axis;
    surface.dpdv = cross(normal, u_axis);
    surface.uv = {dot(offset, u_axis), dot(offset, surface.dpdv)};
    return surface;
}

}  // namespace alhazen
