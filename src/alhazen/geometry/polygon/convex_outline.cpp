#include "alhazen/geometry/polygon/convex_outline.h"

#include <algorithm>

namespace alhazen {
namespace {

/// Twice the signed area of the triangle a b c.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

std::vector<Vec2> convex_outline(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    std::vector<Vec2> hull;
    const auto add_chain = [&](auto begin, auto end) {
        const std::size_t base = hull.size();
        for (auto p = begin; p != end; ++p) {
            while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), *p) <= 0) {
                hull.pop_back();
            }
            hull.push_back(*p);
        }
        if (!hull.empty()) hull.pop_back();
    };
    add_chain(points.begin(), points.end());
    add_chain(points.rbegin(), points.rend());
    return hull;
}

}  // namespace alhazen
