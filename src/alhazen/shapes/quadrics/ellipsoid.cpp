#include "alhazen/shapes/quadrics/ellipsoid.h"

namespace alhazen {

void check_axes(FieldChecks& checks, const Mat3& axes, const char* x, const char* y,
                const char* z) {
    checks.vector(x, axes.x_axis);
    checks.vector(y, axes.y_axis);
    checks.vector(z, axes.z_axis);
    if (!checks.ok()) return;
    const Vec3 a = unit_or(axes.x_axis, {}), b = unit_or(axes.y_axis, {});
    const Vec3 c = unit_or(axes.z_axis, {});
    if (!(std::abs(dot(a, cross(b, c))) >= 1e-6)) {
        checks.fail(std::string(x) + ", " + y + " and " + z + " must not lie in one plane");
    }
}

void Ellipsoid::prepare() {
    solid.frame = SolidFrame(center, Mat3{axis_a, axis_b, axis_c});
    solid.quadric = QuadricLine(QuadricForm{}, 1.0);
    solid.v_kind = ClippedQuadric::V::Latitude;
}

void Ellipsoid::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    check_axes(checks, {axis_a, axis_b, axis_c}, "axis_a", "axis_b", "axis_c");
}

Box3 Ellipsoid::box() const {
    const auto half = [&](int k) {
        return std::hypot(std::hypot(axis_a[k], axis_b[k]), axis_c[k]);
    };
    return outward_box(center, {half(0), half(1), half(2)});
}

Interval Ellipsoid::extent(const Vec3& axis) const {
    const double half =
        std::hypot(std::hypot(dot(axis, axis_a), dot(axis, axis_b)), dot(axis, axis_c));
    return outward_extent(axis, center, half);
}

int Ellipsoid::intersect(const Ray& ray, ShapeHit* hits) const {
    return solid.intersect(ray, hits);
}

ShapeSurface Ellipsoid::surface(const Ray& ray, const ShapeHit& hit) const {
    return solid.surface(ray, hit);
}

}  // namespace alhazen
