#include "alhazen/shapes/swept/lathe.h"

#include <algorithm>

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/swept/lathe_near_level.h"
#include "alhazen/shapes/swept/profile_outline.h"

namespace alhazen {

namespace {

/// Climb below which rays are level: near the lathe their height changes by less than a hundredth
/// of its last digit.
constexpr double kLevel = 0x1p-60;
/// Climb below which t is ill-conditioned in the parameter of the profile.
constexpr double kNearLevel = 1e-4;

struct LatheRay {
    double shift = 0;
    Vec3 o;
    const Vec3& d;
    double across;       ///< length of the direction's component perpendicular to the axis
    double far;          ///< magnitude of the numbers that o was computed from
    double nearest = 0;  ///< t (from o) nearest to the axis; 0 for a ray parallel to it
    double distance;     ///< from the axis, there

    LatheRay(const Lathe& lathe, const Ray& ray) : o(ray.origin), d(ray.direction) {
        const Vec3 from_center = ray.origin - lathe.center;
        // For a near origin the shift would only lose digits of a small t.
        if (length_squared(from_center) > 16.0 * lathe.radius * lathe.radius) {
            shift = -dot(from_center, d) / length_squared(d);
            o = ray.origin + shift * d;
        }
        far = max_component(abs(ray.origin)) + std::abs(shift) * max_component(abs(d));
        across = std::sqrt(d.x * d.x + d.y * d.y);
        distance = std::sqrt(o.x * o.x + o.y * o.y);
        if (across > 0.0) {
            nearest = -(o.x * d.x + o.y * d.y) / (across * across);
            distance = std::abs(difference_of_products(o.x, d.y, o.y, d.x)) / across;
        }
    }
    [[nodiscard]] bool climbs_less_than(double share) const {
        return std::abs(d.z) <= share * across;
    }
};

/// d_z o + (z - o_z) d|^2 - (d_z r)^2 perpendicular to the axis, for (r, z) on the curve: zero
/// where the ray passes the height z at the distance r. Degree 2 for lines, 6 for cubics.
template <class Real>
void make_polynomial(const Lathe& lathe, const LatheRay& ray, const Ray& given,
                     const ProfileCurve& curve, BernsteinPolynomial<Real, 6>& p) {
    const Vec3& d = ray.d;
    const auto moved = [&](int k) { return Real(given.origin[k]) + Real(ray.shift) * Real(d[k]); };
    const Real ox = moved(0), oy = moved(1), oz = moved(2), dz = d.z;
    const int n = curve.degree();
    Real x[4], y[4], w[4];
    for (int i = 0; i <= n; ++i) {
        const Real z = Real(curve.control(i).y) - oz;
        x[i] = dz * ox + z * Real(d.x);
        y[i] = dz * oy + z * Real(d.y);
        w[i] = dz * Real(curve.control(i).x);
    }
    // The products of Bernstein polynomials: C(n, i) C(n, j) / C(2 n, i + j).
    static constexpr double kLine[2][2] = {{1, 1}, {1, 1}};
    static constexpr double kLineSum[3] = {1, 2, 1};
    static constexpr double kCubic[4][4] = {{1, 3, 3, 1}, {3, 9, 9, 3}, {3, 9, 9, 3}, {1, 3, 3, 1}};
    static constexpr double kCubicSum[7] = {1, 6, 15, 20, 15, 6, 1};
    p.degree = 2 * n;
    p.shared_ends = true;
    for (int k = 0; k <= p.degree; ++k) {
        Real sum = 0.0;
        for (int i = std::max(0, k - n); i <= std::min(k, n); ++i) {
            const double weight = n == 1 ? kLine[i][k - i] : kCubic[i][k - i];
            sum += Real(weight) * (x[i] * x[k - i] + y[i] * y[k - i] - w[i] * w[k - i]);
        }
        const double total = n == 1 ? kLineSum[k] : kCubicSum[k];
        if constexpr (std::is_same_v<Real, double>) {
            p.b[k] = sum / total;
        } else {
            // A quotient in double-double: one correction of the rounded one.
            const double q = sum.high / total;
            const Real rest = sum - Real(q) * Real(total);
            p.b[k] = Real(q) + Real(rest.high / total);
        }
    }
    // One bound for all curves, so that a sign at a shared point is certain for both or for
    // neither.
    const double side = std::fmax(std::abs(d.x), std::abs(d.y)), up = std::abs(d.z);
    const double near = max_component(abs(ray.o));
    const double most = up * near + (lathe.reach + near) * side;
    const double largest = most + up * lathe.reach;
    p.error = kUnitRoundoff<Real> * largest * (96.0 * largest + 16.0 * ray.far * (up + side));
}

/// Both points of the ray at the distance r from the axis.
double half_chord(const LatheRay& ray, double r) {
    return std::sqrt(std::fmax(0.0, (r - ray.distance) * (r + ray.distance))) / ray.across;
}

/// Refines s and t together, except near a tangent: Newton's method while it converges.
void polish(const ProfileCurve& curve, const LatheRay& ray, double lo, double hi, double& s,
            double& t) {
    double try_s = s, try_t = t, best = kInfinity;
    for (int i = 0; i < 4; ++i) {
        const Vec2 p = curve.point(try_s), slope = curve.derivative(try_s);
        const double x = ray.o.x + try_t * ray.d.x, y = ray.o.y + try_t * ray.d.y;
        const double q = std::sqrt(x * x + y * y);
        const double f1 = ray.o.z + try_t * ray.d.z - p.y, f2 = q - p.x;
        const double off = std::abs(f1) + std::abs(f2);
        if (!(off < best)) return;
        best = off;
        s = try_s;
        t = try_t;
        // [-slope.y, d.z; -slope.x, (q.d) / |q|] (ds, dt) = -(f1, f2)
        const double outward = q > 0.0 ? (x * ray.d.x + y * ray.d.y) / q : 0.0;
        const double det = difference_of_products(slope.x, ray.d.z, slope.y, outward);
        try_s += (ray.d.z * f2 - outward * f1) / det;
        try_t += (slope.y * f2 - slope.x * f1) / det;
        if (!(try_s >= lo && try_s <= hi)) return;
    }
}

void level_crossings(const Lathe& lathe, const LatheRay& ray, ShapeHits& found) {
    const double z = ray.o.z + ray.nearest * ray.d.z;
    for (std::uint32_t i = 0; i < lathe.profile.curves.size(); ++i) {
        const ProfileCurve& curve = lathe.profile.curves[i];
        SignChanges<3> changes;
        find_certified_sign_changes<3>(
            [&]<class Real>(BernsteinPolynomial<Real, 3>& p) {
                p.degree = curve.degree();
                p.error = 0.0;
                p.shared_ends = true;
                for (int k = 0; k <= p.degree; ++k) p.b[k] = Real(curve.control(k).y) - Real(z);
            },
            changes);
        for (int k = 0; k < changes.count; ++k) {
            const auto n = static_cast<std::size_t>(k);
            const double r = curve.point(changes.u[n]).x;
            if (!(r > ray.distance)) continue;
            const double half = half_chord(ray, r);
            for (const double side : {-half, half}) {
                double s = changes.u[n], t = ray.nearest + side;
                polish(curve, ray, changes.lo[n], changes.hi[n], s, t);
                found.push_back({ray.shift + t, s, 0, i});
            }
        }
    }
}

void climbing_crossings(const Lathe& lathe, const LatheRay& ray, const Ray& given,
                        ShapeHits& found) {
    for (std::uint32_t i = 0; i < lathe.profile.curves.size(); ++i) {
        const ProfileCurve& curve = lathe.profile.curves[i];
        SignChanges<6> changes;
        find_certified_sign_changes<6>(
            [&](auto& p) { make_polynomial(lathe, ray, given, curve, p); }, changes);
        for (int k = 0; k < changes.count; ++k) {
            const auto n = static_cast<std::size_t>(k);
            double s = changes.u[n], t = (curve.point(s).y - ray.o.z) / ray.d.z;
            polish(curve, ray, changes.lo[n], changes.hi[n], s, t);
            found.push_back({ray.shift + t, s, 0, i});
        }
    }
}

}  // namespace

bool Lathe::closed() const {
    std::size_t begin = 0;
    for (const std::size_t end : profile.loop_ends) {
        if (begin >= end || end > profile.curves.size()) return false;
        const Vec2 first = profile.curves[begin].p[0], last = profile.curves[end - 1].p[3];
        if (first != last && (first.x != 0.0 || last.x != 0.0)) return false;
        begin = end;
    }
    return true;
}

void Lathe::prepare() {
    is_closed = closed();
    if (is_closed) remove_shared_parts(profile);
    reach = profile.reach();
    const Box3 bounds = box();
    center = {0.0, 0.0, bounds.center().z};
    radius = 0.5 * length(bounds.size());
}

void Lathe::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    profile.validate(checks);
    if (!checks.ok()) return;
    const auto [lo, hi] = profile.bounds();
    if (!(lo.x >= 0.0)) {
        checks.fail(
            "the profile must not cross the axis: its points are (radius, height), and "
            "radii are not negative");
    }
    checks.length("largest radius of the profile", hi.x);
}

