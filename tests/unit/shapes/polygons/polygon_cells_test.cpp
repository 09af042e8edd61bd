// Cells of a polygon never change a hit, and decide most points.

#include "alhazen/shapes/polygons/polygon_cells.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/polygons/polygon_lanes.h"
#include "alhazen/simd/targets.h"
#include "support/any_ray.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::any_ray;
using testing::Random;
using testing::same_bits;
using testing::to_text;

/// A plane of a random direction, or along two axes.
struct Plane2 {
    Vec3 origin, x, y;

    Plane2(Random& random, bool lattice) : origin(random.in_cube(3)) {
        const Vec3 normal = random.unit_vector();
        x = perpendicular(normal);
        y = cross(normal, x);
        if (lattice) {
            x = y = {};
            const int k = random.below(3);
            x[k] = y[(k + 1) % 3] = 1.0;
            origin = random.on_lattice(2, 0.5);
        }
    }
    [[nodiscard]] Vec3 at(double u, double v) const { return origin + u * x + v * y; }
};

/// A star of random radii, a gear, or steps along the axes, in half of the cases with a hole; of
/// any size, in some cases not quite flat.
Polygon many_cornered(Random& random) {
    const int kind = random.below(3);
    const Plane2 plane(random, kind == 2);
    const double size = kind == 2 ? 1.0 : random.log_uniform(1e-4, 1e4);
    const int n = 16 + random.below(random.coin() ? 20 : 300);
    Polygon p;
    const auto add_loop = [&](double scale) {
        for (int k = 0; k < n; ++k) {
            const double angle = 6.283185307179586 * (k + 0.9 * random.uniform()) / n;
            double r = random.uniform(0.5, 2);
            if (kind == 1) r = (k / 2) % 2 == 0 ? 2.0 : 1.7;
            p.vertices.push_back(
                plane.at(scale * size * r * std::cos(angle), scale * size * r * std::sin(angle)));
        }
        p.loop_ends.push_back(static_cast<std::uint32_t>(p.vertices.size()));
    };
    if (kind == 2) {
        // A staircase and back along its bottom.
        const int steps = 8 + random.below(30);
        for (int i = 0; i < steps; ++i) {
            p.vertices.push_back(plane.at(i, i));
            p.vertices.push_back(plane.at(i, i + 1));
        }
        p.vertices.push_back(plane.at(steps, steps));
        p.vertices.push_back(plane.at(steps, 0));
        p.loop_ends.push_back(static_cast<std::uint32_t>(p.vertices.size()));
    } else {
        add_loop(1.0);
        if (random.coin()) add_loop(0.2);
        if (random.below(4) == 0) {
            const double bend = random.log_uniform(1e-9, 0.1) * size;
            const Vec3 normal = cross(plane.x, plane.y);
            for (Vec3& v : p.vertices) v += random.uniform(-bend, bend) * normal;
        }
    }
    p.prepare();
    return p;
}

/// Towards a corner, an edge, near an edge, or anywhere; from near and far, steep and grazing.
Ray aimed_ray(const Polygon& polygon, Random& random) {
    if (random.below(3) == 0) return any_ray(polygon.box(), random);
    const std::size_t n = polygon.vertices.size();
    const std::size_t i = static_cast<std::size_t>(random.below(static_cast<int>(n)));
    const Vec3 a = polygon.vertices[i], b = polygon.vertices[(i + 1) % n];
    const double part[] = {0.0, 0.5, random.uniform()};
    Vec3 target = a + part[random.below(3)] * (b - a);
    const double size = length(polygon.box().size());
    const int kind = random.below(3);
    if (kind == 1) target += random.log_uniform(1e-17, 0.1) * size * random.unit_vector();
    if (kind == 2) target = polygon.point + random.uniform(0, 1.2) * (target - polygon.point);
    Vec3 direction = random.log_uniform(1e-3, 1e3) * random.unit_vector();
    if (random.below(4) == 0) {
        direction -=
            (1.0 - random.log_uniform(1e-16, 1)) * dot(polygon.normal, direction) * polygon.normal;
    }
    if (random.below(4) == 0) direction = polygon.normal;
    const double distance[] = {0.0, 1e-9, 0.5, 3.0, 1e3, 1e6};
    const double away = distance[random.below(6)] * size / length(direction);
    return {target - away * direction, direction};
}

Polygon without_cells(Polygon polygon) {
    polygon.cells = nullptr;
    return polygon;
}

TEST(PolygonCells, HitsAreThoseWithoutCells) {
    Random random(71);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
        const Polygon polygon = many_cornered(random);
        ASSERT_NE(polygon.cells, nullptr);
        const Polygon plain = without_cells(polygon);
        for (int k = 0; k < 400; ++k) {
            const Ray ray = aimed_ray(polygon, random);
            ShapeHit hit, expected;
            const int count = polygon.intersect(ray, &hit);
            ASSERT_EQ(count, plain.intersect(ray, &expected))
                << "seed 71, polygon " << i << ", " << to_text(ray);
            if (count == 1) {
                ASSERT_TRUE(same_bits(hit, expected)) << to_text(ray);
            }
            hits += count;
        }
    }
    EXPECT_GT(hits, 20000);
}

