#include "alhazen/geometry/polygon/free_diagonals.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/geometry/polygon/triangulate.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Cut {
    Triangles triangles;
    std::vector<PolygonTriangles> polygons;
};

Cut cut(const std::vector<Vec3>& positions,
        const std::vector<std::vector<std::uint32_t>>& polygons) {
    Cut result;
    for (const auto& polygon : polygons) {
        const std::size_t first = result.triangles.size();
        triangulate(positions, polygon, result.triangles);
        if (polygon.size() > 3) result.polygons.push_back({first, result.triangles.size()});
    }
    return result;
}

/// The number of triangles with the edge in either direction.
int uses(const Triangles& triangles, std::uint32_t a, std::uint32_t b) {
    int n = 0;
    for (const auto& t : triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t from = t[k], to = t[(k + 1) % 3];
            n += (from == a && to == b) || (from == b && to == a);
        }
    }
    return n;
}

const std::vector<Vec3> kBentSquare{{0, 0, 1}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}, {2, 2, 2}};

TEST(FreeDiagonals, AnEdgeElsewhereTurnsTheDiagonal) {
    Cut c = cut(kBentSquare, {{0, 1, 2, 3}, {0, 2, 4}});
    ASSERT_EQ(uses(c.triangles, 0, 2), 3);
    EXPECT_EQ(free_diagonals(kBentSquare, c.polygons, c.triangles), 1u);
    EXPECT_EQ(uses(c.triangles, 0, 2), 1);
    EXPECT_EQ(uses(c.triangles, 1, 3), 2);
    // The outline keeps its direction.
    ASSERT_EQ(c.triangles.size(), 3u);
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 normal = newell_normal(kBentSquare, c.triangles[i]);
        EXPECT_GT(normal.z, 0.0);
    }
    EXPECT_EQ(c.triangles[2], (std::array<std::uint32_t, 3>{0, 2, 4}));
}

TEST(FreeDiagonals, OfTwoEqualDiagonalsOneIsTurned) {
    Cut c = cut(kBentSquare, {{0, 1, 2, 3}, {2, 1, 0, 3}});
    ASSERT_EQ(uses(c.triangles, 0, 2), 4);
    EXPECT_EQ(free_diagonals(kBentSquare, c.polygons, c.triangles), 1u);
    EXPECT_EQ(uses(c.triangles, 0, 2), 2);
    EXPECT_EQ(uses(c.triangles, 1, 3), 2);
}

TEST(FreeDiagonals, VerticesOfEqualPositionAreOne) {
    std::vector<Vec3> positions = kBentSquare;
    positions.push_back(positions[0]);
    positions.push_back(positions[2]);
    Cut c = cut(positions, {{0, 1, 2, 3}, {5, 6, 4}});
    EXPECT_EQ(free_diagonals(positions, c.polygons, c.triangles), 1u);
}

TEST(FreeDiagonals, StayWhereTheOtherIsNoBetter) {
    // The other diagonal is an edge too.
    Cut both = cut(kBentSquare, {{0, 1, 2, 3}, {0, 2, 4}, {1, 3, 4}});
    const Triangles before = both.triangles;
    EXPECT_EQ(free_diagonals(kBentSquare, both.polygons, both.triangles), 0u);
    EXPECT_EQ(both.triangles, before);
    // A dart has one diagonal inside.
    const std::vector<Vec3> dart{{0, 0, 0}, {2, -1, 0}, {1, 0, 0}, {2, 1, 0}, {0, 0, 5}};
    Cut one = cut(dart, {{0, 1, 2, 3}, {0, 2, 4}});
    ASSERT_EQ(uses(one.triangles, 0, 2), 3);
    EXPECT_EQ(free_diagonals(dart, one.polygons, one.triangles), 0u);
    // No obstacle.
    Cut free = cut(kBentSquare, {{0, 1, 2, 3}});
    EXPECT_EQ(free_diagonals(kBentSquare, free.polygons, free.triangles), 0u);
}

TEST(FreeDiagonals, OfALargerPolygonAreTurnedWithinIt) {
    const std::vector<Vec3> hexagon{{2, 0, 0},   {1, 2, 0},  {-1, 2, 0}, {-2, 0, 0},
                                    {-1, -2, 0}, {1, -2, 0}, {0, 0, 5}};
    Cut c = cut(hexagon, {{0, 1, 2, 3, 4, 5}, {0, 3, 6}});
    ASSERT_EQ(uses(c.triangles, 0, 3), 3);
    EXPECT_EQ(free_diagonals(hexagon, c.polygons, c.triangles), 1u);
    EXPECT_EQ(uses(c.triangles, 0, 3), 1);
    EXPECT_EQ(uses(c.triangles, 2, 4), 2);
    Vec3 area;
    for (std::size_t i = 0; i < 4; ++i) area += newell_normal(hexagon, c.triangles[i]);
    const std::vector<std::uint32_t> loop{0, 1, 2, 3, 4, 5};
    EXPECT_EQ(area, newell_normal(hexagon, loop));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
