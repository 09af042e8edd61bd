#include "alhazen/geometry/polygon/triangulate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

#include "alhazen/geometry/polygon/polygon_plane.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

std::vector<std::uint32_t> loop_of(std::size_t n) {
    std::vector<std::uint32_t> loop(n);
    std::iota(loop.begin(), loop.end(), 0u);
    return loop;
}

/// Checks that every triangle has the orientation of the polygon, the areas add up, each inner edge
/// is used in both directions, and each outer one as in the polygon.
void expect_tiling(const std::vector<Vec3>& points, const Triangles& triangles) {
    const std::vector<std::uint32_t> loop = loop_of(points.size());
    ASSERT_EQ(triangles.size(), points.size() - 2);
    const Vec3 normal = newell_normal(points, loop);
    double sum = 0.0;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& t : triangles) {
        const Vec3 n = cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
        EXPECT_GE(dot(n, normal), -1e-12 * length_squared(normal));
        sum += length(n);
        for (int k = 0; k < 3; ++k) ++edges[{t[std::size_t(k)], t[std::size_t((k + 1) % 3)]}];
    }
    EXPECT_NEAR(sum, length(normal), 1e-9 * length(normal));
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const std::pair<std::uint32_t, std::uint32_t> edge{i, (i + 1) % points.size()};
        EXPECT_EQ(edges[edge], 1) << "edge " << i;
        edges.erase(edge);
    }
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
}

Triangles cut(const std::vector<Vec3>& points) {
    Triangles triangles;
    triangulate(points, loop_of(points.size()), triangles);
    return triangles;
}

