#include "alhazen/shapes/quadrics/hyperboloid.h"

#include "alhazen/shapes/quadrics/ellipsoid.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"

namespace alhazen {

void Hyperboloid::prepare() {
    solid.frame = SolidFrame(0.5 * base + 0.5 * top, Mat3{axis_a, axis_b, 0.5 * top - 0.5 * base});
    QuadricForm form;
    form.zz = -(1.0 - waist) * (1.0 + waist);
    form.c = -waist * waist;
    solid.quadric = QuadricLine(form, 1.5);
    solid.clip_box.lo.z = -1.0;
    solid.clip_box.hi.z = 1.0;
    solid.capped = capped;
    solid.v_range = {-1, 1};
}

void Hyperboloid::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, top - base}, "axis_a", "axis_b", "top - base");
    if (!(waist >= 1e-6 && waist <= 1.0 - 1e-6)) {
        checks.fail("waist must be a number between 0 and 1");
    }
}

// The surface lies within the hull of its rims' ellipses.

Box3 Hyperboloid::box() const {
    Box3 box = ellipse_box(base, axis_a, axis_b);
    box.include(ellipse_box(top, axis_a, axis_b));
    return box;
}

Interval Hyperboloid::extent(const Vec3& axis) const {
    return hull(ellipse_extent(axis, base, axis_a, axis_b),
                ellipse_extent(axis, top, axis_a, axis_b));
}

}  // namespace alhazen
