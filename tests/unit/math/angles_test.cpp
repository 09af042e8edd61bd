// Angles and points of the unit circle are correct to about a unit in the last place.

#include "alhazen/math/angles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(Angles, AnglesAreCorrectToThreeUlp) {
    Random random(5);
    for (int i = 0; i < 400000; ++i) {
        // Along the axes, and anywhere.
        const double scale = random.log_uniform(1e-100, 1e100);
        const double small = i % 2 == 0 ? random.log_uniform(1e-12, 1) : random.uniform(0, 1);
        const double sign = i % 3 == 0 ? -1 : 1;
        const double y = scale * (i % 4 < 2 ? small : 1.0);
        const double x = sign * scale * (i % 4 < 2 ? 1.0 : small);
        const long double exact = std::atan2(static_cast<long double>(y), x);
        const double found = angle_from_axis(y, x);
        const double ulp = std::nextafter(static_cast<double>(exact), 4.0) - double(exact);
        ASSERT_LE(std::abs(static_cast<double>(found - exact)), 3 * ulp) << y << " " << x;
        ASSERT_EQ(angle_from_axis(-y, x), found);
    }
    EXPECT_EQ(angle_from_axis(0.0, 1.0), 0.0);
    EXPECT_EQ(angle_from_axis(1.0, 0.0), 0.5 * kPi);
    EXPECT_EQ(angle_from_axis(0.0, -1.0), kPi);
    EXPECT_EQ(angle_from_axis(0.0, 0.0), 0.0);
}

TEST(Angles, NoNumberHasNoAngle) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double other : {-1.0, 0.0, 1.0}) {
        EXPECT_TRUE(std::isnan(angle_from_axis(kNan, other)));
        EXPECT_TRUE(std::isnan(angle_from_axis(other, kNan)));
    }
}

TEST(Angles, DirectionsAreCorrectToAnUlpOfOne) {
    Random random(6);
    for (int i = 0; i < 400000; ++i) {
        // Anywhere, and next to the quarters, where one coordinate vanishes.
        const double quarter = 0.5 * kPi * static_cast<double>(i % 5);
        const double away =
            i % 2 == 0 ? random.log_uniform(1e-15, 1) : -random.log_uniform(1e-15, 1);
        const double angle =
            std::max(0.0, i % 3 == 0 ? quarter + 0.7 * away : random.uniform(0, 7));
        const Vec2 found = direction_at(angle);
        const long double exact = angle;
        ASSERT_NEAR(found.x, static_cast<double>(std::cos(exact)), 0x1p-52) << angle;
        ASSERT_NEAR(found.y, static_cast<double>(std::sin(exact)), 0x1p-52) << angle;
    }
    EXPECT_EQ(direction_at(0.0), (Vec2{1.0, 0.0}));
}

TEST(Angles, DirectionsAfterTurnsAreCorrectToAnUlpOfOne) {
    Random random(8);
    constexpr long double kTurn = 6.283185307179586476925286766559L;
    for (int i = 0; i < 400000; ++i) {
        const double eighths = 0.125 * static_cast<double>(i % 9);
        const double away = random.sign() * random.log_uniform(1e-17, 0.1);
        const double turns =
            i % 2 == 0 ? random.uniform(0, 1) : std::clamp(eighths + away, 0.0, 1.0);
        const Vec2 found = direction_after(turns);
        ASSERT_NEAR(found.x, static_cast<double>(std::cos(kTurn * turns)), 0x1p-52) << turns;
        ASSERT_NEAR(found.y, static_cast<double>(std::sin(kTurn * turns)), 0x1p-52) << turns;
    }
    EXPECT_EQ(direction_after(0.25), (Vec2{0.0, 1.0}));
    EXPECT_EQ(direction_after(1.0), (Vec2{1.0, 0.0}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
