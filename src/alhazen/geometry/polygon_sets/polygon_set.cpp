#include "alhazen/geometry/polygon_sets/polygon_set.h"

#include <algorithm>

namespace alhazen {

void PolygonSet::clear() {
    points_.clear();
    ends_.clear();
    bounds_ = {};
    touching_ = false;
}

PolygonSet lattice_rectangle(LatticePoint lo, LatticePoint hi) {
    PolygonSet set;
    if (lo.x < hi.x && lo.y < hi.y) {
        set.add_vertex(lo);
        set.add_vertex({hi.x, lo.y});
        set.add_vertex(hi);
        set.add_vertex({lo.x, hi.y});
        set.end_loop();
    }
    return set;
}

Int128 twice_area(std::span<const LatticePoint> loop) {
    Int128 sum = 0;
    if (!loop.empty()) {
        LatticePoint a = loop.back();
        for (const LatticePoint b : loop) {
            sum += std::int64_t{a.x} * b.y - std::int64_t{a.y} * b.x;
            a = b;
        }
    }
    return sum;
}

Int128 twice_area(const PolygonSet& set) {
    Int128 sum = 0;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        sum += twice_area(set.loop(i));
    }
    return sum;
}

namespace {

/// Counts crossings of the ray from p to +x, and tests whether p is on the loop.
PointSide side_of_loop(std::span<const LatticePoint> loop, LatticePoint p) {
    bool inside = false;
    LatticePoint a = loop.back();
    for (const LatticePoint b : loop) {
        if ((a.y <= p.y) != (b.y <= p.y)) {
            const std::int64_t t = turn(a, b, p);
            if (t == 0) {
                return PointSide::Boundary;
            }
            inside = inside != ((t > 0) == (b.y > a.y));
        } else if (a.y == p.y && b.y == p.y && std::min(a.x, b.x) <= p.x &&
                   p.x <= std::max(a.x, b.x)) {
            return PointSide::Boundary;
        } else if (b == p) {
            return PointSide::Boundary;
        }
        a = b;
    }
    return inside ? PointSide::Inside : PointSide::Outside;
}

}  // namespace

PointSide side_of_point(const PolygonSet& set, LatticePoint p) {
    bool inside = false;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        const PointSide side = side_of_loop(set.loop(i), p);
        if (side == PointSide::Boundary) {
            return side;
        }
        inside = inside != (side == PointSide::Inside);
    }
    return inside ? PointSide::Inside : PointSide::Outside;
}

bool contains(const PolygonSet& set, LatticePoint p) {
    return side_of_point(set, p) != PointSide::Outside;
}

}  // namespace alhazen
