#include "alhazen/geometry/mirrors/alhazens_problem.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/math/constants.h"
#include "alhazen/math/plane_vectors.h"

namespace alhazen {

namespace {

/// A or B in the plane of A, B and the centre, for radius 1: (x, y) / w, where w = 0 is infinitely
/// far.
struct PlaneEnd {
    Vec2 at;
    double w = 1;
};

/// g(theta) = m2 sin 2 theta + k2 cos 2 theta + m1 sin theta + k1 cos theta, the imaginary part of
/// (a - z)(b - z) / z^2 on the circle z = exp(i theta). It is 0 where the normal bisects the angle
/// of A and B, or that of A and the point opposite to B.
struct AngleQuartic {
    double m2, k2, m1, k1;

    static AngleQuartic of(const PlaneEnd& a, const PlaneEnd& b) {
        const Vec2 product{a.at.x * b.at.x - a.at.y * b.at.y, a.at.x * b.at.y + a.at.y * b.at.x};
        const Vec2 sum = b.w * a.at + a.w * b.at;
        return {-product.x, product.y, sum.x, -sum.y};
    }
    [[nodiscard]] double size() const {
        return std::abs(m2) + std::abs(k2) + std::abs(m1) + std::abs(k1);
    }
};

/// g by its factors a - z and b - z, more accurate if A or B is close to the circle.
struct FactoredQuartic {
    const PlaneEnd& a;
    const PlaneEnd& b;

    void operator()(double theta, double& value, double& slope) const {
        const Vec2 z{std::cos(theta), std::sin(theta)};
        const double across_a = cross_of(z, a.at), along_a = dot_of(z, a.at);
        const double across_b = cross_of(z, b.at), along_b = dot_of(z, b.at);
        const double out_a = along_a - a.w, out_b = along_b - b.w;
        value = across_a * out_b + across_b * out_a;
        slope = 2.0 * across_a * across_b - along_a * out_b - along_b * out_a;
    }
};

/// The quartic over the quarter of the circle that begins at `start`, in t = tan((theta - start) /
/// 2).
template <class Real>
void set_arc(const AngleQuartic& g, double start, BernsteinPolynomial<Real, 4>& p) {
    const double c1 = std::cos(start), s1 = std::sin(start);
    const double c2 = std::cos(2.0 * start), s2 = std::sin(2.0 * start);
    const Real sin2 = Real(g.m2) * Real(c2) - Real(g.k2) * Real(s2);
    const Real cos2 = Real(g.m2) * Real(s2) + Real(g.k2) * Real(c2);
    const Real sin1 = Real(g.m1) * Real(c1) - Real(g.k1) * Real(s1);
    const Real cos1 = Real(g.m1) * Real(s1) + Real(g.k1) * Real(c1);
    const Real two(2.0), half(0.5), four(4.0);
    p.degree = 4;
    p.shared_ends = true;
    p.b = {cos1 + cos2, cos1 + sin2 + half * sin1 + cos2, cos1 + two * sin2 + sin1,
           cos1 + two * sin2 + two * sin1 - two * cos2, four * sin1 - four * cos2};
    // In double-double the coefficients of g are taken as exact.
    p.error = (std::is_same_v<Real, double> ? 0x1p-48 : 0x1p-96) * g.size();
}

struct PlanePoints {
    int count = 0;
    std::array<double, 4> theta;

    void add(double angle) {
        if (count < 4) theta[static_cast<std::size_t>(count++)] = angle;
    }
};

/// All zeros of g.
PlanePoints all_roots(const PlaneEnd& a, const PlaneEnd& b) {
    const AngleQuartic g = AngleQuartic::of(a, b);
    PlanePoints found;
    // An angle unlikely to be a root, so that no root lies at the end of an arc.
    constexpr double kStart = 0.3819660112501051;
    for (int arc = 0; arc < 4; ++arc) {
        const double start = kStart + arc * (0.5 * kPi);
        SignChanges<4> changes;
        find_certified_sign_changes<4>([&](auto& p) { set_arc(g, start, p); }, changes);
        for (int i = 0; i < changes.count; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const FactoredQuartic f{a, b};
            const double theta = start + 2.0 * std::atan(changes.u[k]);
            double value = 0, slope = 0, next = theta;
            for (int step = 0; step < 2; ++step) {
                f(next, value, slope);
                const double change = value / slope;
                if (std::abs(change) < 1e-7) next -= change;
            }
            found.add(next);
        }
    }
    return found;
}

/// The zero of g between the directions of A and B.
PlanePoints root_between(const PlaneEnd& a, const PlaneEnd& b) {
    PlanePoints found;
    const double from = std::atan2(a.at.y, a.at.x), to = std::atan2(b.at.y, b.at.x);
    const FactoredQuartic f{a, b};
    double at_from = 0, at_to = 0, slope = 0;
    f(from, at_from, slope);
    f(to, at_to, slope);
    if (at_from == 0.0 || at_to == 0.0 || !(at_from * at_to < 0.0)) {
        // A and B are collinear with the centre, on the same side.
        found.add(0.5 * (from + to));
        return found;
    }
    const double lo = std::min(from, to), hi = std::max(from, to);
    const double sign = from < to ? at_from : at_to;
    found.add(bernstein::bracketed_newton(f, lo, hi, sign, 0.5 * (from + to)));
    return found;
}

/// The plane of A, B and the centre; x bisects their angle.
struct MirrorPlane {
    Vec3 x, y;
    bool in_line = false;  ///< any plane through the line is valid

