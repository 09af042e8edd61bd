#include "alhazen/shapes/polygons/rectangle.h"

#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Rectangle::prepare() {
    const Vec3 n = accurate_cross(edge_u, edge_v);
    const double squared = length_squared(n);
    unit_normal = unit_or(n, {0, 0, 1});
    u_of = accurate_cross(edge_v, n) / squared;
    v_of = accurate_cross(n, edge_u) / squared;
}

void Rectangle::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!checks.ok()) return;
    const double area = length(accurate_cross(edge_u, edge_v));
    if (!(area >= 1e-12 * length(edge_u) * length(edge_v))) {
        checks.fail("edge_u and edge_v must not be parallel");
    }
}

Box3 Rectangle::box() const {
    // From the centre and half the edges: one rounding less than from four corners, and symmetric.
    return outward_box(corner + 0.5 * edge_u + 0.5 * edge_v,
                       0.5 * abs(edge_u) + 0.5 * abs(edge_v) + gamma_bound(4) * abs(corner));
}

Interval Rectangle::extent(const Vec3& axis) const {
    const double half = 0.5 * std::abs(dot(axis, edge_u)) + 0.5 * std::abs(dot(axis, edge_v));
    const Vec3 terms = abs(corner) + abs(edge_u) + abs(edge_v);
    return outward_extent(axis, corner + 0.5 * edge_u + 0.5 * edge_v,
                          half + gamma_bound(8) * dot(abs(axis), terms));
}

int Rectangle::intersect(const Ray& ray, ShapeHit* hits) const {
    const double t = plane_crossing(ray, corner, unit_normal);
    if (!ray.covers(t) || !std::isfinite(t)) return 0;
    const Vec3 offset = (ray.origin - corner) + t * ray.direction;
    const double u = dot(u_of, offset);
    const double v = dot(v_of, offset);
    if (!(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) return 0;
    return report_crossing(ray, {t, u, v, 0}, hits);
}

ShapeSurface Rectangle::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = surface_on_plane(ray.at(hit.t), corner, unit_normal);
    surface.uv = {hit.u, hit.v};
    surface.dpdu = edge_u;
    surface.dpdv = edge_v;
    return surface;
}

}  // namespace alhazen
