#pragma once
/// Areas of polygons by the odd-even rule, by slabs: between two neighbouring heights of corners
/// and crossings no edges cross, so that widths are linear.

#include <algorithm>
#include <vector>

#include "alhazen/math/vec.h"
#include "support/random.h"

namespace alhazen::testing {

/// The area of a loop in a plane z = constant.
inline double odd_even_area(const std::vector<Vec3>& loop) {
    struct Edge {
        Vec3 low, high;
        [[nodiscard]] double x_at(double y) const {
            return low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x);
        }
    };
    std::vector<Edge> edges;
    std::vector<double> heights;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Vec3 &a = loop[i], &b = loop[(i + 1) % loop.size()];
        heights.push_back(a.y);
        if (a.y != b.y) edges.push_back(a.y < b.y ? Edge{a, b} : Edge{b, a});
    }
    for (const Edge& e : edges) {
        for (const Edge& f : edges) {
            const Vec3 d = e.high - e.low, g = f.high - f.low;
            const double turn = d.x * g.y - d.y * g.x;
            if (turn == 0.0) continue;
            const Vec3 between = f.low - e.low;
            const double at = (between.x * g.y - between.y * g.x) / turn;
            if (at > 0.0 && at < 1.0) heights.push_back(e.low.y + at * d.y);
        }
    }
    std::sort(heights.begin(), heights.end());
    double area = 0.0;
    for (std::size_t k = 1; k < heights.size(); ++k) {
        const double height = heights[k] - heights[k - 1], y = heights[k - 1] + 0.5 * height;
        std::vector<double> crossings;
        for (const Edge& e : edges) {
            if (e.low.y < y && y < e.high.y) crossings.push_back(e.x_at(y));
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 1; i < crossings.size(); i += 2) {
            area += height * (crossings[i] - crossings[i - 1]);
        }
    }
    return area;
}

/// A loop of 5 to 9 corners on a lattice of 5 x 5 points in z = 0, where most meet themselves: they
/// cross, touch in corners, have spikes, doubled edges and repeated corners.
inline std::vector<Vec3> random_loop(Random& random) {
    std::vector<Vec3> loop(static_cast<std::size_t>(5 + random.below(5)));
    for (Vec3& p : loop) {
        p.x = random.below(5) - 2;
        p.y = random.below(5) - 2;
    }
    return loop;
}

/// Loops that touch themselves or have a spike, and their areas.
struct LoopOfArea {
    std::vector<Vec3> loop;
    double area;
};
inline std::vector<LoopOfArea> touching_loops() {
    return {
        // A bow tie with a vertex in its crossing; with that on the other diagonal.
        {{{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {0, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, 2},
        {{{-1, -1, 0}, {0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}}, 2},
        // Lobes of areas 1 and 4.
        {{{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {0, 0, 0}, {-2, 2, 0}, {-2, -2, 0}}, 5},
        // Triangles in opposite quadrants.
        {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, -1, 0}, {-1, 0, 0}}, 1},
        // A lobe around a lobe of the same orientation.
        {{{0, 0, 0}, {4, -2, 0}, {4, 2, 0}, {0, 0, 0}, {2, -0.5, 0}, {2, 0.5, 0}}, 7},
        // A triangle with a spike along its side, of coordinates that are rounded.
        {{{0.1, 0.2, 0}, {-0.086, -0.776, 0}, {0.193, 0.688, 0}, {0.681, 0.595, 0}}, 0.1233965},
        // A square with a spike along its side.
        {{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1},
    };
}

}  // namespace alhazen::testing
