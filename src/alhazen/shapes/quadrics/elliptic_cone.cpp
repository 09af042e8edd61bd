#include "alhazen/shapes/quadrics/elliptic_cone.h"

#include "alhazen/shapes/quadrics/ellipsoid.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"

namespace alhazen {

void EllipticCone::prepare() {
    solid.frame = SolidFrame(base, Mat3{axis_a, axis_b, top - base});
    const double slope = top_scale - 1.0;
    QuadricForm form;
    form.zz = -slope * slope;
    form.z = -slope;
    solid.quadric = QuadricLine(form, 1.0 + std::fmax(1.0, top_scale));
    solid.clip_box.lo.z = 0.0;
    solid.clip_box.hi.z = 1.0;
    solid.capped = capped;
}

void EllipticCone::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, top - base}, "axis_a", "axis_b", "top - base");
    if (!(top_scale >= 0.0 && top_scale <= 1e6)) {
        checks.fail("top_scale must be a number from 0 to 1e6");
    }
}

Box3 EllipticCone::box() const {
    Box3 box = ellipse_box(base, axis_a, axis_b);
    box.include(ellipse_box(top, top_scale * axis_a, top_scale * axis_b));
    return box;
}

Interval EllipticCone::extent(const Vec3& axis) const {
    return hull(ellipse_extent(axis, base, axis_a, axis_b),
                ellipse_extent(axis, top, top_scale * axis_a, top_scale * axis_b));
}

}  // namespace alhazen
