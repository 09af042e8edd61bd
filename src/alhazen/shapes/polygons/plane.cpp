#include "alhazen/shapes/polygons/plane.h"

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Plane::prepare() {
    unit_normal = unit_or(normal, {0, 0, 1});
    u_axis = perpendicular(unit_normal);
}

void Plane::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
}

Box3 Plane::box() const {
    Box3 box{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
    for (int k = 0; k < 3; ++k) {
        if (normal[k == 2 ? 0 : k + 1] != 0.0 || normal[k == 0 ? 2 : k - 1] != 0.0) continue;
        const double pad = gamma_bound(16) * std::abs(point[k]);
        box.lo[k] = point[k] - pad;
        box.hi[k] = point[k] + pad;
    }
    return box;
}

Interval Plane::extent(const Vec3& axis) const {
    // Bounded only along the normal; the test for parallel directions is exact.
    if (accurate_cross(axis, normal) != Vec3{}) return {-kInfinity, kInfinity};
    return outward_extent(axis, point, 0.0);
}

int Plane::intersect(const Ray& ray, ShapeHit* hits) const {
    return report_crossing(ray, {plane_crossing(ray, point, unit_normal), 0, 0, 0}, hits);
}

ShapeSurface Plane::surface(const Ray& ray, const ShapeHit& hit) const {
    ShapeSurface surface = surface_on_plane(ray.at(hit.t), point, unit_normal);
    const Vec3 offset = surface.point - point;
    surface.dpdu = u_axis;
    surface.dpdv = cross(unit_normal, u_axis);
    surface.uv = {dot(offset, u_axis), dot(offset, surface.dpdv)};
    return surface;
}

}  // namespace alhazen
