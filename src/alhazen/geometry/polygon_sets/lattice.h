#pragma once
/// The integer lattice of polygon sets, its exact predicates, and the places where two edges cross.
///
/// Source: Hobby, "Practical Segment Intersection with Finite Precision Output", Computational
/// Geometry 13, 1999 (hot pixels); the predicates are determinants.
/// Conventions: coordinates are within [-2^24, 2^24]. A vector then has components of at most 25
/// bits, a cross product at most 51 bits, a crossing is a ratio of at most 75 to 51 bits, and the
/// comparison of two crossings takes products of at most 126 bits. Order is lexicographic: x, then
/// y. Above an edge is to the left of it as it runs from its lesser to its greater end.
/// Complexity: O(1) each. A filter in double decides all but the closest comparisons.

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

namespace alhazen {

__extension__ typedef __int128 Int128;

/// The greatest absolute coordinate.
inline constexpr std::int32_t kLatticeLimit = 1 << 24;

struct LatticePoint {
    std::int32_t x = 0;
    std::int32_t y = 0;

    friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
    friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

using LatticeLoop = std::vector<LatticePoint>;

/// The smallest box of lattice points; empty if lo exceeds hi.
struct LatticeBox {
    LatticePoint lo{kLatticeLimit, kLatticeLimit};
    LatticePoint hi{-kLatticeLimit, -kLatticeLimit};

    [[nodiscard]] bool empty() const { return lo.x > hi.x; }
    void extend(LatticePoint p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    /// True if the closed boxes have a common point.
    [[nodiscard]] bool meets(const LatticeBox& o) const {
        return lo.x <= o.hi.x && o.lo.x <= hi.x && lo.y <= o.hi.y && o.lo.y <= hi.y;
    }
    friend bool operator==(const LatticeBox&, const LatticeBox&) = default;
};

/// (b - a) x (c - a): positive if a, b, c turn counter-clockwise.
[[nodiscard]] inline std::int64_t turn(LatticePoint a, LatticePoint b, LatticePoint c) {
    return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
}

/// (b - a) x (d - c).
[[nodiscard]] inline std::int64_t cross_of(LatticePoint a, LatticePoint b, LatticePoint c,
                                           LatticePoint d) {
    return std::int64_t{b.x - a.x} * (d.y - c.y) - std::int64_t{b.y - a.y} * (d.x - c.x);
}

/// An exact point of the plane: a lattice point, or the point at num / den of an edge (from + num /
/// den (to - from)).
struct LatticePlace {
    LatticePoint from;
    LatticePoint to;
    std::int64_t num = 0;
    std::int64_t den = 1;
    double x = 0;  ///< within 2^-24 of the exact coordinate
    double y = 0;

    [[nodiscard]] Int128 scaled_x() const {  ///< x den
        return Int128{from.x} * den + Int128{to.x - from.x} * num;
    }
    [[nodiscard]] Int128 scaled_y() const {
        return Int128{from.y} * den + Int128{to.y - from.y} * num;
    }
};

[[nodiscard]] inline LatticePlace place_of(LatticePoint p) {
    return {p, p, 0, 1, static_cast<double>(p.x), static_cast<double>(p.y)};
}

/// The intersection of the lines of a-b and c-d. Precondition: they are not parallel, and the
/// intersection is on the segment a-b.
[[nodiscard]] LatticePlace crossing(LatticePoint a, LatticePoint b, LatticePoint c, LatticePoint d);

/// Lexicographic order of the exact places.
[[nodiscard]] std::strong_ordering compare(const LatticePlace& a, const LatticePlace& b);

/// The sign of (b - a) x (p - a).
[[nodiscard]] int side_of(LatticePoint a, LatticePoint b, const LatticePlace& p);

/// The hot pixel of a place: the lattice point c with c - 1/2 <= p < c + 1/2 in both coordinates.
[[nodiscard]] LatticePoint rounded(const LatticePlace& p);

/// True if the place is a lattice point.
[[nodiscard]] bool on_lattice(const LatticePlace& p);

/// True if the closed segment a-b has a point in the half-open pixel around `center`.
[[nodiscard]] bool meets_pixel(LatticePoint a, LatticePoint b, LatticePoint center);

}  // namespace alhazen
