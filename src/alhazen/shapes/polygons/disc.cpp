#include "alhazen/shapes/polygons/disc.h"

#include <cmath>

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Disc::prepare() {
    unit_normal = unit_or(normal, {0, 0, 1});
    u_axis = perpendicular(unit_normal);
}

void Disc::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!(inner_radius < radius)) checks.fail("inner_radius must be less than radius");
}

Box3 Disc::box() const {
    return outward_box(center, circle_half_box(unit_normal, radius));
}

Interval Disc::extent(const Vec3& axis) const {
    return outward_extent(axis, center, radius * length(accurate_cross(axis, unit_normal)));
}

int Disc::intersect(const Ray& ray, ShapeHit* hits) const {
    const double t = plane_crossing(ray, center, unit_normal);
    if (!std::isfinite(t)) return 0;
    // Relative to the centre: more accurate for a disc far from the origin.
    const double squared = length_squared((ray.origin - center) + t * ray.direction);
    if (!(squared <= radius * radius && squared >= inner_radius * inner_radius)) return 0;
    return report_crossing(ray, {t, 0, 0, 0}, hits);
}

ShapeSurface Disc::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = surface_on_plane(ray.at(hit.t), center, unit_normal);
    const Vec3 offset = surface.point - center;
    const double v = (length(offset) - inner_radius) / (radius - inner_radius);
    surface.uv = {turn_fraction(dot(offset, u_axis), dot(offset, cross(unit_normal, u_axis))),
                  std::fmin(1.0, std::fmax(0.0, v))};
    surface.dpdu = (2.0 * kPi) * cross(unit_normal, offset);
    surface.dpdv = (radius - inner_radius) * unit_or(offset, u_axis);
    return surface;
}

}  // namespace alhazen