TEST(PolygonCells, HitsNearEdgesAreTheSameOnEveryInstructionSet) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(74);
        int near_edges = 0;
        for (int i = 0; i < 60; ++i) {
            const Polygon polygon = many_cornered(random);
            const Polygon plain = without_cells(polygon);
            const std::size_t n = polygon.vertices.size();
            for (std::size_t k = 0; k < n; ++k) {
                // Over the middle of an edge, and off the two ends of its line.
                const Vec3 a = polygon.vertices[k], b = polygon.vertices[(k + 1) % n];
                const Vec3 at = a + random.uniform(-0.2, 1.2) * (b - a);
                const Vec3 from = at + random.uniform(0.1, 3) * length(b - a) * polygon.normal +
                                  random.log_uniform(1e-9, 1e-2) * (b - a);
                const Ray ray{from, at - from};
                ShapeHit hit, expected;
                const int count = polygon.intersect(ray, &hit);
                ASSERT_EQ(count, plain.intersect(ray, &expected))
                    << target << ", polygon " << i << ", " << to_text(ray);
                if (count == 1) {
                    ASSERT_TRUE(same_bits(hit, expected)) << to_text(ray);
                }
                near_edges += count;
            }
        }
        EXPECT_GT(near_edges, 1000);
    }
}

TEST(PolygonCells, HitsInLanesAreThoseWithoutCells) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        Random random(72);
        int hit_count = 0;
        for (int i = 0; i < 150; ++i) {
            const Polygon polygon = many_cornered(random);
            const Polygon plain = without_cells(polygon);
            for (int block = 0; block < 40; ++block) {
                RayLanes rays;
                for (std::size_t lane = 0; lane < kRayLanes; ++lane) {
                    rays.set(lane, aimed_ray(polygon, random));
                }
                const auto wanted = static_cast<std::uint32_t>(1 + random.below(255));
                std::array<ShapeHit, kRayLanes> hits;
                const std::uint32_t found = first_hits(polygon, rays, wanted, hits.data());
                ASSERT_EQ(found & ~wanted, 0u);
                for_each_lane(wanted, [&](std::size_t lane) {
                    ShapeHit alone;
                    const bool hit = find_first_hit(plain, rays.ray(lane), alone);
                    ASSERT_EQ(hit, (found >> lane & 1) != 0)
                        << target << ", polygon " << i << ", " << to_text(rays.ray(lane));
                    if (hit) {
                        ASSERT_TRUE(same_bits(alone, hits[lane])) << to_text(rays.ray(lane));
                    }
                });
                hit_count += std::popcount(found);
            }
        }
        EXPECT_GT(hit_count, 3000);
    }
}

TEST(PolygonCells, PolygonsThatAreNotFiniteHaveNone) {
    const auto with_vertex = [](const Vec3& vertex) {
        Polygon p;
        for (int k = 0; k < 20; ++k)
            p.vertices.push_back({std::cos(0.3 * k), std::sin(0.3 * k), 0});
        p.vertices[3] = vertex;
        p.prepare();
        return p;
    };
    constexpr double kInf = std::numeric_limits<double>::infinity();
    EXPECT_NE(with_vertex({1, 1, 0}).cells, nullptr);
    for (const double bad : {kInf, -kInf, std::nan("")}) {
        EXPECT_EQ(with_vertex({bad, 0, 0}).cells, nullptr) << bad;
        EXPECT_EQ(with_vertex({0, 0, bad}).cells, nullptr) << bad;
    }
}

TEST(PolygonCells, MostPointsOfAGearAreDecided) {
    Polygon gear;
    constexpr int kCorners = 144;
    for (int k = 0; k < kCorners; ++k) {
        const double angle = 6.283185307179586 * k / kCorners;
        const double r = (k / 2) % 2 == 0 ? 1.0 : 0.9;
        gear.vertices.push_back({r * std::cos(angle), r * std::sin(angle), 0});
    }
    gear.prepare();
    ASSERT_NE(gear.cells, nullptr);
    Random random(73);
    constexpr int kPoints = 10000;
    int decided = 0;
    for (int i = 0; i < kPoints; ++i) {
        const Vec3 p = random.in_cube(1);
        const PolygonCells::Place place = gear.cells->place_of(p.x, p.y);
        if (place == PolygonCells::Place::NearEdge) continue;
        ++decided;
        const double r = std::hypot(p.x, p.y);
        if (place == PolygonCells::Place::Inside) {
            ASSERT_LT(r, 1.0) << p.x << " " << p.y;
        } else {
            ASSERT_GT(r, 0.89) << p.x << " " << p.y;
        }
    }
    EXPECT_GT(decided, 0.95 * kPoints);
    EXPECT_LT(gear.cells->memory_bytes(), gear.vertices.size() * sizeof(Vec3));
}

TEST(PolygonCells, FewCornersAndSliversHaveNone) {
    Polygon square{.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
    square.prepare();
    EXPECT_EQ(square.cells, nullptr);
    std::vector<Vec3> line(PolygonCells::kFewestCorners);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = {double(i), 0, 0};
    const std::uint32_t ends[] = {static_cast<std::uint32_t>(line.size())};
    Box3 box;
    for (const Vec3& v : line) box.include(v);
    EXPECT_EQ(PolygonCells::make(line, ends, {0, 0, 1}, box), nullptr);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
