#pragma once
/// Random pairs of polygon sets, most of them degenerate on purpose.

#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include "alhazen/geometry/polygon_sets/mending.h"

namespace alhazen {

class RandomPolygons {
  public:
    explicit RandomPolygons(std::uint64_t seed) : random_(seed) {}

    /// Two operands of one of several kinds, with up to `vertices` vertices per loop.
    std::pair<PolygonSet, PolygonSet> pair(int vertices) {
        const std::int32_t sizes[]{3, 20, 1000, 1 << 20, kLatticeLimit};
        const std::int32_t size = sizes[below(5)];
        switch (below(5)) {
            case 0:
                return {mended(any(size, vertices)), mended(any(size, vertices))};
            case 1:
                return {mended(star(size, vertices)), mended(star(size, vertices))};
            case 2:
                return {mended(steps(size, vertices)), mended(steps(size, vertices))};
            case 3:
                return {mended(sliver(size, vertices)), mended(sliver(size, vertices))};
            default: {
                const LatticeLoop loop = any(size, vertices);
                return {mended(loop), mended(disturbed(loop, size))};
            }
        }
    }

    std::int32_t below(std::int32_t n) {
        return std::uniform_int_distribution<std::int32_t>(0, n - 1)(random_);
    }
    LatticePoint point(std::int32_t size) {
        return {below(2 * size + 1) - size, below(2 * size + 1) - size};
    }
    LatticeLoop any(std::int32_t size, int vertices) {
        LatticeLoop loop(static_cast<std::size_t>(3 + below(vertices - 2)));
        for (LatticePoint& p : loop) {
            p = point(size);
        }
        return loop;
    }
    /// A star-shaped loop around a centre, without crossings.
    LatticeLoop star(std::int32_t size, int vertices) {
        LatticeLoop loop(static_cast<std::size_t>(3 + below(vertices - 2)));
        const LatticePoint center = point(size / 2);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const double angle =
                6.283185307179586 * static_cast<double>(i) / static_cast<double>(loop.size());
            const double r = 0.5 * size * (1 + below(1000)) / 1000.0;
            loop[i] = {center.x + static_cast<std::int32_t>(std::lround(r * std::cos(angle))),
                       center.y + static_cast<std::int32_t>(std::lround(r * std::sin(angle)))};
        }
        return loop;
    }
    /// A loop of horizontal and vertical edges with few different coordinates.
    LatticeLoop steps(std::int32_t size, int vertices) {
        LatticeLoop loop;
        const int corners = 2 + below(vertices / 2);
        const std::int32_t unit = std::max(1, size / 4);
        const auto coordinate = [&] { return (below(9) - 4) * (size / unit == 0 ? 1 : unit); };
        const auto clamped = [size](std::int32_t v) { return std::clamp(v, -size, size); };
        LatticePoint p{clamped(coordinate()), clamped(coordinate())};
        for (int i = 0; i < corners; ++i) {
            p.x = clamped(coordinate());
            loop.push_back(p);
            p.y = clamped(coordinate());
            loop.push_back(p);
        }
        loop.push_back({loop.front().x, p.y});
        return loop;
    }
    /// A loop of points within two units of a line.
    LatticeLoop sliver(std::int32_t size, int vertices) {
        LatticeLoop loop(static_cast<std::size_t>(3 + below(vertices - 2)));
        const double slope = below(2001) / 1000.0 - 1;
        for (LatticePoint& p : loop) {
            const std::int32_t x = below(2 * size + 1) - size;
            const auto y = static_cast<std::int32_t>(std::lround(slope * x)) + below(5) - 2;
            p = {x, std::clamp(y, -size, size)};
        }
        return loop;
    }
    /// A copy of the loop with some points left out and some moved by one unit.
    LatticeLoop disturbed(const LatticeLoop& loop, std::int32_t size) {
        LatticeLoop result;
        for (LatticePoint p : loop) {
            if (below(5) == 0) {
                p.x = std::clamp(p.x + below(3) - 1, -size, size);
                p.y = std::clamp(p.y + below(3) - 1, -size, size);
            }
            if (below(6) != 0) {
                result.push_back(p);
            }
        }
        return result.size() < 3 ? loop : result;
    }
    static PolygonSet mended(const LatticeLoop& loop) { return polygon_set(loop); }

  private:
    std::mt19937_64 random_;
};

/// The loops of a set.
inline std::vector<LatticeLoop> loops_of(const PolygonSet& set) {
    std::vector<LatticeLoop> loops;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        loops.emplace_back(set.loop(i).begin(), set.loop(i).end());
    }
    return loops;
}

/// Length of the boundary.
inline double perimeter(const PolygonSet& set) {
    double sum = 0;
    for (std::size_t i = 0; i < set.loop_count(); ++i) {
        LatticePoint from = set.loop(i).back();
        for (const LatticePoint to : set.loop(i)) {
            sum += std::hypot(double{1} * to.x - from.x, double{1} * to.y - from.y);
            from = to;
        }
    }
    return sum;
}

}  // namespace alhazen
