#pragma once
/// Large and awkward polygons, most of them simple; random ones come from a seed.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "alhazen/math/orientation.h"

namespace alhazen::testing {

/// Radii between 0.2 and 1.2 around the origin, or alternately 0.2 and 1 without a seed.
inline std::vector<Vec2> star_polygon(std::size_t n, unsigned seed = 0) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * double(i) / double(n);
        const double radius = seed != 0 ? 0.2 + unit(random) : (i % 2 == 0 ? 0.2 : 1.0);
        points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return points;
}

/// A spiral band: outward along its outer side and back along its inner side.
inline std::vector<Vec2> spiral_polygon(std::size_t n, double turns) {
    std::vector<Vec2> points;
    const auto add = [&](std::size_t i, double offset) {
        const double angle = 2.0 * std::numbers::pi * turns * double(i) / double(n / 2);
        const double radius = 1.0 + angle + offset;
        points.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    };
    for (std::size_t i = 0; i < n / 2; ++i) add(i, std::numbers::pi);
    for (std::size_t i = n / 2; i-- > 0;) add(i, 0.0);
    // Counter-clockwise: the outer side comes first.
    return points;
}

/// Teeth up from a line of collinear roots.
inline std::vector<Vec2> comb_polygon(std::size_t teeth) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < teeth; ++i) {
        const double x = 2.0 * double(i);
        for (const Vec2 p : {Vec2{x, 0}, Vec2{x + 1, 0}, Vec2{x + 1, 5}, Vec2{x + 2, 5}}) {
            points.push_back(p);
        }
    }
    points.push_back({2.0 * double(teeth), 9});
    points.push_back({0, 9});
    return points;
}

/// True if the segments touch or cross, including at a shared end.
inline bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const int abc = orientation(a, b, c), abd = orientation(a, b, d);
    const int cda = orientation(c, d, a), cdb = orientation(c, d, b);
    if (abc == 0 && abd == 0) {
        return std::max(a.x, b.x) >= std::min(c.x, d.x) &&
               std::max(c.x, d.x) >= std::min(a.x, b.x) &&
               std::max(a.y, b.y) >= std::min(c.y, d.y) && std::max(c.y, d.y) >= std::min(a.y, b.y);
    }
    return abc * abd <= 0 && cda * cdb <= 0;
}

/// Random points on a lattice of this many steps (0: no lattice), connected in random order and
/// untangled by reversals (2-opt) until no two edges touch; empty if that fails.
inline std::vector<Vec2> untangled_polygon(std::size_t n, unsigned seed, int lattice) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Vec2> points;
    while (points.size() < n) {
        Vec2 p{unit(random), unit(random)};
        if (lattice > 0) p = {std::floor(p.x * lattice), std::floor(p.y * lattice)};
        if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
    }
    const auto at = [&](std::size_t i) { return points[i % n]; };
    for (int round = 0; round < 2000; ++round) {
        bool clean = true;
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = i + 2; j < n; ++j) {
                if (i == 0 && j == n - 1) continue;
                if (!segments_meet(at(i), at(i + 1), at(j), at(j + 1))) continue;
                clean = false;
                std::reverse(points.begin() + std::ptrdiff_t(i + 1),
                             points.begin() + std::ptrdiff_t(j + 1));
            }
        }
        // Neighbours may also overlap.
        for (std::size_t i = 0; i < n && clean; ++i) {
            const Vec2 u = at(i) - at(i + 1), v = at(i + 2) - at(i + 1);
            if (orientation(at(i), at(i + 1), at(i + 2)) == 0 && u.x * v.x + u.y * v.y > 0.0) {
                return {};
            }
        }
        if (!clean) continue;
        double area = 0.0;
        for (std::size_t i = 0; i < n; ++i) area += at(i).x * at(i + 1).y - at(i).y * at(i + 1).x;
        if (area < 0.0) std::reverse(points.begin(), points.end());
        return points;
    }
    return {};
}

}  // namespace alhazen::testing
