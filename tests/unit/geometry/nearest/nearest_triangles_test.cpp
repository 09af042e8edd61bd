#include "alhazen/geometry/nearest/nearest_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;
using Corners = NearestTriangles::Corners;

/// The squared distance with 113 bits: the foot where it lies inside, else the least of the edges.
Quad exact_squared(const Vec3& from, const Corners& corners) {
    const QuadVec p(from), a(corners[0]), b(corners[1]), c(corners[2]);
    const auto squared = [&](const QuadVec& q) { return dot(p - q, p - q); };
    const auto on_edge = [&](const QuadVec& begin, const QuadVec& end) {
        const QuadVec along = end - begin;
        const Quad length = dot(along, along);
        Quad t = length > 0 ? dot(p - begin, along) / length : Quad(0);
        t = std::min(Quad(1), std::max(Quad(0), t));
        return squared(begin + t * along);
    };
    Quad least = std::min({on_edge(a, b), on_edge(b, c), on_edge(a, c)});
    const QuadVec ab = b - a, ac = c - a, ap = p - a;
    const Quad bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac);
    const Quad determinant = bb * cc - bc * bc;
    if (!(determinant > 0)) return least;
    const Quad v = (cc * dot(ab, ap) - bc * dot(ac, ap)) / determinant;
    const Quad w = (bb * dot(ac, ap) - bc * dot(ab, ap)) / determinant;
    if (v >= 0 && w >= 0 && v + w <= 1) least = std::min(least, squared(a + v * ab + w * ac));
    return least;
}

double reach(const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The distance is the exact one within 4e-15 of the largest coordinate, and the point on the
/// triangle is the one of the weights.
void check(const Vec3& from, const Corners& c) {
    const PointOnTriangle found = nearest_on_triangle(from, c);
    const double size = std::max({reach(from), reach(c[0]), reach(c[1]), reach(c[2])});
    const double exact = static_cast<double>(square_root(exact_squared(from, c)));
    EXPECT_NEAR(std::sqrt(found.squared), exact, 4e-15 * size);
    EXPECT_EQ(found.squared, length_squared(from - found.point));
    EXPECT_GE(found.u, 0.0);
    EXPECT_GE(found.v, 0.0);
    EXPECT_LE(found.u + found.v, 1.0 + 1e-15);
    const Vec3 again = c[0] + found.u * (c[1] - c[0]) + found.v * (c[2] - c[0]);
    EXPECT_LE(reach(again - found.point), 4e-15 * size);
}

TEST(PointOnTriangle, ClosedFormsOfFaceEdgeAndCorner) {
    const Corners c{Vec3{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    PointOnTriangle found = nearest_on_triangle({0.5, 0.25, 3}, c);
    EXPECT_EQ(found.point, (Vec3{0.5, 0.25, 0}));
    EXPECT_EQ(found.squared, 9.0);
    EXPECT_EQ(found.u, 0.25);
    EXPECT_EQ(found.v, 0.125);
    found = nearest_on_triangle({2, 2, 0}, c);
    EXPECT_EQ(found.point, (Vec3{1, 1, 0}));
    EXPECT_EQ(found.u, 0.5);
    found = nearest_on_triangle({1, -3, 4}, c);
    EXPECT_EQ(found.point, (Vec3{1, 0, 0}));
    EXPECT_EQ(found.squared, 25.0);
    found = nearest_on_triangle({-1, 7, 0}, c);
    EXPECT_EQ(found.point, (Vec3{0, 2, 0}));
    EXPECT_EQ(found.v, 1.0);
}

TEST(PointOnTriangle, TheDistanceIsThatOf113BitsForAllShapesAndPlaces) {
    Random random(71);
    for (int i = 0; i < 60000; ++i) {
        SCOPED_TRACE(i);
        Corners c;
        for (Vec3& corner : c) corner = random.in_cube(1.0);
        Vec3 from = random.in_cube(1.5);
        switch (i % 6) {
            case 1:  // a sliver
                c[2] = c[0] + random.uniform() * (c[1] - c[0]) +
                       random.in_cube(random.log_uniform(1e-16, 1e-2));
                break;
            case 2:  // a small one, near or far
                for (std::size_t k : {1, 2}) {
                    c[k] = c[0] + random.in_cube(random.log_uniform(1e-12, 1.0));
                }
                from = c[0] + random.in_cube(random.log_uniform(1e-12, 1e6));
                break;
            case 3:  // near its plane
                from = c[0] + random.uniform(-0.5, 1.5) * (c[1] - c[0]) +
                       random.uniform(-0.5, 1.5) * (c[2] - c[0]) +
                       random.in_cube(random.log_uniform(1e-17, 1e-3));
                break;
            case 4:  // far from the origin
                for (Vec3& corner : c) corner += Vec3{1e6, -1e7, 1e5};
                from += Vec3{1e6, -1e7, 1e5};
                break;
            case 5:
                for (Vec3& corner : c) corner = random.on_lattice(2.0, 1.0);
                from = random.on_lattice(3.0, 0.5);
                break;
            default:
                break;
        }
        check(from, c);
        if (::testing::Test::HasFailure()) return;
    }
}

TEST(PointOnTriangle, SegmentsAndPointsAreTrianglesToo) {
    const Vec3 a{1, 2, 3}, b{2, 2, 3};
    EXPECT_EQ(nearest_on_triangle({1, 2, 5}, {a, a, a}).squared, 4.0);
    for (const Corners& c :
         {Corners{a, a, b}, Corners{a, b, a}, Corners{b, a, a}, Corners{a, b, Vec3{1.5, 2, 3}}}) {
        const PointOnTriangle found = nearest_on_triangle({1.75, 3, 3}, c);
        EXPECT_EQ(found.squared, 1.0);
        EXPECT_EQ(found.point, (Vec3{1.75, 2, 3}));
    }
}

/// The answers of the tree are those of brute force, bit for bit.
void compare(const std::vector<Corners>& triangles, const std::vector<Vec3>& points) {
    const NearestTriangles tree(triangles);
    EXPECT_EQ(tree.size(), triangles.size());
    for (const Vec3& from : points) {
        NearestTriangle best;
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const PointOnTriangle found = nearest_on_triangle(from, triangles[i]);
            if (!(found.squared < best.squared)) continue;
            static_cast<PointOnTriangle&>(best) = found;
            best.triangle = i;
        }
        const NearestTriangle found = tree.nearest(from);
        ASSERT_EQ(found.triangle, best.triangle);
        ASSERT_EQ(found.squared, best.squared);
        ASSERT_EQ(found.point, best.point);
        ASSERT_EQ(found.u, best.u);
        ASSERT_EQ(found.v, best.v);
    }
}

TEST(NearestTriangles, IsBruteForceOnRandomSoup) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        std::vector<Corners> triangles(static_cast<std::size_t>(random.below(400)));
        const double size = random.log_uniform(1e-3, 1.0), scale = random.log_uniform(1e-9, 1e9);
        const Vec3 place = scale * random.in_cube(random.coin() ? 0.0 : 1e4);
        for (Corners& c : triangles) {
            const Vec3 middle = random.in_cube(1.0);
            for (Vec3& corner : c) corner = place + scale * (middle + random.in_cube(size));
        }
        std::vector<Vec3> points;
        for (int i = 0; i < 200; ++i) points.push_back(place + scale * random.in_cube(1.3));
        for (int i = 0; i < 20; ++i) points.push_back(scale * random.in_cube(1e7));
        for (int i = 0; i < 20 && !triangles.empty(); ++i) {
            points.push_back(triangles[static_cast<std::size_t>(i) % triangles.size()][0]);
        }
        compare(triangles, points);
    }
}

