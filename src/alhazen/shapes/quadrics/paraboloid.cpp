#include "alhazen/shapes/quadrics/paraboloid.h"

#include "alhazen/shapes/quadrics/ellipsoid.h"

namespace alhazen {

void Paraboloid::prepare() {
    solid.frame = SolidFrame(apex, Mat3{axis_a, axis_b, rim - apex});
    QuadricForm form;
    form.zz = 0.0;
    form.z = -0.5;
    form.c = 0.0;
    solid.quadric = QuadricLine(form, 1.5);
    // Does not clip below the apex, where every line is outside.
    solid.clip_box.lo.z = -1.0 / 16;
    solid.clip_box.hi.z = 1.0;
    solid.capped = capped;
}

void Paraboloid::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, rim - apex}, "axis_a", "axis_b", "rim - apex");
}

Interval Paraboloid::extent(const Vec3& axis) const {
    const Vec3 along = rim - apex;
    const double up = dot(axis, along);
    const double across = std::hypot(dot(axis, axis_a), dot(axis, axis_b));
    // The maximum of up * r^2 + across * r for r in [0, 1].
    const auto highest = [&](double rise) {
        const double at_rim = rise + across;
        if (rise < 0.0 && across < -2.0 * rise) return across * across / (-4.0 * rise);
        return std::fmax(0.0, at_rim);
    };
    const double middle = dot(axis, apex);
    const double slack =
        gamma_bound(32) * dot(abs(axis), abs(apex) + abs(rim) + abs(axis_a) + abs(axis_b));
    return {middle - highest(-up) - slack, middle + highest(up) + slack};
}

Box3 Paraboloid::box() const {
    const Interval x = extent({1, 0, 0}), y = extent({0, 1, 0}), z = extent({0, 0, 1});
    return {{x.lo, y.lo, z.lo}, {x.hi, y.hi, z.hi}};
}

}  // namespace alhazen
