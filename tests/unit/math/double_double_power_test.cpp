#include "alhazen/math/double_double_power.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Relative difference of the high parts.
double difference(const DoubleDouble& a, const DoubleDouble& b) {
    return std::abs((a - b).high) / std::abs(b.high);
}

TEST(DoubleDoublePower, ARootToItsPowerIsTheNumber) {
    Random random(7);
    for (int i = 0; i < 2000; ++i) {
        const DoubleDouble x(random.uniform(0.01, 4));
        const double n = std::floor(random.uniform(2, 9));
        const DoubleDouble root = power(x, quotient(DoubleDouble(1.0), DoubleDouble(n)));
        EXPECT_LT(difference(power(root, DoubleDouble(n)), x), 0x1p-90) << x.high << ' ' << n;
    }
}

TEST(DoubleDoublePower, ExponentialsOfSumsAreProducts) {
    Random random(8);
    for (int i = 0; i < 2000; ++i) {
        const DoubleDouble a(random.uniform(-300, 300)), b(random.uniform(-300, 300));
        EXPECT_LT(difference(exponential(a) * exponential(b), exponential(a + b)), 0x1p-88);
    }
}

TEST(DoubleDoublePower, EndsAtTheRangeOfDouble) {
    EXPECT_EQ(exponential(DoubleDouble(-800.0)).high, 0.0);
    EXPECT_EQ(exponential(DoubleDouble(800.0)).high, kInfinite);
    EXPECT_EQ(exponential(DoubleDouble(kInfinite)).high, kInfinite);
    EXPECT_TRUE(std::isnan(exponential(DoubleDouble(std::nan(""))).high));
    EXPECT_EQ(power(DoubleDouble(1e200), DoubleDouble(2.5)).high, kInfinite);
    EXPECT_FALSE(std::isfinite(power(DoubleDouble(kInfinite), DoubleDouble(2.5)).high));
    EXPECT_EQ(power(DoubleDouble(-1.0), DoubleDouble(2.5)).high, 0.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
