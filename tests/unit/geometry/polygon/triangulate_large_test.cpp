/// Polygons of any size and shape: tiled exactly and in short time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <unordered_map>

#include "alhazen/geometry/polygon/ear_clipper.h"
#include "alhazen/geometry/polygon/ordered_bits.h"
#include "alhazen/geometry/polygon/point_tree.h"
#include "alhazen/geometry/polygon/sweep_triangulation.h"
#include "alhazen/geometry/polygon/triangulate.h"
#include "support/polygon_maker.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles cut(const std::vector<Vec2>& polygon) {
    std::vector<Vec3> positions;
    for (const Vec2& p : polygon) positions.push_back({p.x, p.y, 0.0});
    std::vector<std::uint32_t> loop(polygon.size());
    std::iota(loop.begin(), loop.end(), 0u);
    Triangles triangles;
    triangulate(positions, loop, triangles);
    return triangles;
}

/// Twice the signed area, positive when counter-clockwise.
long double doubled_area(Vec2 a, Vec2 b, Vec2 c) {
    const long double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
    return ux * vy - uy * vx;
}
long double doubled_area(const std::vector<Vec2>& polygon) {
    long double sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        sum += doubled_area(polygon[0], polygon[i], polygon[i + 1]);
    }
    return sum;
}

/// Checks for a tiling: n - 2 triangles, none reversed by the exact sign, with the area of the
/// polygon, and every inner edge used once in each direction.
void expect_tiling(const std::vector<Vec2>& polygon, const Triangles& triangles) {
    ASSERT_EQ(triangles.size(), polygon.size() - 2);
    long double sum = 0;
    std::unordered_map<std::uint64_t, int> open;
    const auto key = [](std::uint64_t i, std::uint64_t j) { return i << 32 | j; };
    for (const auto& t : triangles) {
        const Vec2 a = polygon[t[0]], b = polygon[t[1]], c = polygon[t[2]];
        ASSERT_GE(orientation(a, b, c), 0) << t[0] << ' ' << t[1] << ' ' << t[2];
        sum += doubled_area(a, b, c);
        for (std::size_t k = 0; k < 3; ++k) ++open[key(t[k], t[(k + 1) % 3])];
    }
    const long double area = doubled_area(polygon);
    ASSERT_GT(area, 0.0L);
    EXPECT_NEAR(double(sum / area), 1.0, 1e-11);
    for (std::uint64_t i = 0; i < polygon.size(); ++i) {
        const auto edge = open.find(key(i, (i + 1) % polygon.size()));
        ASSERT_TRUE(edge != open.end() && edge->second == 1) << "edge " << i;
        open.erase(edge);
    }
    for (const auto& [edge, count] : open) {
        ASSERT_EQ(count, 1);
        ASSERT_TRUE(open.contains(key(edge & 0xFFFFFFFFu, edge >> 32)));
    }
}

/// Checks the algorithm chosen by size, ear clipping and the sweep.
void expect_tiled(const std::vector<Vec2>& polygon) {
    expect_tiling(polygon, cut(polygon));
    expect_tiling(polygon, EarClipper(polygon).clip());
    const std::optional<Triangles> swept = triangulate_by_sweep(polygon);
    ASSERT_TRUE(swept);
    expect_tiling(polygon, *swept);
}

TEST(LargePolygons, StarsCombsAndSpiralsOfFiftyThousandVerticesAreTiled) {
    expect_tiled(testing::star_polygon(50000));
    expect_tiled(testing::comb_polygon(12500));
    expect_tiled(testing::spiral_polygon(50000, 1000.0));
    if (!testing::thorough()) return;
    expect_tiled(testing::star_polygon(50000, 1));
    expect_tiled(testing::spiral_polygon(50000, 10.0));
}

TEST(LargePolygons, RandomUntangledOnesAreTiled) {
    for (unsigned seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Vec2> polygon = testing::untangled_polygon(5 + 4 * seed, seed, 0);
        ASSERT_FALSE(polygon.empty());
        expect_tiled(polygon);
    }
}

TEST(LargePolygons, RandomUntangledOnesOnALatticeAreTiled) {
    int made = 0;
    for (unsigned seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Vec2> polygon = testing::untangled_polygon(6 + seed % 30, seed, 12);
        if (polygon.empty()) continue;
        ++made;
        expect_tiled(polygon);
        if (::testing::Test::HasFatalFailure()) return;
    }
    EXPECT_GT(made, 50);
}

TEST(LargePolygons, RepeatedVerticesCostNoArea) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<Vec2> polygon;
        std::mt19937 random(seed);
        for (const Vec2& p : testing::untangled_polygon(40, seed, 0)) {
            polygon.insert(polygon.end(), 1 + random() % 3, p);
        }
        expect_tiled(polygon);
    }
}

/// A square with square holes, each connected to the previous one and the border by a bridge that
/// is traversed in both directions.
std::vector<Vec2> keyhole_polygon(int holes) {
    std::vector<Vec2> polygon{{0, 0}};
    for (int i = 0; i < holes; ++i) {
        const double x = 3.0 * i + 1, y = i % 2 == 0 ? 1 : 1.25;
        // From the border below up to the hole, around it clockwise, and back.
        for (const Vec2 p : {Vec2{x, 0}, Vec2{x, y}, Vec2{x, y + 1}, Vec2{x + 1, y + 1},
                             Vec2{x + 1, y}, Vec2{x, y}, Vec2{x, 0}}) {
            polygon.push_back(p);
        }
    }
    const double end = 3.0 * holes + 1;
    polygon.insert(polygon.end(), {{end, 0}, {end, 4}, {0, 4}});
    return polygon;
}

