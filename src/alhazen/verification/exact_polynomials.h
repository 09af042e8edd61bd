#pragma once
/// All crossings of a line with solids f(x, y, z) < 0 with polynomial f (quadrics, the torus, the
/// truncated general cone and algebraic surfaces), for any number type.
///
/// Source: the definitions in the headers of the shapes; Yuksel, "A Fast and Robust Polynomial
/// Solver in Computer Graphics", HPG 2022 (a polynomial is monotone between the roots of its
/// derivative).
/// Differs: f along the line is expanded in powers of t about the point nearest to the middle of
/// the clip, and brackets are halved until they are as short as the numbers allow. Uses neither
/// Bernstein forms nor error bounds: it shares no code with the tested implementation. The stored
/// frame of a shape defines the shape.

#include <limits>
#include <optional>

#include "alhazen/shapes/shape_list.h"
#include "alhazen/verification/exact_line.h"

namespace alhazen {

template <class R>
inline const R kInfinitelyFar = R(std::numeric_limits<double>::infinity());

// ---- Polynomials of one variable: [i] is the coefficient of t^i.

template <class R>
using PowersOf = std::vector<R>;

template <class R>
PowersOf<R> product(const PowersOf<R>& a, const PowersOf<R>& b) {
    PowersOf<R> c(a.size() + b.size() - 1, R(0));
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
    }
    return c;
}
/// a + factor b.
template <class R>
PowersOf<R> sum(const PowersOf<R>& a, const PowersOf<R>& b, const R& factor) {
    PowersOf<R> s = a;
    s.resize(std::max(a.size(), b.size()), R(0));
    for (std::size_t i = 0; i < b.size(); ++i) s[i] += factor * b[i];
    return s;
}
template <class R>
R value_at(const PowersOf<R>& p, const R& t) {
    R value = 0;
    for (std::size_t i = p.size(); i-- > 0;) value = value * t + p[i];
    return value;
}
template <class R>
PowersOf<R> derivative(const PowersOf<R>& p) {
    PowersOf<R> d;
    for (std::size_t i = 1; i < p.size(); ++i) d.push_back(R(static_cast<double>(i)) * p[i]);
    return d;
}

/// The sign change of `value(t)` between lo and hi; it is negative at exactly one of them.
/// `slope(t)` is its derivative.
template <class R, class Value, class Slope>
R bracketed_zero(Value&& value, Slope&& slope, R lo, R hi, bool negative_at_lo) {
    R t = (lo + hi) / 2;
    for (int i = 0; i < 250 && lo < t && t < hi; ++i) {
        const R v = value(t);
        (negative_at_lo == (v < 0) ? lo : hi) = t;
        const R next = t - v / slope(t);
        // Newton's step if it stays inside the bracket; bisection every fourth time.
        const R step = next > t ? next - t : t - next;
        if (next > lo && next < hi && i % 4 != 3) {
            if (step <= R(0x1p-100) * (t < 0 ? -t : t)) return next;
            t = next;
        } else {
            t = (lo + hi) / 2;
        }
    }
    return t;
}

/// Sign changes of p between lo and hi, where its signs are given, ascending.
template <class R>
std::vector<R> sign_changes(const PowersOf<R>& p, const R& lo, const R& hi, bool negative_at_lo,
                            bool negative_at_hi);

/// Sign changes of p in (lo, hi), ascending.
template <class R>
std::vector<R> sign_changes(PowersOf<R> p, const R& lo, const R& hi) {
    while (!p.empty() && p.back() == 0) p.pop_back();
    if (p.size() < 2) return {};
    return sign_changes(p, lo, hi, value_at(p, lo) < 0, value_at(p, hi) < 0);
}

template <class R>
std::vector<R> sign_changes(const PowersOf<R>& p, const R& lo, const R& hi, bool negative_at_lo,
                            bool negative_at_hi) {
    const PowersOf<R> slope = derivative(p);
    std::vector<R> ends{lo};
    for (const R& turn : sign_changes(slope, lo, hi)) ends.push_back(turn);
    ends.push_back(hi);
    std::vector<R> changes;
    bool negative = negative_at_lo;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const bool last = i + 1 == ends.size();
        const bool next = last ? negative_at_hi : value_at(p, ends[i]) < 0;
        if (next != negative) {
            changes.push_back(bracketed_zero([&](const R& t) { return value_at(p, t); },
                                             [&](const R& t) { return value_at(slope, t); },
                                             ends[i - 1], ends[i], negative));
        }
        negative = next;
    }
    return changes;
}

// ---- Clips.

