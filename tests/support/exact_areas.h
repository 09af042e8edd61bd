#pragma once
/// Exact areas of lattice regions: by the arrangement of the sweep, and independently by an
/// integral over pairs of edges.
///
/// A region is the signed sum over its edges of the part of the plane below each; the area of an
/// intersection is the sum over pairs of edges of the integral of the lower of the two.
/// Conventions: Number has + - * / and is constructible from an Int128. `Residue` is such a type
/// modulo a prime: equal rationals have equal residues, different ones have with probability 2^-60.

#include <algorithm>
#include <cstdint>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/geometry/polygon_sets/polygon_set.h"

namespace alhazen {

/// An integer modulo 2^61 - 1.
class Residue {
  public:
    static constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;

    Residue() = default;
    explicit Residue(Int128 v) {
        const Int128 r = v % Int128{kPrime};
        value_ = static_cast<std::uint64_t>(r < 0 ? r + Int128{kPrime} : r);
    }
    friend Residue operator+(Residue a, Residue b) { return reduced(Int128{a.value_} + b.value_); }
    friend Residue operator-(Residue a, Residue b) {
        return reduced(Int128{a.value_} + kPrime - b.value_);
    }
    friend Residue operator*(Residue a, Residue b) { return reduced(Int128{a.value_} * b.value_); }
    friend Residue operator/(Residue a, Residue b) { return a * b.inverse(); }
    friend bool operator==(Residue, Residue) = default;

  private:
    static Residue reduced(Int128 v) {
        Residue r;
        r.value_ = static_cast<std::uint64_t>(v % Int128{kPrime});
        return r;
    }
    [[nodiscard]] Residue inverse() const {
        Residue power = *this;
        Residue result(1);
        for (std::uint64_t e = kPrime - 2; e != 0; e >>= 1) {
            result = (e & 1) != 0 ? result * power : result;
            power = power * power;
        }
        return result;
    }
    std::uint64_t value_ = 0;
};

/// Twice the area of the faces whose state s has inside[s].
template <class Number>
Number arrangement_area(const Arrangement& arrangement, const bool (&inside)[4]) {
    Number sum(Int128{0});
    for (const SubEdge& e : arrangement.sub_edges) {
        if (inside[e.below] == inside[e.above]) {
            continue;
        }
        const LatticePlace& p = arrangement.points[inside[e.above] ? e.begin : e.end];
        const LatticePlace& q = arrangement.points[inside[e.above] ? e.end : e.begin];
        const Number dens = Number(Int128{p.den}) * Number(Int128{q.den});
        sum = sum + (Number(p.scaled_x()) * Number(q.scaled_y()) -
                     Number(p.scaled_y()) * Number(q.scaled_x())) /
                        dens;
    }
    return sum;
}

/// An edge from left to right; `sign` is 1 if the region is below it.
struct SpanEdge {
    LatticePoint a;
    LatticePoint b;
    int sign = 0;
    /// y (b.x - a.x) at x
    [[nodiscard]] Int128 scaled_y(std::int64_t x) const {
        return Int128{a.y} * (b.x - a.x) + Int128{b.y - a.y} * (x - a.x);
    }
    [[nodiscard]] std::int64_t width() const { return std::int64_t{b.x} - a.x; }
};

inline std::vector<SpanEdge> span_edges(const PolygonSet& set) {
    std::vector<SpanEdge> edges;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        LatticePoint from = set.loop(i).back();
        for (const LatticePoint to : set.loop(i)) {
            if (from.x != to.x) {
                edges.push_back(from.x < to.x ? SpanEdge{from, to, -1} : SpanEdge{to, from, 1});
            }
            from = to;
        }
    }
    return edges;
}

/// Twice the integral of the lower of two edges over their common x.
template <class Number>
Number lower_integral(const SpanEdge& e, const SpanEdge& f) {
    const std::int64_t l = std::max(e.a.x, f.a.x);
    const std::int64_t r = std::min(e.b.x, f.b.x);
    if (l >= r) {
        return Number(Int128{0});
    }
    const auto height = [](const SpanEdge& g, std::int64_t x) {
        return Number(g.scaled_y(x)) / Number(Int128{g.width()});
    };
    const auto higher = [&](std::int64_t x) {  // the sign of e - f
        const Int128 d = e.scaled_y(x) * f.width() - f.scaled_y(x) * e.width();
        return d > 0 ? 1 : (d < 0 ? -1 : 0);
    };
    const int at_l = higher(l);
    const int at_r = higher(r);
    const Number width(Int128{r - l});
    if (at_l * at_r >= 0) {
        const SpanEdge& low = at_l > 0 || at_r > 0 ? f : e;
        return (height(low, l) + height(low, r)) * width;
    }
    const SpanEdge& first = at_l > 0 ? f : e;
    const SpanEdge& second = at_l > 0 ? e : f;
    const Number d_l = height(second, l) - height(first, l);
    const Number d_r = height(first, r) - height(second, r);
    const Number t = d_l / (d_l + d_r);
    const Number middle = height(first, l) + (height(first, r) - height(first, l)) * t;
    return (height(first, l) + middle) * width * t +
           (middle + height(second, r)) * width * (Number(Int128{1}) - t);
}

/// Twice the area of the intersection of two sets.
template <class Number>
Number common_area(const PolygonSet& a, const PolygonSet& b) {
    const std::vector<SpanEdge> edges_b = span_edges(b);
    Number sum(Int128{0});
    for (const SpanEdge& e : span_edges(a)) {
        for (const SpanEdge& f : edges_b) {
            const Number part = lower_integral<Number>(e, f);
            sum = e.sign == f.sign ? sum + part : sum - part;
        }
    }
    return sum;
}

}  // namespace alhazen