    MirrorPlane(const Vec3& a, const Vec3& b) {
        const double la = length(a), lb = length(b);
        const Vec3 ua = la > 0.0 ? a / la : b / lb, ub = lb > 0.0 ? b / lb : ua;
        const Vec3 sum = ua + ub, difference = ua - ub;
        constexpr double kInLine = 1e-14;
        in_line = length(cross(ua, ub)) < kInLine;
        if (in_line) {
            const bool opposite = dot(ua, ub) < 0.0;
            x = opposite ? perpendicular(ua) : ua;
            y = opposite ? ua : perpendicular(ua);
        } else if (length_squared(sum) > length_squared(difference)) {
            x = normalize(sum);
            y = normalize(difference - dot(difference, x) * x);
        } else {
            y = normalize(difference);
            x = normalize(sum - dot(sum, y) * y);
        }
    }
    [[nodiscard]] PlaneEnd of(const Vec3& v, bool infinite) const {
        PlaneEnd end{{dot(v, x), dot(v, y)}, infinite ? 0.0 : 1.0};
        const double scale = std::hypot(end.at.x, end.at.y);
        // Scales far points, whose products would overflow, and directions.
        if (infinite || scale > 1.0) {
            end.at = (1.0 / scale) * end.at;
            end.w /= scale;
        }
        return end;
    }
};

/// True if the mirror reflects there: A and B lie on the side of `face`, and the normal between
/// them.
bool reflects(const PlaneEnd& a, const PlaneEnd& b, double theta, MirrorFace face) {
    const Vec2 z{std::cos(theta), std::sin(theta)};
    const double out_a = dot_of(z, a.at) - a.w, out_b = dot_of(z, b.at) - b.w;
    const double across_a = cross_of(z, a.at), across_b = cross_of(z, b.at);
    constexpr double kGrazing = 1e-12;
    const double side = face == MirrorFace::Outer ? 1.0 : -1.0;
    if (!(side * out_a > kGrazing * (std::abs(out_a) + std::abs(across_a)))) return false;
    if (!(side * out_b > kGrazing * (std::abs(out_b) + std::abs(across_b)))) return false;
    // The real part of the product above is positive: the angles are equal and not supplementary.
    return out_a * out_b - across_a * across_b > 0.0;
}

}  // namespace

MirrorPoints reflecting_points(const Vec3& center, double radius, MirrorFace face,
                               const MirrorEnd& a, const MirrorEnd& b) {
    MirrorPoints result;
    const auto relative = [&](const MirrorEnd& end) {
        return end.infinite ? end.at : (end.at - center) / radius;
    };
    const Vec3 from_a = relative(a), from_b = relative(b);
    if (!(radius > 0.0) || !is_finite(from_a) || !is_finite(from_b)) return result;
    const double la = length(from_a), lb = length(from_b);
    if ((a.infinite && !(la > 0.0)) || (b.infinite && !(lb > 0.0))) return result;
    if (!(la > 0.0) && !(lb > 0.0)) {
        result.everywhere = face == MirrorFace::Inner;
        return result;
    }
    const bool outside = (a.infinite || la > 1.0) && (b.infinite || lb > 1.0);
    if (face == MirrorFace::Outer && !outside) return result;
    const MirrorPlane plane(from_a, from_b);
    const PlaneEnd end_a = plane.of(from_a, a.infinite), end_b = plane.of(from_b, b.infinite);
    const PlanePoints found =
        face == MirrorFace::Outer ? root_between(end_a, end_b) : all_roots(end_a, end_b);
    const Vec3 line = la > 0.0 ? from_a / la : from_b / lb;
    for (int i = 0; i < found.count; ++i) {
        const double theta = found.theta[static_cast<std::size_t>(i)];
        if (!reflects(end_a, end_b, theta, face)) continue;
        const Vec3 z = std::cos(theta) * plane.x + std::sin(theta) * plane.y;
        constexpr double kOffLine = 1e-9;
        const bool ring = plane.in_line && length(cross(z, line)) > kOffLine;
        // A circle crosses the plane twice: keeps one of the two points.
        if (ring && dot(z, perpendicular(line)) < 0.0) continue;
        const auto k = static_cast<std::size_t>(result.count++);
        result.points[k] = center + radius * z;
        result.on_ring[k] = ring;
    }
    return result;
}

}  // namespace alhazen
