#include "alhazen/sampling/analysis/discrepancy.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "alhazen/sampling/samplers/point_sets.h"

namespace alhazen {

double star_discrepancy(std::span<const Vec2> points) {
    std::vector<Vec2> by_x(points.begin(), points.end());
    std::sort(by_x.begin(), by_x.end(), [](const Vec2& a, const Vec2& b) { return a.x < b.x; });
    const auto n = static_cast<double>(by_x.size());
    std::vector<double> ys;  // y of the points so far, ascending
    double worst = 0.0;
    // Boxes without their right and upper sides hold the fewest points.
    const auto look_below = [&](double x) {
        for (std::size_t k = 0; k < ys.size(); ++k) {
            worst = std::max(worst, x * ys[k] - static_cast<double>(k) / n);
        }
        worst = std::max(worst, x - static_cast<double>(ys.size()) / n);
    };
    for (const Vec2& p : by_x) {
        look_below(p.x);
        ys.insert(std::upper_bound(ys.begin(), ys.end(), p.y), p.y);
        for (std::size_t k = 0; k < ys.size(); ++k) {
            worst = std::max(worst, static_cast<double>(k + 1) / n - p.x * ys[k]);
        }
    }
    look_below(1.0);
    return worst;
}

double smallest_distance(std::span<const Vec2> points) {
    TorusPoints before(static_cast<std::uint32_t>(points.size()));
    double best = 1.0;
    for (const Vec2& p : points) {
        best = std::min(best, before.nearest_squared(p, 0.0));
        before.add(p);
    }
    return std::sqrt(best);
}

}  // namespace alhazen
