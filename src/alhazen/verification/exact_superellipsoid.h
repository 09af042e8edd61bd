#pragma once
/// All crossings of a line with a superellipsoid, for any number type.
///
/// Source: Barr, "Superquadrics and Angle-Preserving Transformations", IEEE CG&A 1(1), 1981;
/// Kelley, "The Cutting-Plane Method for Solving Convex Programs", SIAM J. 8, 1960 (a convex
/// function lies above its tangents).
/// Differs: the function is convex if both exponents 2 / e and 2 / n are at least 1, and concave
/// within each octant if both are at most 1. Either has at most two zeros; tangents decide whether
/// it has any. No interval arithmetic. For other exponents see exact_mixed_superellipsoid.h.

#include "alhazen/verification/exact_mixed_superellipsoid.h"

namespace alhazen {

/// The function minus 1 and its derivative along a line; t is relative to `start`.
template <class R>
class SuperellipsoidAlong {
  public:
    struct Value {
        R value, slope;
    };

    SuperellipsoidAlong(const Superellipsoid& solid, const LineOf<R>& line)
        : p_(solid.p), q_(solid.q), line_(line) {}

    [[nodiscard]] Value at(const R& t) const {
        R value[3], slope[3];
        for (int k = 0; k < 3; ++k) {
            const double n = k < 2 ? p_ : q_;
            const R x = line_.origin[k] + t * line_.direction[k];
            const R size = x < 0 ? -x : x;
            value[k] = power_of(size, n);
            slope[k] = size > 0 ? R(n) * value[k] / x * line_.direction[k] : R(0);
        }
        const R across = value[0] + value[1];
        const R ratio = R(q_) / R(p_);
        const R bent = p_ == q_ ? across : power_of(across, ratio);
        const R factor = across > 0 ? ratio * bent / across : R(0);
        return {bent + value[2] - 1, factor * (slope[0] + slope[1]) + slope[2]};
    }

  private:
    double p_, q_;
    const LineOf<R>& line_;
};

/// A convex function with known ends: f, or -f if f is concave.
template <class R>
class ConvexCrossings {
  public:
    using Function = SuperellipsoidAlong<R>;
    ConvexCrossings(const Function& f, bool concave) : f_(f), sign_(concave ? -1 : 1) {}

    /// Sign changes between lo and hi, ascending.
    void add(const R& lo, const R& hi, std::vector<R>& t) const {
        const bool negative_lo = at(lo).value < 0, negative_hi = at(hi).value < 0;
        if (negative_lo && negative_hi) return;
        if (negative_lo != negative_hi) {
            t.push_back(root(lo, hi, negative_lo));
            return;
        }
        R between;
        if (!negative_between(lo, hi, between)) return;
        t.push_back(root(lo, between, false));
        t.push_back(root(between, hi, true));
    }

  private:
    using Value = typename Function::Value;
    [[nodiscard]] Value at(const R& t) const {
        const Value v = f_.at(t);
        return {sign_ * v.value, sign_ * v.slope};
    }
    /// True if the function is negative at a point, `found`. Bisects, or takes the intersection of
    /// the tangents at the ends, which is a lower bound of the values. The initial ends have no
    /// tangents: they may lie in planes of symmetry, where the slope is unbounded.
    bool negative_between(R lo, R hi, R& found) const {
        Value a{}, b{};
        bool has_a = false, has_b = false;
        for (int i = 0; i < 230; ++i) {
            R middle = (lo + hi) / 2;
            if (has_a && has_b) {
                const R meet =
                    (b.value - a.value + a.slope * lo - b.slope * hi) / (a.slope - b.slope);
                if (a.value + a.slope * (meet - lo) > 0) return false;
                if (i % 3 != 0 && meet > lo && meet < hi) middle = meet;
            }
            if (!(lo < middle && middle < hi)) return false;
            const Value m = at(middle);
            if (m.value < 0) {
                found = middle;
                return true;
            }
            const bool falls = m.slope < 0;
            (falls ? lo : hi) = middle;
            (falls ? a : b) = m;
            (falls ? has_a : has_b) = true;
        }
        return false;
    }
    [[nodiscard]] R root(const R& lo, const R& hi, bool negative_at_lo) const {
        R slope = 0;
        return bracketed_zero(
            [&](const R& t) {
                const Value v = at(t);
                slope = v.slope;
                return v.value;
            },
            [&](const R&) { return slope; }, lo, hi, negative_at_lo);
    }

    const Function& f_;
    int sign_;
};

template <class R>
CrossingsOf<R> exact_crossings(const Superellipsoid& solid, const LineOf<R>& given) {
    const LineOf<R> line = in_frame(solid.frame, given);
    ClippedPart<R> part;
    part.cut(solid.frame, line, Box3{{-1, -1, -1}, {1, 1, 1}});
    if (part.empty()) return {};
    const bool convex = solid.p >= 1 && solid.q >= 1;
    const bool mixed = (solid.p > 1 && solid.q < 1) || (solid.p < 1 && solid.q > 1);
    std::vector<R> ends{part.lo, part.hi};  // with the planes of symmetry in between
    for (int k = 0; k < 3 && !convex; ++k) {
        if (line.direction[k] == 0) continue;
        const R t = -line.origin[k] / line.direction[k];
        if (t > part.lo && t < part.hi) ends.push_back(t);
    }
    std::sort(ends.begin(), ends.end());
    if (mixed) return {false, mixed_crossings(solid, line, ends)};
    const SuperellipsoidAlong<R> f(solid, line);
    CrossingsOf<R> found;
    const ConvexCrossings<R> crossings(f, !convex);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        crossings.add(ends[i], ends[i + 1], found.t);
    }
    return found;
}

}  // namespace alhazen
