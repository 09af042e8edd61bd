#pragma once
/// All crossings of a line with prisms and lathes, for any number type.
///
/// Source: the definitions in shapes/swept/prism.h and shapes/swept/lathe.h.
/// Differs: powers of the curve's parameter, about a value near all roots, and brackets by the
/// roots of the derivative (exact_polynomials.h); no Bernstein forms, no error bounds.
/// Conventions: the inside lies between an odd and an even crossing, counted from a point that is
/// certainly outside.

#include "alhazen/verification/exact_polynomials.h"

namespace alhazen {

template <class R>
struct PointOf {
    R x, y;
};

/// A curve of a profile in powers of u - `about`.
template <class R>
struct ProfilePowers {
    PowersOf<R> x, y;

    ProfilePowers(const ProfileCurve& curve, const R& about) {
        x = powers(curve, about, [](const Vec2& p) { return R(p.x); });
        y = powers(curve, about, [](const Vec2& p) { return R(p.y); });
    }
    template <class Coordinate>
    static PowersOf<R> powers(const ProfileCurve& curve, const R& about, Coordinate&& of) {
        const R a = of(curve.p[0]), d = of(curve.p[3]);
        if (curve.line) return {a + about * (d - a), d - a};
        const R b = of(curve.p[1]), c = of(curve.p[2]);
        const R c1 = 3 * (b - a), c2 = 3 * (a - 2 * b + c), c3 = d - a + 3 * (b - c);
        return {a + about * (c1 + about * (c2 + about * c3)),
                c1 + about * (2 * c2 + about * 3 * c3), c2 + 3 * about * c3, c3};
    }
    [[nodiscard]] PointOf<R> point(const R& u) const { return {value_at(x, u), value_at(y, u)}; }
};

// ---- Prisms.

/// True if a point of the profile's plane is inside the loops: counts the crossings to its right.
template <class R>
bool is_within(const Profile& profile, const PointOf<R>& point) {
    bool inside = false;
    for (const ProfileCurve& curve : profile.curves) {
        ProfilePowers<R> at(curve, R(0));
        at.y[0] = at.y[0] - point.y;
        const bool from = R(curve.p[0].y) < point.y, to = R(curve.p[3].y) < point.y;
        for (const R& u : sign_changes(at.y, R(0), R(1), from, to)) {
            if (value_at(at.x, u) >= point.x) inside = !inside;
        }
    }
    return inside;
}

template <class R>
CrossingsOf<R> exact_crossings(const Prism& prism, const LineOf<R>& line) {
    const Vec3Of<R>&o = line.origin, &d = line.direction;
    ClippedPart<R> part;
    part.cut(o.z, d.z, prism.h0, prism.h1);
    if (part.empty()) return {};
    // The section has the size s0 + t s1. The line intersects the profile point (x, y) at the zeros
    // of a x + b y + c.
    const R s0 = R(1) + R(prism.growth) * (o.z - R(prism.h0)), s1 = R(prism.growth) * d.z;
    R a = s1 * o.y - s0 * d.y, b = s0 * d.x - s1 * o.x, c = o.x * d.y - o.y * d.x;
    // A point on the line is on its positive side: `keeps_face`.
    if (d.y > 0 || (d.y == 0 && d.x < 0)) {
        a = -a;
        b = -b;
        c = -c;
    }
    const auto size_at = [&](const R& t) { return s0 + t * s1; };
    if (a == 0 && b == 0) {
        // The line projects to one profile point.
        if (d.z == 0) return {};
        const R middle = (part.lo + part.hi) / 2, size = size_at(middle);
        const PointOf<R> point{(o.x + middle * d.x) / size, (o.y + middle * d.y) / size};
        if (!is_within(prism.profile, point)) return {};
        return {false, {part.lo, part.hi}};
    }
    std::vector<R> t;
    for (const ProfileCurve& curve : prism.profile.curves) {
        const ProfilePowers<R> at(curve, R(0));
        PowersOf<R> p = sum(sum(PowersOf<R>{c}, at.x, a), at.y, b);
        const auto negative = [&](const Vec2& q) { return a * R(q.x) + b * R(q.y) + c < 0; };
        for (const R& u : sign_changes(p, R(0), R(1), negative(curve.p[0]), negative(curve.p[3]))) {
            const PointOf<R> q = at.point(u);
            // t (d - s1 q) = s0 q - o, solved in the better conditioned coordinate.
            const R dx = d.x - s1 * q.x, dy = d.y - s1 * q.y;
            const R x2 = dx * dx, y2 = dy * dy;
            const R crossing = x2 > y2 ? (s0 * q.x - o.x) / dx : (s0 * q.y - o.y) / dy;
            if (size_at(crossing) > 0) t.push_back(crossing);
        }
    }
    std::sort(t.begin(), t.end());
    // The line is outside where the size is 0. If the size shrinks with t, an odd number of
    // crossings means that the line begins inside.
    CrossingsOf<R> inside{s1 < 0 && t.size() % 2 != 0, std::move(t)};
    CrossingsOf<R> found;
    if (inside.inside_at(part.lo)) found.t.push_back(part.lo);
    for (const R& at : inside.t) {
        if (at > part.lo && at < part.hi) found.t.push_back(at);
    }
    if (inside.inside_at(part.hi)) found.t.push_back(part.hi);
    return found;
}

// ---- Lathes.

/// Squared distance of a line from the axis, as a t^2 + c, where t = 0 is the point nearest to the
/// axis (for a line along the axis, the height of the middle), at height z.
template <class R>
struct LineAroundAxis {
    R nearest, a, c, z, climb;

