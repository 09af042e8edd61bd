#include "alhazen/geometry/repair/repaired_polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "alhazen/geometry/polygon/polygon_plane.h"
#include "alhazen/math/affine.h"
#include "alhazen/math/unit_vector.h"
#include "support/odd_even_area.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

RepairedPolygon repaired(const std::vector<Vec3>& loop) {
    const Vec3 normal = unit_or(plane_normal_of_loops(loop, {}), {0, 0, 1});
    return repaired_polygon(loop, {}, {normal, dot(normal, loop[0])});
}

double area_of(const RepairedPolygon& polygon) {
    double sum = 0.0;
    for (const std::vector<Vec3>& part : polygon.parts) {
        const double area = 0.5 * length(newell_normal_of_loops(part, {}));
        EXPECT_TRUE(part.size() == 3 || polygon.parts.size() == 1);
        sum += area;
    }
    return sum;
}

TEST(RepairedPolygon, LoopsThatTouchThemselvesAreCoveredOnce) {
    for (const LoopOfArea& c : touching_loops()) {
        const RepairedPolygon polygon = repaired(c.loop);
        EXPECT_NEAR(odd_even_area(c.loop), c.area, 1e-15);
        EXPECT_NEAR(area_of(polygon), c.area, 1e-6) << c.area;
        EXPECT_FALSE(polygon.mended.empty()) << c.area;
    }
}

TEST(RepairedPolygon, SpikesOfRoundedCoordinatesAreNotFilled) {
    Random random(5);
    const auto rounded = [](double x) { return std::round(1000 * x) / 1000; };
    for (int round = 0; round < 2000; ++round) {
        const auto corner = [&] {
            return Vec3{rounded(random.uniform(-1, 1)), rounded(random.uniform(-1, 1)), 0};
        };
        const Vec3 a = corner(), b = corner(), c = corner();
        // From a on the line of c and a.
        const double beyond = random.uniform(0.2, 1.5);
        const Vec3 tip = a + beyond * (a - c);
        const double triangle = 0.5 * length(cross(b - a, c - a));
        const std::vector<Vec3> spikes[] = {{a, tip, c, b}, {b, a, tip, c}, {c, tip, a, b}};
        for (const std::vector<Vec3>& loop : spikes) {
            EXPECT_NEAR(area_of(repaired(loop)), triangle, 1e-6) << round;
        }
    }
}

TEST(RepairedPolygon, RandomLoopsHaveTheirAreaInAnyPlane) {
    Random random(6);
    int crossing = 0;
    for (int round = 0; round < 4000; ++round) {
        const std::vector<Vec3> loop = random_loop(random);
        const double area = odd_even_area(loop);
        if (length(plane_normal_of_loops(loop, {})) == 0.0) continue;
        const Affine place = Affine::translate(random.in_cube(3)) *
                             Affine::rotate(random.unit_vector(), random.uniform(0, 3));
        std::vector<Vec3> placed;
        for (const Vec3& p : loop) placed.push_back(place.point(p));
        for (const std::vector<Vec3>& corners : {loop, placed}) {
            const RepairedPolygon polygon = repaired(corners);
            EXPECT_NEAR(area_of(polygon), area, 1e-5) << round;
            EXPECT_TRUE(polygon.crosses || area > 0.0) << round;
            if (polygon.crosses) {
                ++crossing;
            } else {
                EXPECT_NEAR(0.5 * length(newell_normal_of_loops(corners, {})), area, 1e-5) << round;
            }
        }
    }
    EXPECT_GT(crossing, 1000);
    EXPECT_LT(crossing, 7900);
}

TEST(RepairedPolygon, TheCornersOfOthersAreKept) {
    // A square with a hole that a bridge joins to its outline, and one with a hole that touches it.
    const std::vector<std::vector<Vec3>> loops{
        {{0, 0, 0},
         {3, 0, 0},
         {3, 3, 0},
         {0, 3, 0},
         {0, 0, 0},
         {1, 1, 0},
         {1, 2, 0},
         {2, 2, 0},
         {2, 1, 0},
         {1, 1, 0}},
        {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0}, {1, 2, 0}, {2, 1, 0}}};
    const double areas[] = {8, 7.5};
    for (const std::vector<Vec3>& loop : loops) {
        const RepairedPolygon polygon = repaired(loop);
        EXPECT_FALSE(polygon.crosses);
        EXPECT_EQ(area_of(polygon), areas[&loop - loops.data()]);
    }
}

TEST(RepairedPolygon, TheMessageOfCornersOffThePlaneNamesTheBound) {
    const std::vector<Vec3> bent{{-3, 0, 0}, {3, 0, 0.5}, {3, 8, 0}, {-3, 8, 0.5}};
    EXPECT_EQ(repaired_polygon(bent, {}, {{0, 0, 1}, 0}).refused,
              "polygon with corners 0.5 off its plane (at most 0.1, a hundredth of its size)");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