TEST(LargePolygons, HolesOnBridgesStayHoles) {
    for (const int holes : {1, 2, 7, 400, 5000}) {
        SCOPED_TRACE(std::to_string(holes) + " holes");
        const std::vector<Vec2> polygon = keyhole_polygon(holes);
        EXPECT_EQ(double(doubled_area(polygon)), 2.0 * (4.0 * (3.0 * holes + 1) - holes));
        expect_tiling(polygon, cut(polygon));
    }
}

TEST(LargePolygons, FarFromTheOriginAndAtAnyScaleTheyAreTiledAsWell) {
    for (const double scale : {1e-160, 1e-20, 1.0, 1e20, 1e160}) {
        SCOPED_TRACE("scale " + std::to_string(std::log10(scale)));
        std::vector<Vec2> polygon = testing::star_polygon(500, 5);
        const Triangles expected = cut(polygon);
        const double power = std::exp2(std::round(std::log2(scale)));
        for (Vec2& p : polygon) p = power * p;
        EXPECT_EQ(cut(polygon), expected);
    }
    std::vector<Vec2> far = testing::comb_polygon(100);
    for (Vec2& p : far) p = p + Vec2{1e12, -3e13};
    expect_tiled(far);
}

TEST(LargePolygons, ASqueezedSpiralThatBoxesCannotTellApartIsTiled) {
    std::vector<Vec2> polygon = testing::spiral_polygon(50000, 500.0);
    for (Vec2& p : polygon) p = {p.x + 0.5 * p.y, p.x + 0.50001 * p.y};
    if (doubled_area(polygon) < 0) std::reverse(polygon.begin(), polygon.end());
    expect_tiling(polygon, cut(polygon));
}

TEST(LargePolygons, ThoseThatCrossThemselvesAreNoticedByTheSweep) {
    EXPECT_FALSE(triangulate_by_sweep({{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
    std::vector<Vec2> pentagram;
    for (int i = 0; i < 5; ++i) {
        const double angle = 4.0 * std::numbers::pi * i / 5.0;
        pentagram.push_back({std::cos(angle), std::sin(angle)});
    }
    EXPECT_FALSE(triangulate_by_sweep(pentagram));
    EXPECT_FALSE(triangulate_by_sweep(std::vector<Vec2>(9)));
}

TEST(LargePolygons, TangledAndFlatOnesStillGiveTheirNumberOfTriangles) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<Vec2> tangle, line, lattice;
    for (int i = 0; i < 20000; ++i) {
        tangle.push_back({unit(random), unit(random)});
        line.push_back({std::floor(100 * unit(random)), 0.0});
        lattice.push_back({double(random() % 4), double(random() % 4)});
    }
    for (const auto& polygon : {tangle, line, lattice}) {
        const Triangles triangles = cut(polygon);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
        long double sum = 0;
        for (const auto& t : triangles) {
            sum += doubled_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
        }
        // Where the winding is negative the polygon was seen from behind; the sum is the same.
        EXPECT_NEAR(double(sum), double(doubled_area(polygon)), 1e-9 * double(polygon.size()));
    }
}

TEST(PointTree, FindsWhatBruteForceFinds) {
    std::mt19937 random(2);
    std::vector<Vec2> points;
    for (int i = 0; i < 700; ++i) points.push_back({double(random() % 40), double(random() % 40)});
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < points.size(); i += 2) ids.push_back(i);
    PointTree tree(points, ids);
    std::vector<bool> active(points.size());
    int found = 0;
    for (int round = 0; round < 20000; ++round) {
        const std::uint32_t change = ids[random() % ids.size()];
        active[change] = random() % 16 == 0;
        tree.activate(change, active[change]);
        const Vec2 a = points[random() % 700], b = points[random() % 700];
        const Vec2 c = points[random() % 700];
        if (orientation(a, b, c) < 0) continue;
        bool expected = false;
        for (const std::uint32_t i : ids) {
            const Vec2 p = points[i];
            expected =
                expected || (active[i] && p != a && p != b && p != c && orientation(a, b, p) >= 0 &&
                             orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0);
        }
        ASSERT_EQ(tree.any_in(a, b, c), expected) << "round " << round;
        found += expected ? 1 : 0;
    }
    EXPECT_GT(found, 1000);
}

TEST(OrderedBits, FindsTheNextMemberAround) {
    std::mt19937 random(9);
    for (const std::uint32_t n : {1u, 63u, 64u, 65u, 5000u, 300000u}) {
        OrderedBits bits(n);
        EXPECT_EQ(bits.next_around(0), std::nullopt);
        std::vector<bool> member(n);
        for (int round = 0; round < 300; ++round) {
            const std::uint32_t i = std::uint32_t(random() % n);
            member[i] = random() % 3 != 0;
            bits.assign(i, member[i]);
            const std::uint32_t from = std::uint32_t(random() % n);
            std::optional<std::uint32_t> expected;
            for (std::uint32_t k = 0; k < n && !expected; ++k) {
                if (member[(from + k) % n]) expected = (from + k) % n;
            }
            ASSERT_EQ(bits.next_around(from), expected);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
