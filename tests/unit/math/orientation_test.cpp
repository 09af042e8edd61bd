#include "alhazen/math/orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Exact sign for small integers.
int sign_of_integers(long a, long b, long c, long d, long e, long f) {
    const long sum = (a - e) * (d - f) - (b - f) * (c - e);
    return int(sum > 0) - int(sum < 0);
}

TEST(Orientation, LeftTurnsArePositive) {
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(orientation({0, 0}, {0, 1}, {1, 0}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Orientation, MultiplesOfAnyFactorKeepTheSignOfTheirIntegers) {
    std::mt19937 random(3);
    std::uniform_int_distribution<long> number(-10, 10);
    // A factor with few digits keeps the products of these numbers exact, collinear points
    // included.
    const double factor = 1.0 + std::ldexp(1.0, -40);
    int straight = 0;
    for (int i = 0; i < 20000; ++i) {
        const long a = number(random), b = number(random), c = number(random);
        const long d = number(random), e = number(random), f = number(random);
        const int expected = sign_of_integers(a, b, c, d, e, f);
        EXPECT_EQ(orientation({factor * double(a), factor * double(b)},
                              {factor * double(c), factor * double(d)},
                              {factor * double(e), factor * double(f)}),
                  expected);
        straight += expected == 0 ? 1 : 0;
    }
    EXPECT_GT(straight, 100);
}

TEST(Orientation, TheNextDoubleBesideALineIsBesideIt) {
    // Points (k, k) / 10 with each coordinate rounded separately are exactly on x = y.
    for (int k = 1; k < 200; ++k) {
        const double x = k / 10.0;
        const double above = std::nextafter(x, 1e9);
        const double below = std::nextafter(x, -1e9);
        EXPECT_EQ(orientation({0.1, 0.1}, {24.3, 24.3}, {x, x}), 0);
        EXPECT_EQ(orientation({0.1, 0.1}, {24.3, 24.3}, {x, above}), 1);
        EXPECT_EQ(orientation({0.1, 0.1}, {24.3, 24.3}, {x, below}), -1);
        EXPECT_EQ(orientation({24.3, 24.3}, {0.1, 0.1}, {x, above}), -1);
    }
}

TEST(Orientation, CyclicOrderDoesNotMatterEvenNearALine) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 20000; ++i) {
        const Vec2 a{unit(random), unit(random)};
        const Vec2 b{1e9 * unit(random), 1e-9 * unit(random)};
        const double t = unit(random);
        const Vec2 c = a + t * (b - a);  // on the line up to rounding
        const int sign = orientation(a, b, c);
        EXPECT_EQ(orientation(b, c, a), sign);
        EXPECT_EQ(orientation(c, a, b), sign);
        EXPECT_EQ(orientation(b, a, c), -sign);
    }
}

TEST(Orientation, NanHasNoSide) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(orientation({0, nan}, {1, 0}, {0, 1}), 0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