    LineAroundAxis(const Lathe& lathe, const LineOf<R>& line) {
        const Vec3Of<R>&o = line.origin, &d = line.direction;
        a = d.x * d.x + d.y * d.y;
        climb = d.z;
        nearest = a > 0 ? -(o.x * d.x + o.y * d.y) / a : (R(lathe.center.z) - o.z) / d.z;
        z = o.z + nearest * d.z;
        const R x = o.x + nearest * d.x, y = o.y + nearest * d.y;
        c = x * x + y * y;
    }
    /// Positive if the line, at the height of the point, is farther from the axis than the point.
    /// Precondition: the line is not level.
    [[nodiscard]] R beyond(const PointOf<R>& p) const {
        const R t = (p.y - z) / climb;
        return a * t * t + c - p.x * p.x;
    }
};

/// Adds the crossings with a monotone piece of a curve; t = 0 is the nearest point of the line.
template <class R>
void add_crossings(const LineAroundAxis<R>& line, const ProfileCurve& curve, const R& from,
                   const R& to, const PointOf<R>& first, const PointOf<R>& last,
                   std::vector<R>& t) {
    // Expanded about the height of the nearest point, or the end closest to it.
    const ProfilePowers<R> whole(curve, R(0));
    PowersOf<R> rise = whole.y;
    rise[0] = rise[0] - line.z;
    const R low = first.y - line.z, high = last.y - line.z;
    const bool between = (low < 0) != (high < 0);
    R about = (low < 0 ? -low : low) < (high < 0 ? -high : high) ? from : to;
    if (between) {
        const std::vector<R> at = sign_changes(rise, from, to, low < 0, high < 0);
        if (!at.empty()) about = at.front();
    }
    const ProfilePowers<R> near(curve, about);
    PowersOf<R> climbed = near.y;
    climbed[0] = between ? R(0) : climbed[0] - line.z;
    for (R& c : climbed) c = c / line.climb;
    const PowersOf<R> p = sum(sum(PowersOf<R>{line.c}, product(climbed, climbed), line.a),
                              product(near.x, near.x), R(-1));
    for (const R& u : sign_changes(p, R(from - about), R(to - about), line.beyond(first) < 0,
                                   line.beyond(last) < 0)) {
        t.push_back(value_at(climbed, u));
    }
}

template <class R>
CrossingsOf<R> exact_crossings(const Lathe& lathe, const LineOf<R>& given) {
    const LineAroundAxis<R> line(lathe, given);
    std::vector<R> t;
    for (const ProfileCurve& curve : lathe.profile.curves) {
        const ProfilePowers<R> whole(curve, R(0));
        const auto end = [](const Vec2& p) { return PointOf<R>{R(p.x), R(p.y)}; };
        if (line.climb == 0) {
            // The circles of the profile points at this height.
            PowersOf<R> rise = whole.y;
            rise[0] = rise[0] - line.z;
            const bool from = end(curve.p[0]).y < line.z, to = end(curve.p[3]).y < line.z;
            for (const R& u : sign_changes(rise, R(0), R(1), from, to)) {
                const R radius = value_at(whole.x, u);
                for (const R& at : quadratic_roots<R>(line.a, R(0), line.c - radius * radius)) {
                    t.push_back(at);
                }
            }
            continue;
        }
        R from = 0;
        PointOf<R> first = end(curve.p[0]);
        std::vector<R> turns = sign_changes(derivative(whole.y), R(0), R(1));
        turns.push_back(1);
        for (std::size_t i = 0; i < turns.size(); ++i) {
            const PointOf<R> last = i + 1 < turns.size() ? whole.point(turns[i]) : end(curve.p[3]);
            add_crossings(line, curve, from, turns[i], first, last, t);
            from = turns[i];
            first = last;
        }
    }
    for (R& at : t) at = line.nearest + at;
    std::sort(t.begin(), t.end());
    return {false, std::move(t)};
}

}  // namespace alhazen
