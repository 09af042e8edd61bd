#include "alhazen/shapes/swept/prism.h"

#include <algorithm>

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/shapes/core/shape_numerics.h"
#include "alhazen/shapes/swept/profile_outline.h"

namespace alhazen {

namespace {

double larger(double a, double b) {
    return std::fmax(std::abs(a), std::abs(b));
}

/// The projection of a ray from the apex into the plane of the profile: the line of zeros of c + x
/// p.x + y p.y. With o the ray's origin (moved along it by `shift`), d its direction and a + b t
/// the size of the section at t, these coefficients are the cross product of (o, a) and (d, b).
template <class Real>
struct ProfileLine {
    Real x, y, c;
    double error;  ///< error bound of the sum, for every point of the profile

    ProfileLine(const Prism& prism, const Ray& ray, double shift) {
        const Vec3& d = ray.direction;
        const Real ox = Real(ray.origin.x) + Real(shift) * Real(d.x);
        const Real oy = Real(ray.origin.y) + Real(shift) * Real(d.y);
        const Real oz = Real(ray.origin.z) + Real(shift) * Real(d.z);
        const Real a = Real(1.0) + Real(prism.growth) * (oz - Real(prism.h0));
        const Real b = Real(prism.growth) * Real(d.z);
        x = b * oy - a * Real(d.y);
        y = a * Real(d.x) - b * ox;
        c = ox * Real(d.y) - oy * Real(d.x);
        // A point on the line counts as positive: the line is moved as `keeps_face` says. By the
        // direction alone, so that both precisions agree.
        if (d.y > 0.0 || (d.y == 0.0 && d.x < 0.0)) {
            x = -x;
            y = -y;
            c = -c;
        }
        const double across = larger(d.x, d.y), g = std::abs(prism.growth);
        const double near = larger(double(ox), double(oy));
        const double z = larger(double(oz), prism.h0);
        const double size = 1.0 + 2.0 * g * z, slope = g * std::abs(d.z);
        const double terms =
            2.0 * near * across + 2.0 * prism.reach * (slope * near + size * across);
        // The rounding of the shift is a displacement of the origin.
        const double moved =
            max_component(abs(ray.origin)) + std::abs(shift) * max_component(abs(d));
        const double per_move = 2.0 * across + 2.0 * prism.reach * (slope + g * across);
        error = kUnitRoundoff<Real> * (16.0 * terms + 4.0 * moved * per_move);
    }
    [[nodiscard]] Real at(Vec2 p) const { return c + x * Real(p.x) + y * Real(p.y); }
};

/// A ray near the prism, in double.
struct PrismRay {
    double shift, ox, oy, oz, dx, dy, dz;
    double size, size_growth;  ///< size of the section: a + b t
    double far;                ///< magnitude of the numbers that the origin was computed from

