#include "alhazen/shapes/swept/lathe.h"

#include <gtest/gtest.h>

#include "alhazen/math/quadratic.h"
#include "alhazen/shapes/quadrics/cone.h"
#include "support/random.h"
#include "support/same_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_same_crossings;
using testing::line;
using testing::Random;

Lathe turned(const std::vector<ProfileCurve>& curves) {
    Lathe lathe;
    lathe.profile.curves = curves;
    lathe.profile.loop_ends = {static_cast<std::uint32_t>(curves.size())};
    Diagnostics diagnostics;
    lathe.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    lathe.prepare();
    return lathe;
}

Lathe of_lines(const std::vector<Vec2>& points) {
    std::vector<ProfileCurve> curves;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        curves.push_back(line_curve(points[i], points[i + 1]));
    }
    return turned(curves);
}

TEST(Lathe, OfLinesIsTheCone) {
    Random random(61);
    int crossings = 0;
    for (int i = 0; i < 20000; ++i) {
        const double r0 = random.below(4) == 0 ? 0 : random.uniform(0.2, 2);
        const double r1 = random.below(4) == 0 || r0 == 0 ? random.uniform(0.2, 2) : r0;
        const Lathe lathe = of_lines({{0, -1}, {r0, -1}, {r1, 1.5}, {0, 1.5}});
        Cone cone{.base = {0, 0, -1}, .top = {0, 0, 1.5}, .base_radius = r0, .top_radius = r1};
        cone.prepare();
        const Vec3 o = random.in_cube(5);
        Vec3 d = random.in_cube(1.2) - o;
        // Includes horizontal, nearly horizontal, steep and vertical rays.
        const double tilt[] = {0, 1e-17, 1e-13, 1e-9, 1e-5};
        if (i % 2 == 0) d.z = tilt[random.below(5)] * random.sign();
        if (i % 16 == 1) d = {0, 0, 1};
        const Ray ray = line(o, d);
        ShapeHits hits;
        lathe.intersect(ray, hits);
        ShapeHit expected[2];
        const int n = cone.intersect(ray, expected);
        ASSERT_EQ(static_cast<int>(hits.size()), n) << i;
        crossings += n;
        for (int k = 0; k < n; ++k) {
            ASSERT_NEAR(hits[k].t, expected[k].t, 1e-11 * (1 + std::abs(hits[k].t))) << i;
            const Vec3 a = lathe.surface(ray, hits[k]).normal;
            const Vec3 b = cone.surface(ray, expected[k]).normal;
            if (std::abs(dot(b, d)) < 1e-3 * length(d)) continue;
            ASSERT_LT(length(a - b), 1e-6) << i;
        }
    }
    EXPECT_GT(crossings, 5000);
}

/// z = r^2 up to z = 4, exactly: the quadratic curve (2 s, 4 s^2) as a cubic.
Lathe paraboloid() {
    return turned({cubic_curve({0, 0}, {2.0 / 3, 0}, {4.0 / 3, 4.0 / 3}, {2, 4}),
                   line_curve({2, 4}, {0, 4})});
}

TEST(Lathe, OfAParabolaIsTheParaboloidAtEveryTilt) {
    const Lathe lathe = paraboloid();
    Random random(62);
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 inner{0.3 * random.uniform(), 0.3 * random.uniform(), random.uniform(1, 3)};
        const double tilt = random.below(8) == 0 ? 0.0 : random.log_uniform(1e-17, 1);
        const double turn = random.uniform(0, 6.28);
        const Vec3 d{std::cos(turn), std::sin(turn), random.sign() * tilt};
        const Ray ray = line(inner - random.uniform(-4, 4) * d, d);
        ShapeHits hits;
        lathe.intersect(ray, hits);
        ASSERT_EQ(hits.size(), 2u) << i << " tilt " << tilt;
        for (const ShapeHit& hit : hits) {
            if (hit.part != 0) continue;
            // a t^2 + 2 b t + c of x^2 + y^2 - z.
            const Vec3 o = ray.origin;
            const double a = d.x * d.x + d.y * d.y;
            const double b = o.x * d.x + o.y * d.y - d.z / 2, c = o.x * o.x + o.y * o.y - o.z;
            const QuadraticRoots roots = solve_half_b_quadratic(a, b, c);
            ASSERT_EQ(roots.count, 2);
            const double off = std::min(std::abs(hit.t - roots.t0), std::abs(hit.t - roots.t1));
            worst = std::max(worst, off);
            ASSERT_LT(off, 1e-12) << i << " tilt " << tilt;
        }
    }
    EXPECT_LT(worst, 1e-13);
}

TEST(Lathe, ARingOfCurvesIsCrossedFourTimes) {
    const Lathe ring = turned({cubic_curve({2, 0}, {2, 1}, {4, 1}, {4, 0}),
                               cubic_curve({4, 0}, {4, -1}, {2, -1}, {2, 0})});
    EXPECT_TRUE(ring.closed());
    ShapeHits hits;
    const Ray ray = line({-9, 0, 0.125}, {1, 0, 0});
    ring.intersect(ray, hits);
    ASSERT_EQ(hits.size(), 4u);
    EXPECT_NEAR(hits[0].t + hits[3].t, 18, 1e-14);
    EXPECT_NEAR(hits[1].t + hits[2].t, 18, 1e-14);
    for (int i = 0; i < 4; ++i) {
        const ShapeSurface s = ring.surface(ray, hits[i]);
        EXPECT_GT(dot(s.normal, ray.direction) * (i % 2 == 0 ? -1 : 1), 0.5);
    }
    hits.clear();
    ring.intersect(line({0, 0, -9}, {0, 0, 1}), hits);
    EXPECT_EQ(hits.size(), 0u);
    // Height at the midpoint of a curve: 3/4 at radius 3.
    ring.intersect(line({3, 0, -9}, {0, 0, 1}), hits);
    ASSERT_EQ(hits.size(), 2u);
    EXPECT_NEAR(hits[0].t, 9 - 0.75, 1e-14);
    EXPECT_NEAR(hits[1].t, 9 + 0.75, 1e-14);
}

