#include "alhazen/geometry/cones/cut_sphere.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/math/constants.h"
#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Shares of lines, which start on the plane.
struct Lines {
    double inside = 0, covered = 0, outside = 0;
};

Lines lines_of(const ConeRay& cone, const ConeSphere& sphere, const ConePlane& start) {
    constexpr int kSide = 600;
    const Vec3 ex = perpendicular(cone.axis), ey = cross(cone.axis, ex);
    Lines lines;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const double u = 2.0 * (i + 0.5) / kSide - 1, v = 2.0 * (j + 0.5) / kSide - 1;
            if (u * u + v * v >= 1) continue;
            const Vec3 across = u * ex + v * ey;
            const Vec3 d = cone.axis + cone.spread * across;
            Vec3 o = cone.origin + cone.radius * across;
            o = o + (dot(start.point - o, start.normal) / dot(d, start.normal)) * d;
            const Vec3 to = sphere.center - o;
            const double along = dot(to, d) / dot(d, d), rr = sphere.radius * sphere.radius;
            if (length_squared(to) <= rr) {
                ++lines.inside;
                continue;
            }
            ++lines.outside;
            lines.covered += along > 0 && length_squared(to - along * d) <= rr;
        }
    }
    return lines;
}

TEST(CutSphere, CoversTheLinesThatStartOutsideAndMeetIt) {
    RandomStream random(1984);
    int some = 0;
    for (int k = 0; k < 60; ++k) {
        const ConePlane start{{0, 0, 0}, {0, 0, 1}};
        const double tilt = random.uniform(0, 1.3), turn = random.uniform(0, 6);
        const Vec3 axis{std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn),
                        std::cos(tilt)};
        // Parallel, converging to a point, or diverging.
        const double spread = k % 3 == 0 ? 0.0 : k % 3 == 1 ? -1.0 / 6 : 0.25;
        const ConeRay cone{{0, 0, 0}, axis, 1.0, spread};
        const double radius = random.uniform(0.3, 2);
        const double far = random.uniform(0, radius + 0.8), where = random.uniform(0, 6);
        const ConeSphere sphere{
            {far * std::cos(where), far * std::sin(where), random.uniform(-1, 1) * radius}, radius};
        if (spread > 0 && length(cone.apex() - sphere.center) < radius) continue;
        const Lines lines = lines_of(cone, sphere, start);
        if (lines.outside < 1000) continue;
        const ConeMap map(cone);
        ConeScratch scratch;
        ASSERT_TRUE(is_cut(sphere, start));
        const ConeCover whole = cover_of(sphere_disc(cone, map, sphere.center, sphere.radius));
        const auto cover = cut_cover(cone, map, sphere, start, whole, kInfinity, scratch);
        ASSERT_TRUE(cover) << k;
        const double expected = lines.covered / lines.outside;
        some += expected > 0.01 && expected < 0.99;
        // Of the whole disc, shares are exact to two thousandths.
        EXPECT_NEAR(cover->share, expected, 3e-3 * (lines.inside + lines.outside) / lines.outside)
            << k << " spread " << spread;
    }
    EXPECT_GT(some, 20);
}

TEST(CutSphere, ASphereBelowCoversNothingAndOneAroundTheStartIsToldOf) {
    const ConeRay cone{{0, 0, 0}, {0, 0, 1}, 0.5, 0.0};
    const ConePlane start{{0, 0, 0}, {0, 0, 1}};
    ConeScratch scratch;
    // The greatest circle lies below the plane: no line along the normal meets the rest.
    const ConeSphere low{{0.5, 0, -0.3}, 0.5};
    EXPECT_EQ(cut_cover(cone, ConeMap(cone), low, start, {0.4, {0, 0}}, kInfinity, scratch)->share,
              0.0);
    const ConeSphere around{{0, 0, 0.3}, 2};
    EXPECT_FALSE(cut_cover(cone, ConeMap(cone), around, start, {1.0, {0, 0}}, kInfinity, scratch));
    EXPECT_FALSE(is_cut({{0, 0, 1}, 1}, start));
    EXPECT_FALSE(is_cut({{0, 0, -1.5}, 1}, start));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