/// The part of a line within a clip; initially the whole line.
template <class R>
struct ClippedPart {
    R lo = -kInfinitelyFar<R>, hi = kInfinitelyFar<R>;

    [[nodiscard]] bool empty() const { return !(lo < hi); }
    /// Clips to least <= a + b t <= most. Of the lines along an end those at `most` are inside, or
    /// those at `least`.
    void cut(const R& a, const R& b, double least, double most, bool keeps_most = true) {
        if (b == 0) {
            const bool inside =
                keeps_most ? R(least) < a && a <= R(most) : R(least) <= a && a < R(most);
            if (!inside) hi = lo;
            return;
        }
        const R first = (R(b > 0 ? least : most) - a) / b, last = (R(b > 0 ? most : least) - a) / b;
        if (first > lo) lo = first;
        if (last < hi) hi = last;
    }
    /// `line` and the clips are in the frame.
    void cut(const SolidFrame& frame, const LineOf<R>& line, const Box3& box) {
        for (int k = 0; k < 3; ++k) {
            cut(line.origin[k], line.direction[k], box.lo[k], box.hi[k],
                keeps_face(frame.normal_of(k)));
        }
    }
    void cut(const SolidFrame& frame, const LineOf<R>& line, const std::vector<ClipPlane>& planes) {
        for (const ClipPlane& plane : planes) {
            const Vec3Of<R> n(plane.normal);
            cut(dot(n, line.origin), dot(n, line.direction),
                -std::numeric_limits<double>::infinity(), plane.offset,
                keeps_face(transpose_times(frame.local_from_object, plane.normal)));
        }
    }
};

/// A line in the frame of a solid.
template <class R>
LineOf<R> in_frame(const SolidFrame& frame, const LineOf<R>& line) {
    const Mat3& m = frame.local_from_object;
    const auto local = [&](const Vec3Of<R>& v) {
        return v.x * Vec3Of<R>(m.x_axis) + v.y * Vec3Of<R>(m.y_axis) + v.z * Vec3Of<R>(m.z_axis);
    };
    return {local(line.origin - Vec3Of<R>(frame.origin)), local(line.direction)};
}

/// The parts where p < 0; p is in powers of t - `middle`. Precondition: the part is finite.
template <class R>
CrossingsOf<R> where_negative(const PowersOf<R>& p, const R& middle, const ClippedPart<R>& part) {
    const R lo = part.lo - middle, hi = part.hi - middle;
    CrossingsOf<R> found;
    if (value_at(p, lo) < 0) found.t.push_back(part.lo);
    for (const R& t : sign_changes(p, lo, hi)) found.t.push_back(middle + t);
    if (value_at(p, hi) < 0) found.t.push_back(part.hi);
    return found;
}

/// x, y and z along the line in powers of t - `middle`.
template <class R>
struct CoordinatesOf {
    PowersOf<R> x, y, z;

    CoordinatesOf(const LineOf<R>& line, const R& middle) {
        const Vec3Of<R> at = line.origin + middle * line.direction;
        x = {at.x, line.direction.x};
        y = {at.y, line.direction.y};
        z = {at.z, line.direction.z};
    }
};

/// The parts in the box, of a line in the frame, where a polynomial `f(coordinates)` is negative.
template <class R, class F>
CrossingsOf<R> negative_in_box(const SolidFrame& frame, const LineOf<R>& line, const Box3& box,
                               F&& f) {
    ClippedPart<R> part;
    part.cut(frame, line, box);
    if (part.empty()) return {};
    const R middle = (part.lo + part.hi) / 2;
    return where_negative(f(CoordinatesOf<R>(line, middle)), middle, part);
}

// ---- Shapes.