    PrismRay(const Prism& prism, const Ray& ray) : shift(0) {
        const Vec3& d = ray.direction;
        const Vec3 from_center = ray.origin - prism.center;
        // For a near origin the shift would only lose digits of a small t.
        if (length_squared(from_center) > 16.0 * prism.radius * prism.radius) {
            shift = -dot(from_center, d) / length_squared(d);
        }
        const Vec3 o = ray.origin + shift * d;
        ox = o.x, oy = o.y, oz = o.z, dx = d.x, dy = d.y, dz = d.z;
        size = 1.0 + prism.growth * (oz - prism.h0);
        size_growth = prism.growth * dz;
        far = max_component(abs(ray.origin)) + std::abs(shift) * max_component(abs(d));
    }
    /// t of the ray at this point of the profile, which is on its line.
    [[nodiscard]] double t_at(Vec2 p) const {
        const double x = dx - size_growth * p.x, y = dy - size_growth * p.y;
        return ((size * p.x - ox) * x + (size * p.y - oy) * y) / (x * x + y * y);
    }
    /// True if this point, found where the line's value is within `error` of 0, lies on the ray to
    /// the last digits of the numbers involved. False if the ray nearly runs along the side of a
    /// cone.
    [[nodiscard]] bool is_precise(Vec2 p, double error, double reach) const {
        const double x = dx - size_growth * p.x, y = dy - size_growth * p.y;
        const double size_there = size + t_at(p) * size_growth;
        return !(error > 0x1p-45 * (far + reach) * size_there * std::sqrt(x * x + y * y));
    }
};

/// True if all control points of the curve are certain to have values of one sign: no sign change.
template <class Value>
bool is_on_one_side(const ProfileCurve& curve, double error, const Value& value) {
    const double first = value(curve.p[0]);
    if (!(std::abs(first) > error)) return false;
    const auto agrees = [&](const Vec2& p) {
        return first > 0.0 ? value(p) > error : value(p) < -error;
    };
    return agrees(curve.p[3]) && (curve.line || (agrees(curve.p[1]) && agrees(curve.p[2])));
}

/// Calls f(curve, s) at the sign changes of the polynomials that `make` returns for the curves.
template <class Value, class Make, class F>
void for_each_sign_change(const Profile& profile, const Value& value, Make make, F f) {
    for (std::uint32_t i = 0; i < profile.curves.size(); ++i) {
        if (is_on_one_side(profile.curves[i], 0.0, value)) continue;
        SignChanges<3> changes;
        find_certified_sign_changes<3>([&](auto& p) { make(profile.curves[i], p); }, changes);
        for (int k = 0; k < changes.count; ++k) f(i, changes.u[static_cast<std::size_t>(k)]);
    }
}

/// Odd-even rule, along the line towards +x; a point on the outline: `keeps_face`.
bool inside_profile(const Profile& profile, Vec2 q) {
    bool inside = false;
    for_each_sign_change(
        profile, [&](const Vec2& p) { return p.y - q.y; },
        [&]<class Real>(const ProfileCurve& curve, BernsteinPolynomial<Real, 3>& p) {
            p.degree = curve.degree();
            p.error = 0.0;
            p.shared_ends = true;
            for (int i = 0; i <= p.degree; ++i) p.b[i] = Real(curve.control(i).y) - Real(q.y);
        },
        [&](std::uint32_t i, double s) {
            if (profile.curves[i].point(s).x >= q.x) inside = !inside;
        });
    return inside;
}

/// Crossings with the sides of the prism without ends, in the order of t. Their number is odd if
/// the ray comes from, or goes to, the far end of a cone inside of it. False if the whole line is
/// inside or outside.
bool side_crossings(const Prism& prism, const Ray& ray, const PrismRay& local, ShapeHits& found) {
    const ProfileLine<double> line(prism, ray, local.shift);
    if (line.x == 0.0 && line.y == 0.0) return false;
    const auto make = [&]<class Real>(const ProfileCurve& curve, BernsteinPolynomial<Real, 3>& p) {
        const auto fill = [&](const ProfileLine<Real>& exact) {
            p.degree = curve.degree();
            p.error = exact.error;
            p.shared_ends = true;
            for (int i = 0; i <= p.degree; ++i) p.b[i] = exact.at(curve.control(i));
        };
        if constexpr (std::is_same_v<Real, double>) {
            fill(line);
        } else {
            fill(ProfileLine<Real>(prism, ray, local.shift));
        }
    };
    for (std::uint32_t i = 0; i < prism.profile.curves.size(); ++i) {
        const ProfileCurve& curve = prism.profile.curves[i];
        // Usual among many curves, and a fraction of the time of the search.
        const auto value = [&](const Vec2& p) { return line.at(p); };
        if (is_on_one_side(curve, line.error, value)) continue;
        SignChanges<3> changes;
        find_certified_sign_changes<3>([&](auto& p) { make(curve, p); }, changes);
        bool precise = true;
        for (int k = 0; k < changes.count; ++k) {
            precise =
                precise && local.is_precise(curve.point(changes.u[k]), line.error, prism.reach);
        }
        if (!precise) {
            BernsteinPolynomial<DoubleDouble, 3> p;
            make(curve, p);
            find_sign_changes(p, changes);
        }
        for (int k = 0; k < changes.count; ++k) {
            const double t = local.t_at(curve.point(changes.u[k]));
            // Otherwise it is the projection through the apex.
            if (local.size + t * local.size_growth > 0.0)
                found.push_back({t, changes.u[k], 0, i + 2});
        }
    }
    std::sort(found.begin(), found.end(), [](const ShapeHit& a, const ShapeHit& b) {
        return a.t != b.t ? a.t < b.t : (a.part != b.part ? a.part < b.part : a.u < b.u);
    });
    return true;
}

}  // namespace

void Prism::prepare() {
    remove_shared_parts(profile);
    growth = (top_scale - 1.0) / (h1 - h0);
    reach = profile.reach();
    const Box3 bounds = box();
    center = bounds.center();
    radius = 0.5 * length(bounds.size());
}

void Prism::validate(const FileLocation& where, Diagnostics& diagnostics) const {
    FieldChecks checks(kName, where, diagnostics);
    profile.validate(checks);
    checks.point("h0, h1", {h0, h1, 0.0});
    if (!(h1 - h0 >= kMinLength)) checks.fail("h1 must be greater than h0");
    checks.length("top_scale", top_scale, 0.0);
    if (checks.ok() && !profile.loops_close()) {
        checks.fail("every loop of the profile must end where it begins");
    }
}

Box3 Prism::box() const {
    const auto [lo, hi] = profile.bounds();
    Box3 box;
    for (const double size : {1.0, top_scale}) {
        box.include(Vec3{size * lo.x, size * lo.y, h0});
        box.include(Vec3{size * hi.x, size * hi.y, h1});
    }
    return padded(box, gamma_bound(32));
}

Interval Prism::extent(const Vec3& axis) const {
    Interval range;
    for (const ProfileCurve& curve : profile.curves) {
        for (const Vec2& p : curve.p) {
            range = hull(range, outward_extent(axis, {p.x, p.y, h0}, 0.0));
            range = hull(range, outward_extent(axis, {top_scale * p.x, top_scale * p.y, h1}, 0.0));
        }
    }
    return range;
}

void Prism::intersect(const Ray& ray, ShapeHits& hits) const {
    const PrismRay local(*this, ray);
    double slab_entry = -kInfinity, slab_exit = kInfinity;
    if (local.dz == 0.0) {
        if (!(h0 < local.oz && local.oz <= h1)) return;  // `keeps_face`
    } else {
        slab_entry = ((local.dz > 0.0 ? h0 : h1) - local.oz) / local.dz;
        slab_exit = ((local.dz > 0.0 ? h1 : h0) - local.oz) / local.dz;
    }
    const std::uint32_t entry_end = local.dz > 0.0 ? 0 : 1, exit_end = 1 - entry_end;
    const auto emit = [&](const ShapeHit* from, const ShapeHit* to) {
        ShapeHit entry{slab_entry, 0, -1, entry_end}, exit{slab_exit, 0, 1, exit_end};
        if (from != nullptr && from->t > slab_entry) entry = {from->t, from->u, -1, from->part};
        if (to != nullptr && to->t < slab_exit) exit = {to->t, to->u, 1, to->part};
        entry.t += local.shift;
        exit.t += local.shift;
        if (!(entry.t < exit.t) || !std::isfinite(entry.t) || !std::isfinite(exit.t)) return;
        if (ray.covers(entry.t)) hits.push_back(entry);
        if (ray.covers(exit.t)) hits.push_back(exit);
    };
    ShapeHits sides;
    if (!side_crossings(*this, ray, local, sides)) {
        const bool by_size = std::abs(local.size) >= std::abs(local.size_growth);
        const double k = by_size ? local.size : local.size_growth;
        const Vec2 q =
            by_size ? Vec2{local.ox / k, local.oy / k} : Vec2{local.dx / k, local.dy / k};
        if (inside_profile(profile, q)) emit(nullptr, nullptr);
        return;
    }
    std::size_t i = 0;
    const bool odd = sides.size() % 2 != 0;
    if (odd && local.size_growth < 0.0) emit(nullptr, &sides[i++]);
    for (; i + 1 < sides.size() && !hits.enough(); i += 2) emit(&sides[i], &sides[i + 1]);
    if (i < sides.size()) emit(&sides[i], nullptr);
}

ShapeSurface Prism::surface(const Ray& ray, const ShapeHit& hit) const {
    return hit.part < 2 ? end_surface(ray, hit) : side_surface(ray, hit);
}

ShapeSurface Prism::end_surface(const Ray& ray, const ShapeHit& hit) const {
    const bool top = hit.part == 1;
    const double size = top ? top_scale : 1.0;
    ShapeSurface surface;
    surface.point = ray.at(hit.t);
    surface.point.z = top ? h1 : h0;
    surface.normal = surface.shading_normal = {0.0, 0.0, top ? 1.0 : -1.0};
    if (size > 0.0) surface.uv = {surface.point.x / size, surface.point.y / size};
    surface.dpdu = {size, 0, 0};
    surface.dpdv = {0, size, 0};
    surface.error = {0.0, 0.0, gamma_bound(2) * larger(h0, h1)};
    return surface;
}

ShapeSurface Prism::side_surface(const Ray& ray, const ShapeHit& hit) const {
    const std::uint32_t i = hit.part - 2;
    const ProfileCurve& curve = profile.curves[i];
    const Vec2 p = curve.point(hit.u), along = curve.direction(hit.u),
               speed = curve.derivative(hit.u);
    // The nearest point of the line to the apex; the one of equal height would magnify the error of
    // the height on a slanted side.
    const Vec3 generator{growth * p.x, growth * p.y, 1.0}, at = ray.at(hit.t);
    const double level_size = 1.0 + growth * (at.z - h0);
    const Vec3 off{at.x - level_size * p.x, at.y - level_size * p.y, 0.0};
    const double z = std::clamp(at.z + dot(off, generator) / length_squared(generator), h0, h1);
    const double size = std::max(0.0, 1.0 + growth * (z - h0));
    const double count = static_cast<double>(profile.curves.size());
    ShapeSurface surface;
    surface.point = {size * p.x, size * p.y, z};
    const Vec3 across{along.y, -along.x,
                      growth * difference_of_products(along.x, p.y, along.y, p.x)};
    surface.normal = unit_or(across, {1, 0, 0});
    // Only the full list of crossings tells whether the ray enters here (v = -1) or leaves.
    if (dot(surface.normal, ray.direction) * hit.v < 0.0) surface.normal = -surface.normal;
    surface.shading_normal = surface.normal;
    surface.uv = {(i + hit.u) / count, (z - h0) / (h1 - h0)};
    surface.dpdu = count * size * Vec3{speed.x, speed.y, 0.0};
    surface.dpdv = (h1 - h0) * generator;
    const double widest = std::max(1.0, top_scale) * reach;
    const double across_error = gamma_bound(16) * widest;
    surface.error = {across_error, across_error, gamma_bound(2) * larger(h0, h1)};
    return surface;
}

}  // namespace alhazen
