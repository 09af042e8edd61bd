#include "alhazen/geometry/motion/transform_motion.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr double kPi = std::numbers::pi;

double distance(const Affine& a, const Affine& b) {
    double most = 0;
    for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        most = std::max(most, length(a.point(p) - b.point(p)));
    }
    return most;
}

TEST(TransformMotion, TurnsEvenlyAboutTheAxis) {
    const Vec3 axis{1, 2, -0.5};
    for (const double turn : {0.3, 1.5, 3.0}) {
        const TransformKey keys[] = {
            {0, Affine::translate({1, 0, 0})},
            {2, Affine::translate({3, 0, 1}) * Affine::rotate(axis, turn)}};
        const TransformMotion motion(keys);
        for (const double u : {0.0, 0.25, 0.5, 0.9, 1.0}) {
            const Affine expected =
                Affine::translate({1 + 2 * u, 0, u}) * Affine::rotate(axis, turn * u);
            const Placement found = motion.at(2 * u);
            EXPECT_LT(distance(found.outer_from_inner, expected), 1e-14) << turn << ' ' << u;
            EXPECT_LT(distance(found.outer_from_inner * found.inner_from_outer, Affine{}), 1e-13);
        }
    }
}

TEST(TransformMotion, ShowsTheKeysBitsAndRestsOutsideOfThem) {
    const Affine a = Affine::rotate({0, 1, 0}, 0.1) * Affine::scale({1, 2, 3});
    const Affine b = Affine::translate({5, 6, 7}) * Affine::scale({2, 2, 0.5});
    const TransformKey keys[] = {{-1, a}, {0.5, b}, {4, a}};
    const TransformMotion motion(keys);
    EXPECT_EQ(motion.at(-1).outer_from_inner, a);
    EXPECT_EQ(motion.at(-7).outer_from_inner, a);
    EXPECT_EQ(motion.at(0.5).outer_from_inner, b);
    EXPECT_EQ(motion.at(9).outer_from_inner, a);
    const TransformKey one[] = {{0.3, b}};
    EXPECT_EQ(TransformMotion(one).at(0.9).outer_from_inner, b);
}

TEST(TransformMotion, StretchesLinearly) {
    const TransformKey keys[] = {{0, Affine::scale({1, 1, 1})}, {1, Affine::scale({3, 1, -1})}};
    EXPECT_NE(fault_of(keys), nullptr);  // turns inside out
    const TransformKey grows[] = {{0, Affine::scale({1, 1, -1})}, {1, Affine::scale({3, 1, -2})}};
    ASSERT_EQ(fault_of(grows), nullptr);
    EXPECT_LT(
        distance(TransformMotion(grows).at(0.5).outer_from_inner, Affine::scale({2, 1, -1.5})),
        1e-14);
}

TEST(TransformMotion, TheFrameAroundItDoesNotBendItsPath) {
    const Affine outer = Affine::scale({4, 1, 1}) * Affine::translate({0, 0, 3});
    const TransformKey keys[] = {{0, Affine{}}, {1, Affine::rotate({0, 0, 1}, kPi / 2)}};
    const TransformMotion motion = TransformMotion(keys).inside(outer);
    EXPECT_LT(distance(motion.at(0.5).outer_from_inner, outer * Affine::rotate({0, 0, 1}, kPi / 4)),
              1e-14);
}

TEST(TransformMotion, FaultsAreNamed) {
    const TransformKey same_time[] = {{1, Affine{}}, {1, Affine{}}};
    const TransformKey flat[] = {{1, Affine{}}, {2, Affine::scale({1, 0, 1})}};
    EXPECT_STREQ(fault_of(same_time), "the times of a motion's keys must ascend");
    EXPECT_STREQ(fault_of(flat), "a motion's transforms must be finite and have an inverse");
}

/// Points of random boxes at random times, under random motions of up to four keys.
TEST(TransformMotion, BoundsHoldAtEveryTime) {
    std::mt19937_64 random(7);
    const auto number = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    const auto vector = [&](double size) {
        return Vec3{number(-size, size), number(-size, size), number(-size, size)};
    };
    for (int i = 0; i < 300; ++i) {
        std::vector<TransformKey> keys;
        double time = number(-1, 0.5);
        for (int k = 0; k < 1 + i % 4; ++k, time += number(0.05, 0.8)) {
            const Vec3 factors{number(0.3, 2), number(0.3, 2), number(0.3, 2)};
            keys.push_back(
                {time, Affine::translate(vector(5)) * Affine::rotate(vector(1), number(-1.5, 1.5)) *
                           Affine::scale(factors)});
        }
        ASSERT_EQ(fault_of(keys), nullptr);
        TransformMotion motion(keys);
        if (i % 3 == 0) motion = motion.inside(Affine::scale({2, 1, 0.5}));
        Box3 inner;
        inner.include(vector(2));
        inner.include(vector(2));
        const MovingBox bounds = motion.bounds(inner);
        for (int n = 0; n < 200; ++n) {
            const double t = n < 2 ? n : number(0, 1);
            const Vec3 p{number(inner.lo.x, inner.hi.x), number(inner.lo.y, inner.hi.y),
                         number(inner.lo.z, inner.hi.z)};
            const Vec3 corner = n % 2 == 0 ? p : inner.corner(n % 8);
            const Vec3 outer = motion.at(t).outer_from_inner.point(corner);
            ASSERT_TRUE(bounds.at(t).contains(outer)) << i << ' ' << t;
        }
        // Of use: no larger than what the motion sweeps and a half around it.
        Box3 swept;
        for (int n = 0; n <= 64; ++n) {
            for (int c = 0; c < 8; ++c) {
                swept.include(motion.at(n / 64.0).outer_from_inner.point(inner.corner(c)));
            }
        }
        EXPECT_LE(max_component(bounds.swept().size()), 2.0 * max_component(swept.size()));
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
