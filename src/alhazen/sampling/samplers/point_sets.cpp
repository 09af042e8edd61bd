#include "alhazen/sampling/samplers/point_sets.h"

#include <algorithm>
#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kMostCandidates = 256;

double torus_gap(double a, double b) {
    const double d = std::abs(a - b);
    return std::min(d, 1.0 - d);
}

}  // namespace

double torus_distance_squared(const Vec2& a, const Vec2& b) {
    const double dx = torus_gap(a.x, b.x), dy = torus_gap(a.y, b.y);
    return dx * dx + dy * dy;
}

TorusPoints::TorusPoints(std::uint32_t expected) {
    points_.reserve(expected);
    make_cells(1);
}

std::uint32_t TorusPoints::cell_of(double x) const {
    return std::min(static_cast<std::uint32_t>(x * side_), side_ - 1);
}

void TorusPoints::make_cells(std::uint32_t side) {
    side_ = side;
    cells_.assign(std::size_t{side} * side, {});
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        cells_[cell_of(points_[i].y) * side_ + cell_of(points_[i].x)].push_back(i);
    }
}

void TorusPoints::add(const Vec2& p) {
    cells_[cell_of(p.y) * side_ + cell_of(p.x)].push_back(
        static_cast<std::uint32_t>(points_.size()));
    points_.push_back(p);
    if (points_.size() >= 4 * cells_.size()) make_cells(2 * side_);
}

double TorusPoints::nearest_in_ring(const Vec2& p, int ring, double best) const {
    const int side = static_cast<int>(side_);
    const int x = static_cast<int>(cell_of(p.x)), y = static_cast<int>(cell_of(p.y));
    for (int dy = -ring; dy <= ring; ++dy) {
        const int step = std::abs(dy) == ring ? 1 : std::max(1, 2 * ring);
        for (int dx = -ring; dx <= ring; dx += step) {
            const int cx = (x + dx + side) % side, cy = (y + dy + side) % side;
            for (const std::uint32_t i : cells_[static_cast<std::size_t>(cy * side + cx)]) {
                best = std::min(best, torus_distance_squared(p, points_[i]));
            }
        }
    }
    return best;
}

double TorusPoints::nearest_squared(const Vec2& p, double enough) const {
    double best = 1.0;
    // Rings beyond half a side would overlap themselves.
    const int rings = static_cast<int>(side_ / 2);
    for (int ring = 0; ring <= rings; ++ring) {
        // A ring is at least ring - 1 cells away.
        const double least = std::max(0, ring - 1) / static_cast<double>(side_);
        if (best <= least * least || best < enough) break;
        best = nearest_in_ring(p, ring, best);
    }
    return best;
}

DiscSet poisson_disc_set(std::uint64_t key, std::uint32_t count) {
    // The first radius, relative to that of the densest packing, and the factor that shrinks it.
    constexpr double kBegin = 0.8, kShrink = 0.98;
    constexpr int kDartsOfPoint = 16;
    DiscSet set;
    set.radius = kBegin * std::sqrt(2.0 / (std::sqrt(3.0) * count));
    TorusPoints found(count);
    RandomStream random(key);
    while (found.points().size() < count) {
        const double squared = set.radius * set.radius;
        for (std::uint32_t dart = 0; dart < kDartsOfPoint * count; ++dart) {
            const double x = random.uniform();
            const Vec2 p{x, random.uniform()};
            if (found.nearest_squared(p, squared) < squared) continue;
            found.add(p);
            if (found.points().size() == count) break;
        }
        if (found.points().size() < count) set.radius *= kShrink;
    }
    set.points = found.points();
    return set;
}

std::vector<Vec2> best_candidate_set(std::uint64_t key, std::uint32_t count) {
    TorusPoints found(count);
    RandomStream random(key);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t candidates = i == 0 ? 1 : std::min(8 * i, kMostCandidates);
        Vec2 best;
        double distance = -1.0;
        for (std::uint32_t k = 0; k < candidates; ++k) {
            const double x = random.uniform();
            const Vec2 p{x, random.uniform()};
            const double own = found.nearest_squared(p, distance);
            if (!(own > distance)) continue;
            distance = own;
            best = p;
        }
        found.add(best);
    }
    return found.points();
}

}  // namespace alhazen
