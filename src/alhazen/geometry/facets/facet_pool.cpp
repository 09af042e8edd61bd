#include "alhazen/geometry/facets/facet_pool.h"

#include <algorithm>
#include <tuple>

#include "alhazen/math/constants.h"

namespace alhazen {

SideRange side_range(const FacetPlane& plane, std::span<const Vec3> points) {
    SideRange range{kInfinity, -kInfinity};
    for (const Vec3& p : points) {
        const double at = plane.at(p);
        range.least = std::min(range.least, at);
        range.most = std::max(range.most, at);
    }
    return range;
}

Vec3 edge_meets(const Vec3& a, double at_a, const Vec3& b, double at_b) {
    if (std::tie(b.x, b.y, b.z) < std::tie(a.x, a.y, a.z)) return edge_meets(b, at_b, a, at_a);
    const double share = at_a / (at_a - at_b);
    return a + share * (b - a);
}

void clip_before(const FacetPlane& plane, double margin, std::span<const Vec3> loop,
                 std::vector<Vec3>& result) {
    result.clear();
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
        const double at_a = plane.at(a) - margin, at_b = plane.at(b) - margin;
        if (at_a >= 0.0) result.push_back(a);
        if ((at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0)) {
            result.push_back(edge_meets(a, at_a, b, at_b));
        }
    }
    if (result.size() < 3) result.clear();
}

void split_loop(const FacetPlane& plane, double margin, std::span<const Vec3> loop,
                std::vector<Vec3>& before, std::vector<Vec3>& behind) {
    before.clear();
    behind.clear();
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const Vec3 &a = loop[k], &b = loop[k + 1 == loop.size() ? 0 : k + 1];
        const double at_a = plane.at(a), at_b = plane.at(b);
        if (at_a >= -margin) before.push_back(a);
        if (at_a <= margin) behind.push_back(a);
        if ((at_a > margin && at_b < -margin) || (at_a < -margin && at_b > margin)) {
            const Vec3 p = edge_meets(a, at_a, b, at_b);
            before.push_back(p);
            behind.push_back(p);
        }
    }
    if (before.size() < 3) before.clear();
    if (behind.size() < 3) behind.clear();
}

}  // namespace alhazen
