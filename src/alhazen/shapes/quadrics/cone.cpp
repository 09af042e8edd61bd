#include "alhazen/shapes/quadrics/cone.h"

#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen {

void Cone::prepare() {
    frustum = Frustum(base, top, base_radius, top_radius);
}

void Cone::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (base_radius == 0.0 && top_radius == 0.0) checks.fail("both radii are zero");
    if (checks.ok()) checks.length("distance from base to top", length(top - base));
}

Box3 Cone::box() const {
    return frustum.box();
}
Interval Cone::extent(const Vec3& axis) const {
    return frustum.extent(axis);
}

int Cone::intersect(const Ray& ray, ShapeHit* hits) const {
    return frustum.intersect(ray, capped, hits);
}

ShapeSurface Cone::surface(const Ray& ray, const ShapeHit& hit) const {
    return frustum.surface(ray, hit);
}

}  // namespace alhazen