TEST(Lathe, RaysThroughTheRimsAndAlongTheFloorsCrossEvenly) {
    const Lathe vase = of_lines({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});
    for (const double z : {0.0, 1.0, 3.0, 0.5}) {
        for (const double tilt : {0.0, 1e-18, -1e-14, 1e-8}) {
            ShapeHits hits;
            vase.intersect(line({-5, 0.25, z}, {1, 0, tilt}), hits);
            EXPECT_EQ(hits.size() % 2, 0u) << z << " " << tilt;
            for (std::size_t i = 1; i < hits.size(); ++i) EXPECT_LE(hits[i - 1].t, hits[i].t);
        }
    }
}

TEST(Lathe, RaysThatHardlyClimbMeetFlatEndsWhereTheirHeightIs) {
    const Lathe vase = of_lines({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});
    Random random(63);
    for (int i = 0; i < 20000; ++i) {
        const double tilt = random.sign() * random.log_uniform(1e-17, 1e-2);
        const Vec3 d{1, 0, tilt};
        // Through the rim at height 1, where the radius is 1 to 2: out of the foot and then through
        // the neck, or into the foot.
        const Vec3 o{-4, random.uniform(-0.9, 0.9), 1 - tilt * random.uniform(2.5, 2.9)};
        const double through = (1 - o.z) / tilt;
        const double x = -4 + through, r = std::sqrt(x * x + o.y * o.y);
        if (!(x < 0 && r > 1.0001 && r < 1.9999)) continue;
        ShapeHits hits;
        vase.intersect(line(o, d), hits);
        ASSERT_EQ(hits.size(), tilt > 0 ? 4u : 2u) << i << " tilt " << tilt;
        const ShapeHit& rim = hits[tilt > 0 ? 1 : 0];
        EXPECT_EQ(rim.part, 2u) << i << " tilt " << tilt;
        EXPECT_NEAR(rim.t, through, 4e-16 * through) << i << " tilt " << tilt;
    }
}

TEST(Lathe, IsASolidWhereItsLoopsCloseOrEndOnTheAxis) {
    EXPECT_TRUE(of_lines({{0, 0}, {1, 1}, {0, 2}}).closed());
    EXPECT_TRUE(of_lines({{1, 0}, {2, 1}, {1, 2}, {1, 0}}).closed());
    EXPECT_FALSE(of_lines({{1, 0}, {2, 1}, {0, 2}}).closed());
    Lathe wrong;
    wrong.profile.curves = {line_curve({0, 0}, {-1, 1})};
    wrong.profile.loop_ends = {1};
    Diagnostics diagnostics;
    wrong.validate({}, diagnostics);
    EXPECT_GE(diagnostics.error_count(), 1u);
}

Lathe of_loops(const std::vector<std::vector<Vec2>>& loops) {
    Lathe lathe;
    for (const std::vector<Vec2>& loop : loops) {
        for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
            lathe.profile.curves.push_back(line_curve(loop[i], loop[i + 1]));
        }
        lathe.profile.loop_ends.push_back(static_cast<std::uint32_t>(lathe.profile.curves.size()));
    }
    lathe.prepare();
    EXPECT_TRUE(lathe.is_closed);
    return lathe;
}

TEST(Lathe, WhatTwoLoopsShareIsNoSurface) {
    // A ring as the difference of two cylinders with common ends; with a common slanted end; as
    // two loops that share a wall; the same wall three times.
    const auto ring = of_lines({{0.5, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {0.5, 0.5}, {0.5, -0.5}});
    const auto cone = of_lines({{0.5, 0.5}, {1.5, 1.5}, {1.5, 2}, {0.5, 2}, {0.5, 0.5}});
    const std::vector<Vec2> first{{0.5, -0.5}, {1, -0.5}, {1, 0.5}, {0.5, 0.5}, {0.5, -0.5}};
    const std::vector<Vec2> last{{1.5, -0.5}, {1, -0.5},  {1, 0.25},
                                 {1, 0.5},    {1.5, 0.5}, {1.5, -0.5}};
    const std::vector<Vec2> whole{{0, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {0, 0.5}};
    const std::vector<Vec2> core{{0, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {0, 0.5}};
    std::size_t met = 0;
    expect_same_crossings(of_loops({whole, core}), ring, met);
    expect_same_crossings(of_loops({first, last}), ring, met);
    expect_same_crossings(of_loops({whole, core, core, core}), ring, met);
    expect_same_crossings(
        of_loops({{{0, 0}, {1.5, 1.5}, {1.5, 2}, {0, 2}}, {{0, 2}, {0.5, 2}, {0.5, 0.5}, {0, 0}}}),
        cone, met);
    EXPECT_GT(met, 4000u);
}

TEST(Lathe, LoopsThatCancelOutAreNothing) {
    const std::vector<Vec2> loop{{0, -0.5}, {1.5, -0.5}, {1.5, 0.5}, {0, 0.5}};
    const Lathe nothing = of_loops({loop, loop});
    Random random(68);
    for (int i = 0; i < 300; ++i) {
        const Vec3 o = random.in_cube(3);
        ShapeHits hits;
        nothing.intersect(line(o, random.in_cube(1) - 0.4 * o), hits);
        ASSERT_TRUE(hits.empty());
    }
    EXPECT_GE(nothing.box().hi.x, 1.5);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
