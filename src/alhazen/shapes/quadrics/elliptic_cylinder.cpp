#include "alhazen/shapes/quadrics/elliptic_cylinder.h"

#include "alhazen/shapes/quadrics/ellipsoid.h"

namespace alhazen {

Box3 ellipse_box(const Vec3& center, const Vec3& a, const Vec3& b) {
    return outward_box(center, {std::hypot(a.x, b.x), std::hypot(a.y, b.y), std::hypot(a.z, b.z)});
}

Interval ellipse_extent(const Vec3& axis, const Vec3& center, const Vec3& a, const Vec3& b) {
    // The rounding of the dot products is relative to their terms.
    const double slack = gamma_bound(4) * (dot(abs(axis), abs(a)) + dot(abs(axis), abs(b)));
    return outward_extent(axis, center, std::hypot(dot(axis, a), dot(axis, b)) + slack);
}

void EllipticCylinder::prepare() {
    solid.frame = SolidFrame(base, Mat3{axis_a, axis_b, top - base});
    QuadricForm form;
    form.zz = 0.0;
    solid.quadric = QuadricLine(form, 1.5);
    solid.clip_box.lo.z = 0.0;
    solid.clip_box.hi.z = 1.0;
    solid.capped = capped;
}

void EllipticCylinder::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, top - base}, "axis_a", "axis_b", "top - base");
}

Box3 EllipticCylinder::box() const {
    Box3 box = ellipse_box(base, axis_a, axis_b);
    box.include(ellipse_box(top, axis_a, axis_b));
    return box;
}

Interval EllipticCylinder::extent(const Vec3& axis) const {
    return hull(ellipse_extent(axis, base, axis_a, axis_b),
                ellipse_extent(axis, top, axis_a, axis_b));
}

}  // namespace alhazen
