/// Borders in a triangulation: the triangles tile the region, and parity counts the loops.

#include "alhazen/geometry/polygon/constrained_triangulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "alhazen/math/orientation.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Triangle = ConstrainedTriangulation::Triangle;

/// A square grid of n by n cells over the unit square.
ConstrainedTriangulation grid(std::uint32_t n) {
    std::vector<Vec2> points;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i <= n; ++i) {
        for (std::uint32_t j = 0; j <= n; ++j) points.push_back({double(i) / n, double(j) / n});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
            triangles.push_back({a, b, b + 1});
            triangles.push_back({a, b + 1, a + 1});
        }
    }
    return {std::move(points), triangles};
}

double area_of(const std::vector<Vec2>& points, const Triangle& t) {
    const Vec2 p = points[t[1]] - points[t[0]], q = points[t[2]] - points[t[0]];
    return 0.5 * (p.x * q.y - p.y * q.x);
}

double area_of(const ConstrainedTriangulation& mesh, const std::vector<Triangle>& triangles) {
    double sum = 0.0;
    for (const Triangle& t : triangles) sum += area_of(mesh.points(), t);
    return sum;
}

/// All triangles turn left, tile the unit square and meet edge to edge.
void expect_valid(const ConstrainedTriangulation& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double area = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const Triangle triangle = mesh.triangle(t);
        const auto& p = mesh.points();
        ASSERT_GT(orientation(p[triangle[0]], p[triangle[1]], p[triangle[2]]), 0);
        area += area_of(p, triangle);
        for (std::size_t k = 0; k < 3; ++k) {
            ++edges[std::pair(triangle[k], triangle[(k + 1) % 3])];
        }
    }
    EXPECT_NEAR(area, 1.0, 1e-12);
    for (const auto& [edge, count] : edges) {
        ASSERT_EQ(count, 1);
        if (edges.contains({edge.second, edge.first})) continue;
        const Vec2 a = mesh.points()[edge.first], b = mesh.points()[edge.second];
        const auto is_rim = [](double x, double y) { return x == y && (x == 0.0 || x == 1.0); };
        ASSERT_TRUE(is_rim(a.x, b.x) || is_rim(a.y, b.y));
    }
}

void add_loop(ConstrainedTriangulation& mesh, const std::vector<Vec2>& loop) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
        const std::uint32_t from = mesh.insert(loop[k]);
        mesh.connect(from, mesh.insert(loop[(k + 1) % loop.size()]));
    }
}

/// The area inside an odd number of loops. Precondition: the corner (0, 0) is outside of all.
double inside(ConstrainedTriangulation& mesh) {
    mesh.improve();
    expect_valid(mesh);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        for (const std::uint32_t corner : mesh.triangle(t)) {
            if (mesh.points()[corner] != Vec2{0, 0}) continue;
            const double even = area_of(mesh, mesh.triangles(t, true));
            const double odd = area_of(mesh, mesh.triangles(t, false));
            EXPECT_NEAR(even + odd, 1.0, 1e-12);
            return odd;
        }
    }
    ADD_FAILURE();
    return 0.0;
}

/// The area inside a loop, odd-even, by samples on a grid.
double sampled_area(const std::vector<Vec2>& loop, int side) {
    int odd = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const Vec2 p{(i + 0.5) / side, (j + 0.5) / side};
            bool in = false;
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec2 a = loop[k], b = loop[(k + 1) % loop.size()];
                if ((a.y > p.y) == (b.y > p.y)) continue;
                if (a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x) in = !in;
            }
            odd += in;
        }
    }
    return double(odd) / (side * side);
}

std::vector<Vec2> circle(Vec2 center, double radius, int n, double turn = 0.0) {
    std::vector<Vec2> loop;
    for (int k = 0; k < n; ++k) {
        const double a = turn + 2 * std::numbers::pi * k / n;
        loop.push_back(center + radius * Vec2{std::cos(a), std::sin(a)});
    }
    return loop;
}
double circle_area(double radius, int n) {
    return 0.5 * n * radius * radius * std::sin(2 * std::numbers::pi / n);
}

TEST(ConstrainedTriangulation, NestedLoopsCountOddEven) {
    for (const std::uint32_t cells : {1u, 2u, 5u, 16u}) {
        auto mesh = grid(cells);
        add_loop(mesh, circle({0.5, 0.5}, 0.45, 40));
        add_loop(mesh, circle({0.45, 0.5}, 0.3, 33));
        add_loop(mesh, circle({0.5, 0.5}, 0.125, 4));
        const double area = circle_area(0.45, 40) - circle_area(0.3, 33) + circle_area(0.125, 4);
        EXPECT_NEAR(inside(mesh), area, 1e-12);
    }
}

