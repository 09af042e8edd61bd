#include "alhazen/shapes/algebraic/tgc.h"

#include <utility>

#include "alhazen/shapes/algebraic/polynomial_solid.h"
#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/quadrics/ellipsoid.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"

namespace alhazen {

namespace {

/// (x b)^2 + (y a)^2 - (a b)^2 with a = a0 + da z, b = b0 + db z.
struct TgcPolynomial {
    static constexpr int kDegree = 4;
    double a0, da, b0, db;

    template <class Real>
    int coefficients(const Point3<Real>& p, const Point3<Real>& q, Real* out) const {
        const auto linear = [](double at_0, double slope, const Real& z) {
            return Real(at_0) + Real(slope) * z;
        };
        const Real ap = linear(a0, da, p.z), aq = linear(a0, da, q.z);
        const Real bp = linear(b0, db, p.z), bq = linear(b0, db, q.z);
        std::fill_n(out, 5, Real(0.0));
        // Adds the square of the product of two linear functions; coefficients times binomials.
        const auto add = [&](const Real& u0, const Real& u1, const Real& v0, const Real& v1,
                             double sign) {
            const Real c0 = u0 * v0, c1 = u0 * v1 + u1 * v0, c2 = u1 * v1;
            const Real s(sign), two(2.0);
            out[0] += s * (c0 * c0);
            out[1] += s * (two * (c0 * c1));
            out[2] += s * (two * (c0 * c2) + c1 * c1);
            out[3] += s * (two * (c1 * c2));
            out[4] += s * (c2 * c2);
        };
        add(p.x, q.x, bp, bq, 1.0);
        add(p.y, q.y, ap, aq, 1.0);
        add(ap, aq, bp, bq, -1.0);
        // All times six: only multiples of f are needed.
        out[0] = out[0] * Real(6.0);
        out[1] = out[1] * Real(1.5);
        out[3] = out[3] * Real(1.5);
        out[4] = out[4] * Real(6.0);
        return 4;
    }
    template <class Real>
    [[nodiscard]] Real value(const Point3<Real>& p) const {
        const Real a = Real(a0) + Real(da) * p.z, b = Real(b0) + Real(db) * p.z;
        const Real xb = p.x * b, ya = p.y * a, ab = a * b;
        return xb * xb + ya * ya - ab * ab;
    }
    [[nodiscard]] Vec3 gradient(const Vec3& p) const {
        const double a = a0 + da * p.z, b = b0 + db * p.z;
        return {2.0 * p.x * b * b, 2.0 * p.y * a * a,
                2.0 * (p.x * p.x * b * db + p.y * p.y * a * da - a * b * (a * db + b * da))};
    }
    // Within the clip |x|, |y|, |a|, |b| are at most 1 + 1/64, the value at the bounds.
    [[nodiscard]] double magnitude() const { return 6.0 * 4.0; }
    [[nodiscard]] double roundings() const { return 24.0; }
};

constexpr double kTgcRoom = 1.0 + 1.0 / 64;

TgcPolynomial polynomial_of(const Tgc& s) {
    return {s.a0, s.a1 - s.a0, s.b0, s.b1 - s.b0};
}

}  // namespace

void Tgc::prepare() {
    // The longer of the two parallel semi-axes is the unit of the frame.
    const double a = length(axis_a), b = length(axis_b), c = length(axis_c), d = length(axis_d);
    const double longest_x = std::fmax(a, c), longest_y = std::fmax(b, d);
    solid.frame =
        SolidFrame(base, Mat3{a >= c ? axis_a : axis_c, b >= d ? axis_b : axis_d, height});
    a0 = a / longest_x;
    a1 = c / longest_x;
    b0 = b / longest_y;
    b1 = d / longest_y;
    // Ratios of parallel ends may differ by rounding.
    quartic = std::abs(a0 * b1 - a1 * b0) > 1e-13;
    solid.clip_box.lo.z = 0.0;
    solid.clip_box.hi.z = 1.0;
    solid.capped = capped;
    QuadricForm form;  // x^2 + y^2 - (a0 + (a1 - a0) z)^2
    const double slope = a1 - a0;
    form.zz = -slope * slope;
    form.z = -slope * a0;
    form.c = -a0 * a0;
    solid.quadric = QuadricLine(form, 1.5);
}

void Tgc::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    checks.fields(*this);
    if (!checks.ok()) return;
    const auto along = [](const Vec3& one, const Vec3& other) {
        if (one == Vec3{} || other == Vec3{}) return true;
        return dot(unit_or(one, {}), unit_or(other, {})) > 1.0 - 1e-10;
    };
    if (!along(axis_a, axis_c)) checks.fail("axis_c must be zero or point as axis_a does");
    if (!along(axis_b, axis_d)) checks.fail("axis_d must be zero or point as axis_b does");
    const bool base_flat = axis_a == Vec3{} || axis_b == Vec3{};
    const bool top_flat = axis_c == Vec3{} || axis_d == Vec3{};
    if (base_flat && top_flat) checks.fail("base and top must not both be without area");
    if (!checks.ok()) return;
    const Vec3& x = length(axis_a) >= length(axis_c) ? axis_a : axis_c;
    const Vec3& y = length(axis_b) >= length(axis_d) ? axis_b : axis_d;
    check_axes(checks, {x, y, height}, "axis_a", "axis_b", "height");
}

Box3 Tgc::box() const {
    Box3 box = ellipse_box(base, axis_a, axis_b);
    box.include(ellipse_box(base + height, axis_c, axis_d));
    return box;
}

Interval Tgc::extent(const Vec3& axis) const {
    return hull(ellipse_extent(axis, base, axis_a, axis_b),
                ellipse_extent(axis, base + height, axis_c, axis_d));
}

namespace {

bool segment_of(const Tgc& shape, const Ray& ray, ClipSegment& s) {
    const Box3 around{{-kTgcRoom, -kTgcRoom, 0.0}, {kTgcRoom, kTgcRoom, 1.0}};
    return clip_segment(shape.solid.frame, ray, around, 1.0, s);
}

}  // namespace

int Tgc::intersect(const Ray& ray, ShapeHit* hits) const {
    if (!quartic) return solid.intersect(ray, hits);
    ClipSegment s;
    if (!segment_of(*this, ray, s)) return 0;
    return intersect_segment(polynomial_of(*this), solid.frame, ray, s, capped, hits);
}

bool first_hit(const Tgc& shape, const Ray& ray, ShapeHit& hit) {
    if (!shape.quartic) {
        ShapeHit hits[Tgc::kMaxHits];
        if (shape.solid.intersect(ray, hits) == 0) return false;
        hit = hits[0];
        return true;
    }
    ClipSegment s;
    if (!segment_of(shape, ray, s)) return false;
    return first_on_segment(polynomial_of(shape), shape.solid.frame, ray, s, shape.capped, hit);
}

ShapeSurface Tgc::surface(const Ray& ray, const ShapeHit& hit) const {
    if (!quartic || hit.part > 0) return solid.surface(ray, hit);
    const SolidFrame& frame = solid.frame;
    const Vec3 start = frame.to_local(ray.at(hit.t));
    const Vec3 d = unit_or(frame.local_from_object * ray.direction, {0, 0, 1});
    const ProjectedPoint at = project_to_zero(polynomial_of(*this), start, -1e-6 * d);
    ShapeSurface surface = surface_of(frame, at);
    LocalUv local = turn_uv(at.point);
    local.uv.y = at.point.z;
    local.v_gradient.z = 1.0;
    set_uv(frame, local, at.gradient, surface);
    return surface;
}

}  // namespace alhazen