template <class R>
CrossingsOf<R> exact_crossings(const ClippedQuadric& solid, const LineOf<R>& given) {
    const LineOf<R> line = in_frame(solid.frame, given);
    ClippedPart<R> part;
    part.cut(solid.frame, line, solid.clip_box);
    part.cut(solid.frame, line, solid.planes);
    if (part.empty()) return {};
    const QuadricForm& f = solid.quadric.form();
    const auto bilinear = [&](const Vec3Of<R>& p, const Vec3Of<R>& q) {
        return R(f.xx) * p.x * q.x + R(f.yy) * p.y * q.y + R(f.zz) * p.z * q.z +
               R(f.xy) * (p.x * q.y + p.y * q.x) + R(f.yz) * (p.y * q.z + p.z * q.y) +
               R(f.zx) * (p.z * q.x + p.x * q.z);
    };
    const Vec3Of<R> linear(R(f.x), R(f.y), R(f.z));
    const Vec3Of<R>&o = line.origin, &d = line.direction;
    // a t^2 + 2 b t + c
    const R a = bilinear(d, d), b = bilinear(o, d) + dot(linear, d);
    const R c = bilinear(o, o) + 2 * dot(linear, o) + R(f.c);
    // The negative part lies between the roots, or outside them.
    std::vector<R> roots;
    bool negative = c < 0;
    if (a != 0) {
        roots = quadratic_roots<R>(a, b, c);
        negative = a < 0;
    } else if (b != 0) {
        roots = {-c / (2 * b)};
        negative = b > 0;
    }
    CrossingsOf<R> found;
    for (const R& root : roots) {
        if (root <= part.lo) negative = !negative;
    }
    if (negative && part.lo == -kInfinitelyFar<R>) {
        found.begins_inside = true;
    } else if (negative) {
        found.t.push_back(part.lo);
    }
    for (const R& root : roots) {
        if (root <= part.lo || root >= part.hi) continue;
        found.t.push_back(root);
        negative = !negative;
    }
    if (negative && part.hi < kInfinitelyFar<R>) found.t.push_back(part.hi);
    return found;
}

/// A shape that is a clipped quadric.
template <class S>
concept IsClippedQuadric = std::same_as<S, Ellipsoid> || std::same_as<S, EllipticCylinder> ||
    std::same_as<S, EllipticCone> || std::same_as<S, Paraboloid> || std::same_as<S, Hyperboloid> ||
    std::same_as<S, TwoSheetHyperboloid> || std::same_as<S, Quadric>;

template <class R, IsClippedQuadric S>
CrossingsOf<R> exact_crossings(const S& shape, const LineOf<R>& line) {
    return exact_crossings(shape.solid, line);
}

template <class R>
CrossingsOf<R> exact_crossings(const Torus& torus, const LineOf<R>& given) {
    const LineOf<R> line = in_frame(torus.frame, given);
    const R r = torus.tube;
    const double reach = 2.0 + 2.0 * torus.tube;
    const Box3 around{{-reach, -reach, -reach}, {reach, reach, reach}};
    return negative_in_box(torus.frame, line, around, [&](const CoordinatesOf<R>& at) {
        const PowersOf<R> across = sum(product(at.x, at.x), product(at.y, at.y), R(1));
        const PowersOf<R> squared = sum(across, product(at.z, at.z), R(1));
        const PowersOf<R> a = sum(squared, PowersOf<R>{1 - r * r}, R(1));
        return sum(product(a, a), across, R(-4));
    });
}

template <class R>
CrossingsOf<R> exact_crossings(const Tgc& cone, const LineOf<R>& given) {
    if (!cone.quartic) return exact_crossings(cone.solid, given);
    const LineOf<R> line = in_frame(cone.solid.frame, given);
    const Box3 around{{-2, -2, 0}, {2, 2, 1}};
    return negative_in_box(cone.solid.frame, line, around, [&](const CoordinatesOf<R>& at) {
        // With the semi-axes at the height: (x b)^2 + (y a)^2 - (a b)^2.
        const auto between = [&](double at_base, double at_top) {
            const PowersOf<R> none{R(at_base)};
            return sum(none, at.z, R(at_top) - R(at_base));
        };
        const PowersOf<R> a = between(cone.a0, cone.a1), b = between(cone.b0, cone.b1);
        const PowersOf<R> xb = product(at.x, b), ya = product(at.y, a), ab = product(a, b);
        return sum(sum(product(xb, xb), product(ya, ya), R(1)), product(ab, ab), R(-1));
    });
}

template <class R>
CrossingsOf<R> exact_crossings(const Algebraic& surface, const LineOf<R>& line) {
    using Op = PolynomialExpression::Op;
    return negative_in_box(SolidFrame{}, line, surface.clip_box, [&](const CoordinatesOf<R>& at) {
        std::vector<PowersOf<R>> of;
        for (const PolynomialExpression::Node& n : surface.polynomial->nodes()) {
            switch (n.op) {
                case Op::Constant:
                    of.push_back({R(n.constant.high) + R(n.constant.low)});
                    break;
                case Op::X:
                    of.push_back(at.x);
                    break;
                case Op::Y:
                    of.push_back(at.y);
                    break;
                case Op::Z:
                    of.push_back(at.z);
                    break;
                case Op::Add:
                    of.push_back(sum(of[n.a], of[n.b], R(1)));
                    break;
                case Op::Subtract:
                    of.push_back(sum(of[n.a], of[n.b], R(-1)));
                    break;
                case Op::Multiply:
                    of.push_back(product(of[n.a], of[n.b]));
                    break;
            }
        }
        return of.back();
    });
}

}  // namespace alhazen