Box3 Lathe::box() const {
    const auto [lo, hi] = profile.bounds();
    return padded({{-hi.x, -hi.x, lo.y}, {hi.x, hi.x, hi.y}}, gamma_bound(32));
}

Interval Lathe::extent(const Vec3& axis) const {
    const double across = std::hypot(axis.x, axis.y);
    Interval range;
    for (const ProfileCurve& curve : profile.curves) {
        for (const Vec2& p : curve.p) {
            range = hull(range, outward_extent(axis, {0.0, 0.0, p.y}, across * p.x));
        }
    }
    return range;
}

void Lathe::intersect(const Ray& ray, ShapeHits& hits) const {
    const LatheRay local(*this, ray);
    ShapeHits found;
    if (local.climbs_less_than(kLevel)) {
        level_crossings(*this, local, found);
    } else if (local.climbs_less_than(kNearLevel)) {
        near_level_crossings(*this, ray, found);
    } else {
        climbing_crossings(*this, local, ray, found);
    }
    for (const ShapeHit& hit : found) {
        if (!std::isfinite(hit.t)) return;
    }
    std::sort(found.begin(), found.end(), [](const ShapeHit& a, const ShapeHit& b) {
        return a.t != b.t ? a.t < b.t : (a.part != b.part ? a.part < b.part : a.u < b.u);
    });
    double side = is_closed ? -1.0 : 0.0;
    for (const ShapeHit& hit : found) {
        if (ray.covers(hit.t)) hits.push_back({hit.t, hit.u, side, hit.part});
        side = -side;
    }
}