TEST(ConstrainedTriangulation, LoopsAlongTheGridAndThroughItsCornersAreExact) {
    auto mesh = grid(4);
    add_loop(mesh, {{0.25, 0.25}, {0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}});
    add_loop(mesh, {{0.5, 0.25}, {0.75, 0.5}, {0.5, 0.75}, {0.25, 0.5}});
    EXPECT_EQ(inside(mesh), 0.125);
    EXPECT_EQ(mesh.triangle_count(), 32u + 4);
}

TEST(ConstrainedTriangulation, TheSameLoopTwiceIsNoLoop) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.05, 0.95);
    for (int i = 0; i < 50; ++i) {
        auto mesh = grid(3);
        std::vector<Vec2> loop;
        for (int k = 0; k < 9; ++k) loop.push_back({uniform(random), uniform(random)});
        add_loop(mesh, loop);
        std::reverse(loop.begin(), loop.end());
        add_loop(mesh, loop);
        EXPECT_NEAR(inside(mesh), 0.0, 1e-12);
    }
}

TEST(ConstrainedTriangulation, LoopsThatCrossThemselvesCountOddEven) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(0.05, 0.95);
    for (int i = 0; i < 12; ++i) {
        auto mesh = grid(1 + static_cast<std::uint32_t>(i) % 4);
        std::vector<Vec2> loop;
        for (int k = 0; k < 5 + 3 * i; ++k) loop.push_back({uniform(random), uniform(random)});
        add_loop(mesh, loop);
        EXPECT_NEAR(inside(mesh), sampled_area(loop, 400), 0.01);
    }
}

TEST(ConstrainedTriangulation, NearlyCoincidentLoopsKeepTheirParity) {
    // The same circle from other vertices, displaced by rounding or little more.
    std::mt19937 random(3);
    for (const double off : {0.0, 1e-17, 1e-16, 1e-15, 1e-13, 1e-9}) {
        std::uniform_real_distribution<double> uniform(-off, off);
        for (int i = 0; i < 20; ++i) {
            auto mesh = grid(1 + static_cast<std::uint32_t>(i) % 5);
            std::vector<Vec2> loop = circle({0.5, 0.5}, 0.4, 12, 0.1 * i);
            add_loop(mesh, loop);
            std::vector<Vec2> other;
            for (std::size_t k = 0; k < loop.size(); ++k) {
                const Vec2 a = loop[k], b = loop[(k + 1) % loop.size()];
                other.push_back(a);
                for (int part = 1; part < 7; ++part) {
                    other.push_back(a + (part / 7.0) * (b - a) +
                                    Vec2{uniform(random), uniform(random)});
                }
            }
            add_loop(mesh, other);
            add_loop(mesh, circle({0.5, 0.5}, 0.2, 17));
            EXPECT_NEAR(inside(mesh), circle_area(0.2, 17), 10 * off + 1e-12) << off;
        }
    }
}

TEST(ConstrainedTriangulation, LoopsOnALatticeThatIsNotOfTheGridKeepTheirArea) {
    // Many vertices are on edges, and many edges meet in points, up to rounding.
    std::mt19937 random(4);
    for (int i = 0; i < 300; ++i) {
        const auto cells = static_cast<std::uint32_t>(1 + random() % 10);
        const int lattice = 6 + static_cast<int>(random() % 5);
        auto mesh = grid(cells);
        std::vector<Vec2> loop;
        const auto coordinate = [&] {
            return double(1 + random() % std::uint32_t(lattice - 1)) / lattice;
        };
        for (int k = 0; k < 4 + i % 13; ++k) loop.push_back({coordinate(), coordinate()});
        add_loop(mesh, loop);
        EXPECT_NEAR(inside(mesh), sampled_area(loop, 97), 0.03) << i;
    }
}

TEST(ConstrainedTriangulation, LongEdgesBesideFinePartsAreNotDivided) {
    // A straight border between two dense rows of points.
    auto mesh = grid(1);
    for (int k = 1; k < 200; ++k) {
        mesh.insert({0.1 + 0.004 * k, 0.5 + 1e-4 * (1 + k % 3)});
        mesh.insert({0.1 + 0.004 * k, 0.5 - 1e-4 * (1 + k % 4)});
    }
    const std::size_t points = mesh.points().size();
    add_loop(mesh, {{0.05, 0.5}, {0.95, 0.5}, {0.95, 0.9}, {0.05, 0.9}});
    // The diagonal of the grid is fixed: it meets the loop twice.
    EXPECT_EQ(mesh.points().size(), points + 6);
    EXPECT_NEAR(inside(mesh), 0.36, 1e-12);
}

TEST(ConstrainedTriangulation, ManyVerticesTakeNoLongTime) {
    auto mesh = grid(1);
    std::vector<Vec2> comb;
    constexpr int kTeeth = 20'000;
    for (int k = 0; k < kTeeth; ++k) {
        comb.push_back({0.05 + 0.9 * k / kTeeth, k % 2 == 0 ? 0.2 : 0.8});
    }
    comb.push_back({0.95, 0.1});
    comb.push_back({0.05, 0.1});
    add_loop(mesh, comb);
    EXPECT_GT(inside(mesh), 0.3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
