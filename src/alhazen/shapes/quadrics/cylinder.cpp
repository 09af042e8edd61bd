#include "alhazen/shapes/quadrics/cylinder.h"

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Cylinder::prepare() {
    frustum = Frustum(base, top, radius, radius);
}

void Cylinder::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (checks.ok()) checks.length("distance from base to top", length(top - base));
}

Box3 Cylinder::box() const {
    return frustum.box();
}
Interval Cylinder::extent(const Vec3& axis) const {
    return frustum.extent(axis);
}

int Cylinder::intersect(const Ray& ray, ShapeHit* hits) const {
    return frustum.intersect(ray, capped, hits);
}

ShapeSurface Cylinder::surface(const Ray& ray, const ShapeHit& hit) const {
    return frustum.surface(ray, hit);
}

}  // namespace alhazen
