#include "alhazen/shapes/swept/prism.h"

#include <gtest/gtest.h>

#include "alhazen/shapes/polygons/box_shape.h"
#include "alhazen/shapes/polygons/polyhedron.h"
#include "support/random.h"
#include "support/same_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_same_crossings;
using testing::line;
using testing::Random;

void add_loop(Profile& profile, const std::vector<ProfileCurve>& curves) {
    profile.curves.insert(profile.curves.end(), curves.begin(), curves.end());
    profile.loop_ends.push_back(static_cast<std::uint32_t>(profile.curves.size()));
}

void add_rectangle(Profile& profile, Vec2 lo, Vec2 hi) {
    const Vec2 a{hi.x, lo.y}, b{lo.x, hi.y};
    add_loop(profile, {line_curve(lo, a), line_curve(a, hi), line_curve(hi, b), line_curve(b, lo)});
}

Prism prepared(Prism prism) {
    Diagnostics diagnostics;
    prism.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    prism.prepare();
    return prism;
}

/// A leaf bounded by two cubics.
Profile leaf() {
    Profile profile;
    add_loop(profile, {cubic_curve({-1, 0}, {-0.5, 1.5}, {0.8, 1}, {1, 0}),
                       cubic_curve({1, 0}, {0.3, -0.7}, {-0.2, 0.6}, {-1, 0})});
    return profile;
}

double area(const Profile& profile) {
    // x dy - y dx is of degree 5: three Gauss points are exact.
    const double offset = std::sqrt(0.6) / 2;
    double twice = 0;
    for (const ProfileCurve& c : profile.curves) {
        const double s[] = {0.5 - offset, 0.5, 0.5 + offset}, w[] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
        for (int i = 0; i < 3; ++i) {
            const Vec2 p = c.point(s[i]), d = c.derivative(s[i]);
            twice += w[i] * (p.x * d.y - p.y * d.x);
        }
    }
    return std::abs(twice) / 2;
}

double inside_length(const Prism& prism, const Ray& ray) {
    ShapeHits hits;
    prism.intersect(ray, hits);
    EXPECT_EQ(hits.size() % 2, 0u);
    double sum = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) sum += (i % 2 == 0 ? -1 : 1) * hits[i].t;
    return sum;
}

TEST(Prism, OfARectangleIsABox) {
    Random random(51);
    for (int i = 0; i < 5000; ++i) {
        const bool lattice = i % 2 == 1;
        const Vec3 lo = lattice ? random.on_lattice(2, 0.5) : random.in_cube(3);
        const Vec3 hi = lo + Vec3{1, 2, 0.5};
        Prism prism{.h0 = lo.z, .h1 = hi.z};
        add_rectangle(prism.profile, {lo.x, lo.y}, {hi.x, hi.y});
        prism = prepared(prism);
        const BoxShape box{.lo = lo, .hi = hi};
        const Vec3 o = lattice ? random.on_lattice(5, 0.25) : random.in_cube(8);
        const Vec3 d =
            lattice ? random.lattice_direction() : 0.5 * (lo + hi) - o + random.in_cube(1);
        ShapeHits hits;
        prism.intersect(line(o, d), hits);
        ShapeHit expected[2];
        const int n = box.intersect(line(o, d), expected);
        // On the lattice a ray along a side may belong to either side of it.
        if (lattice && static_cast<int>(hits.size()) != n) {
            bool grazes = false;
            for (int k = 0; k < 3; ++k) grazes |= d[k] == 0 && (o[k] == lo[k] || o[k] == hi[k]);
            grazes |= n == 2 && expected[0].t == expected[1].t;
            ASSERT_TRUE(grazes) << i;
            continue;
        }
        ASSERT_EQ(static_cast<int>(hits.size()), n) << i;
        for (int k = 0; k < n; ++k) ASSERT_NEAR(hits[k].t, expected[k].t, 1e-13) << i;
    }
}

