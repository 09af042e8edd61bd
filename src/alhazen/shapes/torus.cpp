#include "alhazen/shapes/torus.h"

#include "alhazen/base/instruction_sets.h"
#include "alhazen/shapes/first_hit.h"
#include "alhazen/shapes/plain_surface.h"
#include "alhazen/shapes/polynomial_solid.h"

namespace alhazen {

namespace {

/// The clip is this much larger than the torus, so that the line is outside at its ends for sure.
constexpr double kRoom = 1.0 + 1.0 / 64;

template <class Real>
Real third() {
    if constexpr (std::is_same_v<Real, double>) {
        return 1.0 / 3.0;
    } else {
        return DoubleDouble(1.0 / 3.0, 0x1.5555555555555p-56);
    }
}

/// Cuts the line to a cylinder's box around the torus. Where it is cut counts for nothing else, so
/// that products with reciprocals will do.
bool cut_around(const Vec3& o, const Vec3& d, double reach, double height, ClipRange& range) {
    const double half[] = {reach, reach, height};
    for (int k = 0; k < 3; ++k) {
        const double inverse = 1.0 / d[k];
        const double far = std::copysign(half[k], d[k]);
        // No number where the line runs within a face: there it is outside of the torus.
        const double near = (-far - o[k]) * inverse, beyond = (far - o[k]) * inverse;
        range.entry = near > range.entry ? near : range.entry;
        range.exit = beyond < range.exit ? beyond : range.exit;
    }
    if (!(range.entry < range.exit) || !std::isfinite(range.exit - range.entry)) return false;
    // Nearer to the middle than the torus reaches.
    return length_squared(cross(o, d)) <= reach * reach * length_squared(d);
}

/// (x^2 + y^2 + z^2 + k)^2 - 4 (x^2 + y^2), k = 1 - r^2.
struct TorusPolynomial {
    static constexpr int kDegree = 4;
    double r;

    template <class Real>
    [[nodiscard]] Real k() const {
        return (Real(1.0) - Real(r)) * (Real(1.0) + Real(r));
    }
    template <class Real>
    int coefficients(const Point3<Real>& p, const Point3<Real>& q, Real* b) const {
        const Real b0 = p.x * p.x + p.y * p.y;
        const Real b1 = p.x * q.x + p.y * q.y;
        const Real b2 = q.x * q.x + q.y * q.y;
        const Real a0 = b0 + p.z * p.z + k<Real>();
        const Real a1 = b1 + p.z * q.z + k<Real>();
        const Real a2 = b2 + q.z * q.z + k<Real>();
        const Real two(2.0), four(4.0);
        b[0] = a0 * a0 - four * b0;
        b[1] = a0 * a1 - two * (b0 + b1);
        b[2] = (a0 * a2 + two * (a1 * a1) - two * (b0 + four * b1 + b2)) * third<Real>();
        b[3] = a1 * a2 - two * (b1 + b2);
        b[4] = a2 * a2 - four * b2;
        return 4;
    }
    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const {
        const Real across = p.x * p.x + p.y * p.y;
        const Real a = across + p.z * p.z + k<Real>();
        return a * a - Real(4.0) * across;
    }
    [[nodiscard]] Vec3 gradient(const Vec3& p) const {
        // Of the square of the distance to the circle, times what makes it that of the quartic.
        const double across = std::hypot(p.x, p.y);
        if (!(across > 0.0)) return {0.0, 0.0, 4.0 * p.z * (p.z * p.z + k<double>())};
        const double radial = (across - 1.0) / across;
        const double other = (across + 1.0) * (across + 1.0) + p.z * p.z - r * r;
        const double own = (across - 1.0) * (across - 1.0) + p.z * p.z - r * r;
        // f = own * other.
        const Vec3 own_gradient{2.0 * p.x * radial, 2.0 * p.y * radial, 2.0 * p.z};
        const double outer = (across + 1.0) / across;
        const Vec3 other_gradient{2.0 * p.x * outer, 2.0 * p.y * outer, 2.0 * p.z};
        return other * own_gradient + own * other_gradient;
    }
    [[nodiscard]] double magnitude() const {
        const double reach = kRoom * (1.0 + r);
        const double a = 3.0 * reach * reach + 1.0;
        return a * a + 8.0 * reach * reach;
    }
    [[nodiscard]] double roundings() const { return 16.0; }
};

}  // namespace

void Torus::prepare() {
    unit_axis = unit_or(axis, {0, 0, 1});
    const Vec3 x = perpendicular(unit_axis);
    frame = SolidFrame(center, Mat3{major_radius * x, major_radius * cross(unit_axis, x),
                                    major_radius * unit_axis});
    tube = minor_radius / major_radius;
}

void Torus::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.point("center", center);
    checks.vector("axis", axis);
    checks.length("major_radius", major_radius);
    checks.length("minor_radius", minor_radius);
    if (!checks.ok()) return;
    if (minor_radius > major_radius) {
        checks.fail("minor_radius must not exceed major_radius");
    } else if (minor_radius < 1e-6 * major_radius) {
        checks.fail("minor_radius must be at least a millionth of major_radius");
    }
}

