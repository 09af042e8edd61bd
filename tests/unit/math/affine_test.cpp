#include "alhazen/math/affine.h"

#include <gtest/gtest.h>

#include "alhazen/math/interval.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

constexpr double kQuarterTurn = 1.5707963267948966;

Affine random_affine(Random& random) {
    return Affine::translate(random.in_cube(10)) *
           Affine::rotate(random.unit_vector(), random.uniform(0, 6)) *
           Affine::scale({random.uniform(0.2, 4), -random.uniform(0.2, 4), random.uniform(0.2, 4)});
}

double distance(const Vec3& a, const Vec3& b) {
    return length(a - b);
}

TEST(Affine, RotationsAreRightHanded) {
    EXPECT_LT(distance(Affine::rotate({0, 0, 2}, kQuarterTurn).vector({1, 0, 0}), {0, 1, 0}),
              1e-15);
    EXPECT_LT(distance(Affine::rotate({1, 0, 0}, kQuarterTurn).vector({0, 1, 0}), {0, 0, 1}),
              1e-15);
    EXPECT_LT(distance(Affine::rotate({0, 3, 0}, kQuarterTurn).vector({0, 0, 1}), {1, 0, 0}),
              1e-15);
}

TEST(Affine, RotationsKeepLengthsAndTheirAxis) {
    Random random(83);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 axis = random.unit_vector(), v = random.in_cube(3);
        const Affine turn = Affine::rotate(axis, random.uniform(-7, 7));
        ASSERT_NEAR(length(turn.vector(v)), length(v), 1e-14) << "seed 83, case " << i;
        ASSERT_LT(distance(turn.vector(axis), axis), 1e-15 * 4) << "seed 83, case " << i;
        ASSERT_NEAR(determinant(turn.linear), 1.0, 1e-14) << "seed 83, case " << i;
    }
}

TEST(Affine, VectorsAreNotTranslated) {
    const Affine move = Affine::translate({1, 2, 3});
    EXPECT_EQ(move.point({1, 1, 1}), (Vec3{2, 3, 4}));
    EXPECT_EQ(move.vector({1, 1, 1}), (Vec3{1, 1, 1}));
}

TEST(Affine, ProductsApplyTheRightFactorFirst) {
    Random random(84);
    for (int i = 0; i < 1000; ++i) {
        const Affine a = random_affine(random), b = random_affine(random);
        const Vec3 p = random.in_cube(5);
        ASSERT_LT(distance((a * b).point(p), a.point(b.point(p))), 1e-12) << "seed 84, case " << i;
        ASSERT_LT(distance((a * b).vector(p), a.vector(b.vector(p))), 1e-12) << "case " << i;
    }
}

TEST(Affine, InverseUndoes) {
    Random random(85);
    for (int i = 0; i < 1000; ++i) {
        const Affine a = random_affine(random);
        const Vec3 p = random.in_cube(5);
        ASSERT_TRUE(is_invertible(a));
        ASSERT_LT(distance(inverse(a).point(a.point(p)), p), 1e-12) << "seed 85, case " << i;
        ASSERT_LT(distance(a.point(inverse(a).point(p)), p), 1e-12) << "seed 85, case " << i;
        // Normals, transformed by the inverse transpose, stay perpendicular to tangents.
        const Vec3 u = random.unit_vector(), n = perpendicular(u);
        const Vec3 moved = transpose_times(inverse(a).linear, n);
        ASSERT_NEAR(dot(moved, a.vector(u)), 0.0, 1e-13) << "seed 85, case " << i;
    }
}

TEST(Affine, SingularTransformsAreRecognised) {
    EXPECT_FALSE(is_invertible(Affine::scale({1, 0, 1})));
    EXPECT_FALSE(is_invertible({{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}, {}}));
    EXPECT_FALSE(is_invertible(Affine::translate({std::nan(""), 0, 0})));
    EXPECT_FALSE(is_invertible(Affine::scale({1e-200, 1e-200, 1})));
    EXPECT_TRUE(is_invertible(Affine::scale({1e-50, 1e-50, 1e-50})));
    // The determinant overflows: the adjugate over it would be zero.
    EXPECT_FALSE(is_invertible(Affine::scale({1e103, 1e103, 1e103})));
    EXPECT_TRUE(is_invertible(Affine::scale({1e100, 1e100, 1e100})));
}

TEST(Vec3, PerpendicularIsUnitAndPerpendicular) {
    Random random(86);
    for (int i = 0; i < 10000; ++i) {
        Vec3 n = random.unit_vector();
        if (i < 6) n = Vec3{i == 0 || i == 1 ? 1.0 : 0.0, i == 2 || i == 3 ? 1.0 : -0.0, 0.0};
        if (i == 4) n = {0, 0, 1};
        if (i == 5) n = {0, -0.0, -1};
        const Vec3 p = perpendicular(n);
        ASSERT_NEAR(length(p), 1.0, 1e-14) << "seed 86, case " << i;
        ASSERT_NEAR(dot(p, n), 0.0, 1e-14) << "seed 86, case " << i;
    }
}

TEST(Vec3, DominantAxisIsTheLowestOfTheLongest) {
    EXPECT_EQ(dominant_axis({-3, 2, 1}), 0);
    EXPECT_EQ(dominant_axis({1, -3, 2}), 1);
    EXPECT_EQ(dominant_axis({1, 2, -3}), 2);
    EXPECT_EQ(dominant_axis({2, -2, 2}), 0);
    EXPECT_EQ(dominant_axis({1, 2, -2}), 1);
    EXPECT_EQ(dominant_axis({0, -0.0, 0}), 0);
}

TEST(Interval, IsEmptyUntilSomethingIsIncluded) {
    Interval range;
    EXPECT_TRUE(range.empty());
    EXPECT_EQ(range.width(), 0.0);
    EXPECT_FALSE(range.contains(0.0));
    range.include(2.0);
    range.include(-1.0);
    EXPECT_EQ(range, (Interval{-1, 2}));
    EXPECT_EQ(range.width(), 3.0);
    EXPECT_TRUE(range.contains(2.0));
    EXPECT_EQ(hull(range, Interval{}), range);
    EXPECT_TRUE(intersection(range, {3, 4}).empty());
    EXPECT_EQ(intersection(range, {1, 4}), (Interval{1, 2}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