ShapeSurface Lathe::surface(const Ray& ray, const ShapeHit& hit) const {
    const ProfileCurve& curve = profile.curves[hit.part];
    const Vec3 at = ray.at(hit.t);
    const Vec2 p = curve.point(hit.u), along = curve.direction(hit.u);
    const Vec2 speed = curve.derivative(hit.u);
    const double count = static_cast<double>(profile.curves.size());
    const Vec3 outward = unit_or({at.x, at.y, 0.0}, {1, 0, 0});
    ShapeSurface surface;
    surface.point = p.x * outward + Vec3{0.0, 0.0, p.y};
    surface.normal = unit_or(along.y * outward - Vec3{0.0, 0.0, along.x}, outward);
    // Only the full list of crossings tells whether the ray enters here (v = -1) or leaves.
    if (dot(surface.normal, ray.direction) * hit.v < 0.0) surface.normal = -surface.normal;
    surface.shading_normal = surface.normal;
    surface.uv = {turn_fraction(outward.x, outward.y), (hit.part + hit.u) / count};
    surface.dpdu = (2.0 * kPi * p.x) * Vec3{-outward.y, outward.x, 0.0};
    surface.dpdv = count * (speed.x * outward + Vec3{0.0, 0.0, speed.y});
    const double error = gamma_bound(16) * reach;
    surface.error = {error, error, error};
    return surface;
}

}  // namespace alhazen
