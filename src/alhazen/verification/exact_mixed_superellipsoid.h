#pragma once
/// All crossings of a line with a superellipsoid that has one exponent above 2 and one below, for
/// any number type.
///
/// Source: Barr, "Superquadrics and Angle-Preserving Transformations", IEEE CG&A 1(1), 1981; Horst
/// and Thoai, "DC Programming: Overview", Journal of Optimization Theory and Applications 103, 1999
/// (bounds of a difference of two convex functions from bounds of each).
/// Differs: on one side of all planes of symmetry the solid is where N = (|x|^p + |y|^p)^(1/p) is
/// less than g = (1 - |z|^q)^(1/q). Along a line both are concave (p < 1 < q) or both convex, so
/// their slopes at the ends of a part bound the slope of N - g in between; parts that may contain
/// an extremum are halved.

#include <vector>

#include "alhazen/verification/exact_polynomials.h"
#include "alhazen/verification/exact_power.h"

namespace alhazen {

/// N and g along a line, on one side of all planes of symmetry.
template <class R>
class MixedSuperellipsoid {
  public:
    struct Value {
        R t;
        R height;          ///< N - g: negative inside
        R outward, upper;  ///< slopes of N and g; infinite or NaN at a plane of symmetry
    };

    /// `middle`: a t inside the part, off the planes of symmetry.
    MixedSuperellipsoid(const Superellipsoid& solid, const LineOf<R>& line, const R& middle)
        : p_(solid.p), q_(solid.q), line_(line) {
        for (int k = 0; k < 3; ++k) {
            const bool negative = line.origin[k] + middle * line.direction[k] < 0;
            rate_[k] = negative ? -line.direction[k] : line.direction[k];
        }
    }

    [[nodiscard]] Value at(const R& t) const {
        const R x = size(0, t), y = size(1, t), z = size(2, t);
        const R &most = x > y ? x : y, &least = x > y ? y : x;
        // The sum of the powers could underflow.
        const R share = most > 0 ? power_of(R(least / most), p_) : R(0);
        const R n = most * power_of(R(1 + share), 1 / p_);
        const R of_most = 1 / (1 + share), of_least = share / (1 + share);  // powers over n^p
        const R height = power_of(z, q_), rest = 1 - height;
        const R g = power_of(rest, 1 / q_);
        return {t, n - g,
                slope(x, n, x > y ? of_most : of_least, p_, rate_[0]) +
                    slope(y, n, x > y ? of_least : of_most, p_, rate_[1]),
                -slope(z, g, R(height / rest), q_, rate_[2])};
    }

  private:
    [[nodiscard]] R size(int k, const R& t) const {
        const R at = line_.origin[k] + t * line_.direction[k];
        return at < 0 ? -at : at;
    }
    /// (a / b)^(exponent - 1) rate; `power` is (a / b)^exponent.
    static R slope(const R& a, const R& b, const R& power, const R& exponent, const R& rate) {
        if (rate == 0) return 0;
        if (!(b > 0)) return R(0) / R(0);  // unknown: a NaN implies nothing
        if (a > 0) return power * (b / a) * rate;
        return exponent > 1 ? R(0) : rate / R(0);
    }

    R p_, q_;
    const LineOf<R>& line_;
    R rate_[3];  ///< rate of change of |x|, |y| and |z|
};

template <class R>
class MixedSearch {
  public:
    using Value = typename MixedSuperellipsoid<R>::Value;

    MixedSearch(const MixedSuperellipsoid<R>& f, bool concave, std::vector<R>& found)
        : f_(f), concave_(concave), found_(found) {}

    void search(const Value& a, const Value& b, int halvings) {
        const bool turns = (a.height < 0) != (b.height < 0);
        // The slope of a concave function decreases along the line.
        const Value &first = concave_ ? b : a, &last = concave_ ? a : b;
        const R least = first.outward - last.upper, most = last.outward - first.upper;
        const bool monotone = least >= 0 || most <= 0;
        if (monotone || halvings == 0) {
            if (turns) found_.push_back(root(a, b));
            return;
        }
        if (!turns && keeps_away(a, b, least, most)) return;
        const R t = (a.t + b.t) / 2;
        if (!(a.t < t && t < b.t)) return search(a, b, 0);
        const Value middle = f_.at(t);
        search(a, middle, halvings - 1);
        search(middle, b, halvings - 1);
    }

  private:
    /// True if the function, with slopes in this range, keeps its sign between the ends. The lines
    /// with slope `least` from a and `most` from b, or vice versa, meet at the extreme value.
    static bool keeps_away(const Value& a, const Value& b, const R& least, const R& most) {
        const bool below = a.height < 0;
        const R &from_a = below ? most : least, &from_b = below ? least : most;
        const R way = b.height - a.height - from_b * (b.t - a.t);
        const R meet = a.height + from_a * way / (from_a - from_b);
        return below ? meet < 0 : meet > 0;
    }

    [[nodiscard]] R root(const Value& a, const Value& b) const {
        R slope = 0;
        return bracketed_zero(
            [&](const R& t) {
                const Value v = f_.at(t);
                slope = v.outward - v.upper;
                return v.height;
            },
            [&](const R&) { return slope; }, a.t, b.t, a.height < 0);
    }

    const MixedSuperellipsoid<R>& f_;
    bool concave_;
    std::vector<R>& found_;
};

/// `ends`: the ends of the part of the line that may be inside, and its crossings of planes of
/// symmetry; ascending.
template <class R>
std::vector<R> mixed_crossings(const Superellipsoid& solid, const LineOf<R>& line,
                               const std::vector<R>& ends) {
    constexpr int kMostHalvings = 105;  // about the bits of R
    std::vector<R> found;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (!(ends[i] < ends[i + 1])) continue;
        const MixedSuperellipsoid<R> f(solid, line, (ends[i] + ends[i + 1]) / 2);
        auto from = f.at(ends[i]), to = f.at(ends[i + 1]);
        // Outside the clip the line is outside the solid: an end inside is moved to the surface.
        if (i == 0 && from.height < 0) from.height = 0;
        if (i + 2 == ends.size() && to.height < 0) to.height = 0;
        MixedSearch<R>(f, solid.p < 1, found).search(from, to, kMostHalvings);
    }
    return found;
}

}  // namespace alhazen