TEST(NearestTriangles, IsBruteForceOnALatticeWhereManyAreAsNear) {
    Random random(5);
    for (const double height : {0.0, 3.0}) {  // flat, too
        std::vector<Corners> triangles(300);
        for (Corners& c : triangles) {
            for (Vec3& corner : c) {
                corner = random.on_lattice(3.0, 1.0);
                corner.z = std::min(std::abs(corner.z), height);
            }
        }
        triangles.push_back(triangles[7]);
        std::vector<Vec3> points;
        for (int i = 0; i < 600; ++i) points.push_back(random.on_lattice(5.0, 0.5));
        compare(triangles, points);
    }
}

TEST(NearestTriangles, IsBruteForceBesideSurfacesThatAreNearlyAsNearEverywhere) {
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        // A flat or curved sheet, a sphere among them, anywhere and of any size, facing anywhere.
        const double bend = seed % 4 == 0 ? 0.0 : random.log_uniform(1e-9, 1.0);
        const double scale = seed % 5 == 0 ? 1e-60 : random.log_uniform(1e-6, 1e6);
        const Vec3 place = scale * random.in_cube(seed % 3 == 0 ? 1e5 : 0.0);
        const Vec3 normal = random.unit_vector(), u = perpendicular(normal), v = cross(normal, u);
        constexpr int kSide = 24;
        const auto point = [&](int i, int j) {
            const double x = 2.0 * i / kSide - 1.0, y = 2.0 * j / kSide - 1.0;
            const Vec3 flat = x * u + y * v + bend * (x * x + y * y) * normal;
            return place + scale * (seed % 4 == 1 ? normalize(flat + normal) : flat);
        };
        std::vector<Corners> triangles;
        for (int i = 0; i < kSide; ++i) {
            for (int j = 0; j < kSide; ++j) {
                const Vec3 a = point(i, j), b = point(i + 1, j + 1);
                triangles.push_back({a, point(i + 1, j), b});
                triangles.push_back(random.coin() ? Corners{a, b, point(i, j + 1)}
                                                  : Corners{a, point(i, j + 1), b});
            }
        }
        std::vector<Vec3> points;
        for (int i = 0; i < 60; ++i) {
            points.push_back(place + scale * random.in_cube(1.5));
            const double height = random.uniform(-2, 2);
            points.push_back(place + scale * height * normal);  // foci
            points.push_back(point(i % kSide, (7 * i) % kSide) + scale * height * 1e-9 * normal);
        }
        compare(triangles, points);
    }
}

TEST(NearestTriangles, OneManyTimesIsTheFirst) {
    const Corners c{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    compare(std::vector<Corners>(1), {{1, 2, 3}});
    compare(std::vector<Corners>(100, c), {{1, 2, 3}, {0, 0, 0}, {-4, 0.25, 1e9}});
    EXPECT_EQ(NearestTriangles(std::vector<Corners>(100, c)).nearest({9, 9, 9}).triangle, 0u);
}

TEST(NearestTriangles, NothingIsNearWhereNothingIs) {
    const NearestTriangle none = NearestTriangles({}).nearest({1, 2, 3});
    EXPECT_FALSE(none.found());
    EXPECT_EQ(none.squared, std::numeric_limits<double>::infinity());
    const NearestTriangles one({Corners{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
        EXPECT_FALSE(one.nearest({bad, 0, 0}).found());
        EXPECT_FALSE(one.nearest({0, 0, -bad}).found());
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
