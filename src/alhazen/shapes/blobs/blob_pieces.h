#pragma once
/// The pieces of a blob along a ray: the range of each component, and its density there.
///
/// Source: see blob.h.
/// Conventions: internal to this folder. The parameter of a piece runs from a point of the ray near
/// the blob.

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/math/bernstein_roots.h"
#include "alhazen/math/interval.h"
#include "alhazen/shapes/blobs/blob.h"
#include "alhazen/shapes/core/shape_numerics.h"

namespace alhazen::blob {

#include "alhazen/shapes/blobs/blob_formula-inl.h"

template <class Real>
inline constexpr double kRounding = std::is_same_v<Real, double> ? 0x1p-53 : kDoubleDoubleUlp;

/// The region of a component along the ray with one quadratic 1 - (distance / radius)^2.
enum class Region : std::uint8_t { Base, Middle, Top };
/// The range of a region, and its quadratic in double: peak - bend (t - middle)^2. If bend is 0 the
/// quadratic is unknown.
struct Bump {
    Interval t;
    double middle = 0, peak = 1, bend = 0;

    [[nodiscard]] bool known() const { return bend > 0.0; }
    [[nodiscard]] double largest(double t0, double t1) const {
        const double off = std::clamp(middle, t0, t1) - middle;
        return peak - bend * off * off;
    }
};
struct Piece {
    std::uint32_t component;
    Region region;
    double in, out;  ///< from the local origin
    Bump bump;
    double room;  ///< bound above the rounding of the bump
};
template <class Real>
struct Vec3Of {
    Real x, y, z;
};
template <class Real>
Vec3Of<Real> cross_of(const Vec3Of<Real>& a, const Vec3Of<Real>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
Real dot_of(const Vec3Of<Real>& a, const Vec3Of<Real>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline double quotient(double a, double b) {
    return a / b;
}
inline BlobLine<double> line_along(const Vec3& d) {
    const double square = length_squared(d);
    return {d.x, d.y, d.z, square, 1.0 / square};
}
/// The ray from a point near the blob, and the polynomials along it.
struct LocalRay {
    const Blob& blob;
    const Ray& given;
    double shift = 0;
    Vec3 o;
    double far;  ///< magnitude of the numbers that o was computed from
    BlobLine<double> line;

    LocalRay(const Blob& b, const Ray& ray)
        : blob(b), given(ray), o(ray.origin), line(line_along(ray.direction)) {
        const Vec3 from_center = ray.origin - b.bounds.center();
        // Not shifted if the origin is near: that would only lose digits of a small t.
        if (length_squared(from_center) > 4.0 * length_squared(b.bounds.size())) {
            shift = -dot(from_center, ray.direction) / line.square;
            o = ray.origin + shift * ray.direction;
        }
        far = max_component(abs(ray.origin)) + std::abs(shift) * max_component(abs(ray.direction));
    }
    /// The margin of a piece of this component.
    [[nodiscard]] double room(const BlobComponent& c) const {
        return 0x1p-46 * (far + blob.reach) / c.radius;
    }

    /// The point at t (from the local origin) relative to `center`.
    template <class Real>
    [[nodiscard]] Vec3Of<Real> from(const Vec3& center, double t) const {
        const auto along = [&](int k) {
            const Real start = Real(given.origin[k]) + Real(shift) * Real(given.direction[k]);
            return (start - Real(center[k])) + Real(t) * Real(given.direction[k]);
        };
        return {along(0), along(1), along(2)};
    }

    /// Adds strength * q^2 of the piece, q its quadratic, in Bernstein form on [t0, t1].
    template <class Real>
    void add(const Piece& piece, double t0, double t1, BernsteinPolynomial<Real, 4>& sum) const {
        const BlobComponent& c = blob.components[piece.component];
        if constexpr (std::is_same_v<Real, double>) {
            if (piece.bump.known()) {
                const Bump& bump = piece.bump;
                take_bump(bump.middle, bump.peak, bump.bend, t0, t1, c.strength,
                          c.strength * (1.0 / 3.0), sum.b.data());
                return add_error(piece, sum);
            }
        }
        const Vec3& center = piece.region == Region::Top ? c.top : c.base;
        Vec3Of<Real> a = from<Real>(center, t0), b = from<Real>(center, t1);
        Real scale = Real(c.radius) * Real(c.radius);
        if (piece.region == Region::Middle) {
            const Vec3Of<Real> e{Real(c.top.x) - Real(c.base.x), Real(c.top.y) - Real(c.base.y),
                                 Real(c.top.z) - Real(c.base.z)};
            a = cross_of(a, e);
            b = cross_of(b, e);
            scale = scale * dot_of(e, e);
        }
        // The blossom of the quadratic.
        const Real q0 = Real(1.0) - quotient(dot_of(a, a), scale);
        const Real q1 = Real(1.0) - quotient(dot_of(a, b), scale);
        const Real q2 = Real(1.0) - quotient(dot_of(b, b), scale);
        take_square<Real>(q0, q1, q2, c.strength, quotient(Real(c.strength), Real(3.0)),
                          sum.b.data());
        add_error(piece, sum);
    }

  private:
    /// Rounding of the points over the radius, of the quadratics, of the products.
    template <class Real>
    void add_error(const Piece& piece, BernsteinPolynomial<Real, 4>& sum) const {
        const BlobComponent& c = blob.components[piece.component];
        const double span = piece.region == Region::Middle ? length(c.top - c.base) : 0.0;
        const double point = 48.0 * (far + blob.reach + max_component(abs(o)) + span) / c.radius;
        sum.error += kRounding<Real> * std::abs(c.strength) * (4.0 * point + 128.0);
    }
};

/// The range where a line from f, relative to an axis or a centre, is closer than the radius.
[[gnu::always_inline]] inline Bump within(const BlobLine<double>& line, const Vec3& f,
                                          double radius) {
    const double squared = radius * radius;
    const auto [middle, room] = nearest_place(line, f.x, f.y, f.z, squared);
    if (!(room > 0.0)) return {};
    const double half = half_chord(line, room), inverse_squared = 1.0 / squared;
    return {{middle - half, middle + half},
            middle,
            room * inverse_squared,
            line.square * inverse_squared};
}

/// True for a ball that the line misses.
inline bool misses_ball(const LocalRay& ray, const BlobComponent& c) {
    const Vec3 f = ray.o - c.base;
    return !c.rod && !(nearest_place(ray.line, f.x, f.y, f.z, c.radius * c.radius).room > 0.0);
}

inline Bump within_rod(const LocalRay& ray, const BlobComponent& c) {
    const Vec3 axis = unit_or(c.top - c.base, {0, 0, 1});
    const Vec3 f = cross(ray.o - c.base, axis), d = cross(ray.given.direction, axis);
    const BlobLine<double> line = line_along(d);
    if (line.square <= 1e-24 * length_squared(ray.given.direction)) {
        return {length(f) < c.radius ? Interval{-kInfinity, kInfinity} : Interval{}};
    }
    return within(line, f, c.radius);
}

/// The intersection of two intervals.
inline Interval meeting(const Interval& a, const Interval& b) {
    return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

inline void add_rod(const LocalRay& ray, std::uint32_t number, std::vector<Piece>& pieces) {
    const BlobComponent& c = ray.blob.components[number];
    constexpr Interval kWholeLine{-kInfinity, kInfinity};
    const auto add = [&](Region region, const Interval& part, const Bump& bump) {
        const Interval t = meeting(part, bump.t);
        if (t.lo < t.hi && std::isfinite(t.lo) && std::isfinite(t.hi)) {
            pieces.push_back({number, region, t.lo, t.hi, bump, ray.room(c)});
        }
    };
    const Vec3 e = c.top - c.base;
    const double start = dot(ray.o - c.base, e), speed = dot(ray.given.direction, e);
    Interval before = kWholeLine, between = before, behind = before;
    if (speed == 0.0) {
        if (start >= 0.0) before = {};
        if (start < 0.0 || start > length_squared(e)) between = {};
        if (start <= length_squared(e)) behind = {};
    } else {
        const double at_base = -start / speed, at_top = (length_squared(e) - start) / speed;
        between = {std::min(at_base, at_top), std::max(at_base, at_top)};
        before = {-kInfinity, between.lo};
        behind = {between.hi, kInfinity};
        if (speed < 0.0) std::swap(before, behind);
    }
    add(Region::Base, before, within(ray.line, ray.o - c.base, c.radius));
    add(Region::Middle, between, within_rod(ray, c));
    add(Region::Top, behind, within(ray.line, ray.o - c.top, c.radius));
}

inline void add_pieces(const LocalRay& ray, std::uint32_t number, std::vector<Piece>& pieces) {
    const BlobComponent& c = ray.blob.components[number];
    if (c.rod) return add_rod(ray, number, pieces);
    const Bump bump = within(ray.line, ray.o - c.base, c.radius);
    if (bump.t.lo < bump.t.hi && std::isfinite(bump.t.lo) && std::isfinite(bump.t.hi)) {
        pieces.push_back({number, Region::Base, bump.t.lo, bump.t.hi, bump, ray.room(c)});
    }
}

}  // namespace alhazen::blob
