#pragma once
/// Lines and their parts inside solids, for any number type.
///
/// Conventions: t is in units of the direction's length; crossings ascend, and each changes between
/// inside and outside.

#include <algorithm>
#include <vector>

#include "alhazen/math/affine.h"
#include "alhazen/math/real128.h"

namespace alhazen {

template <class R>
struct Vec3Of {
    R x, y, z;

    Vec3Of() = default;
    Vec3Of(R x_, R y_, R z_) : x(x_), y(y_), z(z_) {}
    explicit Vec3Of(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
    friend Vec3Of operator+(const Vec3Of& a, const Vec3Of& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Vec3Of operator-(const Vec3Of& a, const Vec3Of& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Vec3Of operator*(const R& s, const Vec3Of& a) { return {s * a.x, s * a.y, s * a.z}; }
    friend R dot(const Vec3Of& a, const Vec3Of& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    [[nodiscard]] const R& operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
};

template <class R>
struct LineOf {
    Vec3Of<R> origin, direction;
};
using ExactLine = LineOf<Real128>;

template <class R>
LineOf<R> transformed(const Affine& m, const LineOf<R>& line) {
    const auto linear = [&](const Vec3Of<R>& v) {
        return v.x * Vec3Of<R>(m.linear.x_axis) + v.y * Vec3Of<R>(m.linear.y_axis) +
               v.z * Vec3Of<R>(m.linear.z_axis);
    };
    return {linear(line.origin) + Vec3Of<R>(m.translation), linear(line.direction)};
}

/// The inside of a solid along a line: whether the line begins inside, and the crossings.
template <class R>
struct CrossingsOf {
    bool begins_inside = false;
    std::vector<R> t;

    [[nodiscard]] bool inside_at(const R& at) const {
        const auto before = std::upper_bound(t.begin(), t.end(), at) - t.begin();
        return begins_inside != (before % 2 != 0);
    }
};
using ExactCrossings = CrossingsOf<Real128>;

// ---- Formulas.

/// Roots of a t^2 + 2 b t + c for a != 0, ascending; none or two.
template <class R>
std::vector<R> quadratic_roots(const R& a, const R& b, const R& c) {
    const R discriminant = b * b - a * c;
    if (!(discriminant > 0)) return {};
    const R s = square_root(discriminant);
    const R q = b > 0 ? -(b + s) : s - b;
    const R t0 = q / a;
    const R t1 = q != 0 ? c / q : t0;
    if (t0 < t1) return {t0, t1};
    return {t1, t0};
}

/// The part of a line between two values of one coordinate. A line along the face at hi is inside,
/// one along that at lo is not, or the other way round (`keeps_face` of shape_numerics.h).
template <class R>
struct SlabOf {
    bool empty = false, unlimited = false;
    R lo{}, hi{};
};
template <class R>
SlabOf<R> slab(const R& origin, const R& direction, const R& lo, const R& hi,
               bool keeps_hi = true) {
    if (direction == 0) {
        const bool inside = keeps_hi ? lo < origin && origin <= hi : lo <= origin && origin < hi;
        return {!inside, true};
    }
    const R a = (lo - origin) / direction, b = (hi - origin) / direction;
    return {false, false, a < b ? a : b, a < b ? b : a};
}

}  // namespace alhazen