Box3 Torus::box() const {
    return outward_box(center, circle_half_box(unit_axis, major_radius) +
                                   Vec3{minor_radius, minor_radius, minor_radius});
}

Interval Torus::extent(const Vec3& direction) const {
    return outward_extent(direction, center,
                          major_radius * length(accurate_cross(direction, unit_axis)) +
                              minor_radius * length(direction));
}

namespace {

/// Cuts the line to the surroundings of the torus.
bool segment_of(const Torus& torus, const Ray& ray, ClipSegment& s) {
    const double reach = kRoom * (1.0 + torus.tube), height = kRoom * torus.tube;
    const auto cut = [&](const Vec3& o, const Vec3& d, ClipRange& range) {
        return cut_around(o, d, reach, height, range);
    };
    return clip_segment_by(torus.frame, ray, reach, cut, s);
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET
int all_hits(const Torus& torus, const Ray& ray, ShapeHit* hits) {
    ClipSegment s;
    if (!segment_of(torus, ray, s)) return 0;
    return intersect_segment(TorusPolynomial{torus.tube}, torus.frame, ray, s, true, hits);
}

ALHAZEN_FOR_EACH_INSTRUCTION_SET
bool one_hit(const Torus& torus, const Ray& ray, ShapeHit& hit) {
    ClipSegment s;
    if (!segment_of(torus, ray, s)) return false;
    return first_on_segment(TorusPolynomial{torus.tube}, torus.frame, ray, s, true, hit);
}

}  // namespace

int Torus::intersect(const Ray& ray, ShapeHit* hits) const {
    return all_hits(*this, ray, hits);
}

bool first_hit(const Torus& shape, const Ray& ray, ShapeHit& hit) {
    return one_hit(shape, ray, hit);
}

namespace {

/// The nearest point of the tube: along the way to the circle. Right to some roundings of the
/// coordinates, which `Torus::surface` counts.
ProjectedPoint nearest_on_tube(const Vec3& p, double tube, const Vec3& back) {
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    const double out = across - 1.0;
    const double distance = std::sqrt(out * out + p.z * p.z);
    // On the axis or on the circle there is no such way.
    if (!(across > 0.0 && distance > 0.0)) {
        return project_to_zero(TorusPolynomial{tube}, p, back);
    }
    const double scale = tube / distance;
    const double ratio = (1.0 + out * scale) / across;
    const double radial = out / across;
    return {{p.x * ratio, p.y * ratio, p.z * scale}, {p.x * radial, p.y * radial, p.z}, 0.0};
}

ProjectedPoint point_on(const Torus& torus, const Ray& ray, const ShapeHit& hit) {
    const SolidFrame& frame = torus.frame;
    const Vec3 d = unit_or(frame.local_from_object * ray.direction, {0, 0, 1});
    return nearest_on_tube(frame.to_local(ray.at(hit.t)), torus.tube, -1e-6 * torus.tube * d);
}

ShapeSurface surface_at(const Torus& torus, const ProjectedPoint& at) {
    ShapeSurface surface = surface_of(torus.frame, at);
    surface.error += torus.frame.object_error(at.point, 8);
    return surface;
}

}  // namespace

ShapeSurface plain_surface(const Torus& shape, const Ray& ray, const ShapeHit& hit) {
    return surface_at(shape, point_on(shape, ray, hit));
}

ShapeSurface Torus::surface(const Ray& ray, const ShapeHit& hit) const {
    const ProjectedPoint at = point_on(*this, ray, hit);
    ShapeSurface surface = surface_at(*this, at);
    const Vec3& p = at.point;
    LocalUv local = turn_uv(p);
    const double across = std::sqrt(p.x * p.x + p.y * p.y);
    const double out = across - 1.0;
    local.uv.y = turn_fraction(out, p.z);
    const double squared = 2.0 * kPi * (out * out + p.z * p.z);
    if (across > 0.0 && squared > 0.0) {
        local.v_gradient = Vec3{-p.z * p.x / across, -p.z * p.y / across, out} / squared;
    }
    set_uv(frame, local, at.gradient, surface);
    return surface;
}

}  // namespace alhazen