TEST(Triangulate, AConvexPolygonIsAFan) {
    const std::vector<Vec3> pentagon{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {-1, 1, 0}};
    const Triangles triangles = cut(pentagon);
    EXPECT_EQ(triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

/// The triangles have the polygon's area without signs: they stay inside and do not overlap.
TEST(Triangulate, SpikesAndSlitsWithoutWidthHaveNoArea) {
    struct Outline {
        std::vector<Vec2> points;
        double area;
    };
    const std::vector<Outline> outlines{
        {{{0, 0}, {2, 0}, {4, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {2, 0}, {3, -1}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {1, 0}, {1, -2}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {1, 0}, {1, 1}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {2, 0}, {2, 2}, {2, 3}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}}, 4},
        {{{0, 0}, {2, 0}, {2, 2}, {-1, 2}, {0, 2}}, 4},
        {{{0, 0}, {3, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 3},
        // A slit out in one step and back in two, and a spike on a spike.
        {{{0, 0}, {2, 0}, {2, 2}, {1, 2}, {1, 1}, {1, 1.5}, {1, 2}, {0, 2}}, 4},
        {{{0, 0}, {2, 0}, {4, 0}, {4, 1}, {4, 0}, {3, 0}, {2, 0}, {2, 2}, {0, 2}}, 4}};
    for (std::size_t i = 0; i < outlines.size(); ++i) {
        const std::size_t n = outlines[i].points.size();
        for (std::size_t first = 0; first < 2 * n; ++first) {
            std::vector<Vec3> points;
            for (std::size_t k = 0; k < n; ++k) {
                const Vec2 p = outlines[i].points[(first + (first < n ? k : n - k)) % n];
                points.push_back({p.x, p.y, 0});
            }
            const Triangles triangles = cut(points);
            ASSERT_EQ(triangles.size(), n - 2);
            double sum = 0.0;
            for (const auto& t : triangles) {
                sum +=
                    0.5 * length(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
            }
            EXPECT_NEAR(sum, outlines[i].area, 1e-12) << "outline " << i << ", first " << first;
        }
    }
}

TEST(Triangulate, AnArrowheadQuadIsCutAtItsNotch) {
    expect_tiling({{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}},
                  cut({{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}}));
}

TEST(Triangulate, RandomStarShapedPolygonsInAnyPlaneAreTiled) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int round = 0; round < 300; ++round) {
        const std::size_t n = 4 + random() % 60;
        const Vec3 normal = normalize({unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5});
        const Vec3 u = perpendicular(normal);
        const Vec3 v = cross(normal, u);
        std::vector<Vec3> points;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * double(i) / double(n);
            const double r = 0.2 + unit(random);
            points.push_back(Vec3{10, -5, 3} + r * std::cos(angle) * u + r * std::sin(angle) * v);
        }
        SCOPED_TRACE("round " + std::to_string(round));
        expect_tiling(points, cut(points));
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(Triangulate, ACombWithCollinearTeethIsTiled) {
    std::vector<Vec3> comb;
    for (int i = 0; i < 50; ++i) {
        comb.push_back({double(2 * i), 0, 0});
        comb.push_back({double(2 * i + 1), 0, 0});
        comb.push_back({double(2 * i + 1), 5, 0});
        comb.push_back({double(2 * i + 2), 5, 0});
    }
    comb.push_back({100, 9, 0});
    comb.push_back({0, 9, 0});
    expect_tiling(comb, cut(comb));
}

TEST(Triangulate, PolygonsThatAreNoneStillGiveTheirNumberOfTriangles) {
    const std::vector<Vec3> bow_tie{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(cut(bow_tie).size(), 2u);
    EXPECT_EQ(cut(std::vector<Vec3>(9)).size(), 7u);
    const std::vector<Vec3> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5, 0, 0}};
    EXPECT_EQ(cut(line).size(), 3u);
    std::vector<Vec3> pentagram;
    for (int i = 0; i < 5; ++i) {
        const double angle = 4.0 * std::numbers::pi * i / 5.0;
        pentagram.push_back({std::cos(angle), std::sin(angle), 0});
    }
    EXPECT_EQ(cut(pentagram).size(), 3u);
    const double nan = std::nan("");
    EXPECT_EQ(cut({{0, 0, 0}, {nan, 1, 0}, {1, nan, 0}, {0, 1, 0}, {2, 2, nan}}).size(), 3u);
}

TEST(Triangulate, AConvexPolygonOfManyVerticesIsAFanAndADentIsCutAround) {
    std::vector<Vec3> points;
    const std::size_t n = 4097;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * double(i) / double(n);
        points.push_back({std::cos(angle), std::sin(angle), 0});
    }
    EXPECT_EQ(cut(points).back(), (std::array<std::uint32_t, 3>{0, 4095, 4096}));
    points[10] = {0, 0, 0};
    expect_tiling(points, cut(points));
}

/// Corners off the plane turn Newell's sum of loops that cancel into any direction.
TEST(Triangulate, LoopsThatCancelAreCutInTheirPlane) {
    // Two squares of opposite orientation that meet in the first vertex.
    const std::vector<Vec3> squares = {{0, 0, 0}, {1, 0, 0},  {1, 1, 0},   {0, 1, 0},
                                       {0, 0, 0}, {0, -1, 0}, {-1, -1, 0}, {-1, 0, 0}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
            for (std::size_t moved = 0; moved < squares.size(); ++moved) {
                std::vector<Vec3> points;
                for (const Vec3& p : squares) {
                    Vec3 turned;
                    turned[axis] = &p == &squares[moved] ? off : 0.0;
                    turned[(axis + 1) % 3] = p.x;
                    turned[(axis + 2) % 3] = p.y;
                    points.push_back(turned);
                }
                const auto loop = loop_of(points.size());
                const Vec3 normal = plane_normal(points, loop);
                EXPECT_GT(std::abs(normal[axis]), 0.99 * length(normal)) << axis << " " << off;
                Triangles triangles;
                triangulate(points, loop, triangles);
                double area = 0;
                for (const auto& t : triangles) area += 0.5 * length(newell_normal(points, t));
                // Six triangles of half a unit square each.
                EXPECT_NEAR(area, 3, 1e-5) << axis << " " << off << " " << moved;
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