TEST(Prism, TowardsAnApexIsAPyramid) {
    Random random(52);
    for (const double top : {0.0, 0.4, 1.7}) {
        Prism prism{.h0 = 1, .h1 = 3, .top_scale = top};
        add_rectangle(prism.profile, {-1, -0.5}, {2, 1});
        prism = prepared(prism);
        Polyhedron solid = hexahedron({Vec3{-1, -0.5, 1},
                                       {2, -0.5, 1},
                                       {2, 1, 1},
                                       {-1, 1, 1},
                                       Vec3{-top, -0.5 * top, 3},
                                       {2 * top, -0.5 * top, 3},
                                       {2 * top, top, 3},
                                       {-top, top, 3}});
        solid.prepare();
        int hit = 0;
        for (int i = 0; i < 5000; ++i) {
            const Vec3 o = random.in_cube(6);
            const Ray ray = line(o, Vec3{0.5, 0.2, 2} + random.in_cube(1) - o);
            ShapeHits hits;
            prism.intersect(ray, hits);
            ShapeHit expected[2];
            const int n = solid.intersect(ray, expected);
            ASSERT_EQ(static_cast<int>(hits.size()), n) << i << " " << top;
            for (int k = 0; k < n; ++k) {
                ASSERT_NEAR(hits[k].t, expected[k].t, 1e-12) << i;
                const Vec3 a = prism.surface(ray, hits[k]).normal;
                ASSERT_LT(length(a - solid.surface(ray, expected[k]).normal), 1e-9);
            }
            hit += n;
        }
        EXPECT_GT(hit, 4000);
    }
}

TEST(Prism, RaysAlongItsAxisMeetBothEndsOrNothing) {
    Prism prism{.h0 = -1, .h1 = 2};
    add_rectangle(prism.profile, {-2, -2}, {2, 2});
    add_rectangle(prism.profile, {-1, -1}, {1, 1});
    prism = prepared(prism);
    EXPECT_EQ(inside_length(prism, line({0, 0, 9}, {0, 0, -1})), 0);
    EXPECT_EQ(inside_length(prism, line({1.5, 0, 9}, {0, 0, -1})), 3);
    EXPECT_EQ(inside_length(prism, line({1.5, 1.9, -9}, {0, 0, 2})), 1.5);
    EXPECT_EQ(inside_length(prism, line({2.5, 0, 9}, {0, 0, -1})), 0);
    EXPECT_NEAR(inside_length(prism, line({-9, 0.5, 0}, {1, 0, 0})), 2, 1e-14);
    Prism cone = prism;
    cone.top_scale = 0;
    cone = prepared(cone);
    // Along the axis of a cone that is hollow there, and through its wall to the apex.
    EXPECT_EQ(inside_length(cone, line({0, 0, 9}, {0, 0, -1})), 0);
    EXPECT_NEAR(inside_length(cone, line({1.5, 0, 9}, {0, 0, -1})), 0.25 * 3, 1e-14);
    const Ray to_apex = line({1.5, 0, -1}, {-1.5, 0, 3});
    EXPECT_NEAR(inside_length(cone, to_apex), 1, 1e-14);
}

TEST(Prism, ChordsAddUpToTheAreaOfItsProfile) {
    const Prism prism = prepared({.profile = leaf()});
    const double exact = area(prism.profile);
    Random random(53);
    for (int k = 0; k < 4; ++k) {
        const double turn = random.uniform(0, 6.28);
        const Vec3 along{std::cos(turn), std::sin(turn), 0}, across{-along.y, along.x, 0};
        double sum = 0;
        const int n = 40000;
        for (int i = 0; i < n; ++i) {
            const Vec3 o = (4.0 * (i + 0.5) / n - 2.0) * across + Vec3{0, 0, 0.5};
            sum += inside_length(prism, line(o, along)) * 4.0 / n;
        }
        EXPECT_NEAR(sum, exact, 2e-6) << turn;
    }
}

TEST(Prism, CrossingsOfACurveLieOnItHoweverFarTheRayComes) {
    const Prism prism = prepared({.profile = leaf(), .top_scale = 0.5});
    Random random(54);
    int hits_seen = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 target{random.uniform(-1, 1), random.uniform(-0.3, 0.8), random.uniform(0, 1)};
        const Vec3 d = random.unit_vector();
        const double far = random.log_uniform(0.1, 1e6);
        const Ray ray = line(target - far * d, d);
        ShapeHits hits;
        prism.intersect(ray, hits);
        for (const ShapeHit& hit : hits) {
            const ShapeSurface s = prism.surface(ray, hit);
            // Ulps of the point and of the ray's distant origin.
            ASSERT_LT(length(s.point - ray.at(hit.t)), 1e-14 * (3 + far)) << i;
            ++hits_seen;
        }
    }
    EXPECT_GT(hits_seen, 3000);
}

TEST(Prism, RefusesWhatDoesNotClose) {
    Prism open;
    add_loop(open.profile, {line_curve({0, 0}, {1, 0}), line_curve({1, 0}, {1, 1})});
    Diagnostics diagnostics;
    open.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 1u);
    Prism broken;
    add_loop(broken.profile, {line_curve({0, 0}, {1, 0}), line_curve({1, 0.1}, {0, 0})});
    broken.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 2u);
    Prism{}.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 3u);
    Prism flat{.profile = leaf(), .h0 = 1, .h1 = 1};
    flat.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 4u);
}

Prism of_loops(const std::vector<std::vector<Vec2>>& loops, double top_scale) {
    Prism prism{.h0 = -0.5, .h1 = 1, .top_scale = top_scale};
    for (const std::vector<Vec2>& loop : loops) {
        std::vector<ProfileCurve> curves;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            curves.push_back(line_curve(loop[i], loop[(i + 1) % loop.size()]));
        }
        add_loop(prism.profile, curves);
    }
    return prepared(prism);
}

TEST(Prism, WhatLoopsShareIsNoSide) {
    const std::vector<Vec2> square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    const std::vector<Vec2> notch{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 1}, {-0.5, 1}};
    const std::vector<Vec2> notched{{-1, -1},    {1, -1},      {1, 1},    {0.5, 1},
                                    {0.5, -0.5}, {-0.5, -0.5}, {-0.5, 1}, {-1, 1}};
    const std::vector<Vec2> window{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    // One loop that goes to the window and comes back the same way.
    const std::vector<Vec2> keyhole{{-1, -1},     {1, -1},     {1, 1},     {0.5, 0.5}, {-0.5, 0.5},
                                    {-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {1, 1},     {-1, 1}};
    const std::vector<Vec2> below{{-1, -1}, {1, -1}, {1, 1}}, above{{1, 1}, {-1, 1}, {-1, -1}};
    std::size_t met = 0;
    for (const double top_scale : {1.0, 0.5, 0.0}) {
        const Prism whole = of_loops({square}, top_scale);
        expect_same_crossings(of_loops({square, notch}, top_scale), of_loops({notched}, top_scale),
                              met);
        expect_same_crossings(of_loops({keyhole}, top_scale), of_loops({square, window}, top_scale),
                              met);
        // Of halves, of three of which two cancel out, and beside a part of a diagonal.
        expect_same_crossings(of_loops({below, above}, top_scale), whole, met);
        expect_same_crossings(of_loops({notch, square, notch}, top_scale), whole, met);
        expect_same_crossings(
            of_loops({below, {{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}}, top_scale),
            of_loops({{{-1, -1}, {1, -1}, {1, 1}, {0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}}},
                     top_scale),
            met);
        EXPECT_EQ(whole.profile.curves.size(), 4u);
        EXPECT_EQ(of_loops({below, above}, top_scale).profile.curves.size(), 4u);
    }
    EXPECT_GT(met, 10000u);
}

TEST(Prism, CurvesThatLoopsShareInEitherDirectionAreNoSide) {
    const ProfileCurve wall = cubic_curve({0, -1}, {0.75, -0.5}, {-0.75, 0.5}, {0, 1});
    const ProfileCurve back = cubic_curve({0, 1}, {-0.75, 0.5}, {0.75, -0.5}, {0, -1});
    const auto lines = [](const std::vector<Vec2>& points) {
        std::vector<ProfileCurve> curves;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            curves.push_back(line_curve(points[i], points[i + 1]));
        }
        return curves;
    };
    const Prism square = of_loops({{{-1, -1}, {0, -1}, {1, -1}, {1, 1}, {0, 1}, {-1, 1}}}, 1);
    std::size_t met = 0;
    for (const bool same_way : {false, true}) {
        Prism prism{.h0 = -0.5, .h1 = 1};
        std::vector<ProfileCurve> left = lines({{0, 1}, {-1, 1}, {-1, -1}, {0, -1}});
        std::vector<ProfileCurve> right = same_way ? lines({{0, 1}, {1, 1}, {1, -1}, {0, -1}})
                                                   : lines({{0, -1}, {1, -1}, {1, 1}, {0, 1}});
        left.push_back(wall);
        right.push_back(same_way ? wall : back);
        add_loop(prism.profile, left);
        add_loop(prism.profile, right);
        expect_same_crossings(prepared(prism), square, met);
    }
    EXPECT_GT(met, 1000u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
