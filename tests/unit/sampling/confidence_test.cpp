#include "alhazen/sampling/confidence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Confidence, QuantilesOfStudentAreThoseOfTheTables) {
    // Abramowitz and Stegun, table 26.10 (two-sided 0.95 and 0.99).
    EXPECT_NEAR(student_quantile(0.95, 1), 12.706, 5e-4);
    EXPECT_NEAR(student_quantile(0.95, 2), 4.303, 5e-4);
    EXPECT_NEAR(student_quantile(0.95, 7), 2.365, 5e-4);
    EXPECT_NEAR(student_quantile(0.95, 15), 2.131, 5e-4);
    EXPECT_NEAR(student_quantile(0.95, 30), 2.042, 5e-4);
    EXPECT_NEAR(student_quantile(0.99, 7), 3.499, 5e-4);
    EXPECT_NEAR(student_quantile(0.99, 8), 3.355, 5e-4);
}

TEST(Confidence, IntervalsOfNormalNumbersHoldTheTruthAsOftenAsTheySay) {
    RandomStream random(7);
    constexpr int kRuns = 20000;
    int held = 0;
    for (int run = 0; run < kRuns; ++run) {
        std::array<double, 8> sample{};
        for (double& x : sample) {
            const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
            x = 3 + 0.5 * radius * std::cos(6.283185307179586 * random.uniform());
        }
        held += mean_of(sample).holds(3);
    }
    // Expected 0.95, standard deviation 0.0015.
    EXPECT_NEAR(held / double{kRuns}, 0.95, 0.006);
}

TEST(Confidence, DegreesOfFreedomFollowFromHowEvenlyThePartsScatter) {
    // Sums of parts of unequal scatter, each with one difference to tell it by.
    RandomStream random(11);
    constexpr int kRuns = 20000;
    for (const double ratio : {1.0, 0.8, 0.5}) {
        int held = 0;
        for (int run = 0; run < kRuns; ++run) {
            double sum = 0, squares = 0, fourths = 0, deviation = 1;
            for (int part = 0; part < 40; ++part, deviation *= ratio) {
                const auto normal = [&] {
                    const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
                    return deviation * radius * std::cos(6.283185307179586 * random.uniform());
                };
                sum += normal();
                const double square = std::pow(normal(), 2);
                squares += square;
                fourths += square * square;
            }
            held += estimate_of(sum, spread_of_differences(squares, fourths)).holds(0);
        }
        // An approximation where few parts dominate (0.5: fewer than two degrees).
        EXPECT_GE(held / double{kRuns}, ratio == 1.0 ? 0.945 : 0.92) << ratio;
        EXPECT_LE(held / double{kRuns}, 0.99) << ratio;
    }
    // No variance: certain.
    EXPECT_EQ(estimate_of(3, spread_of_differences(0, 0)).half_width, 0);
    // Of independent numbers the variances add up.
    const std::array<Spread, 2> two{Spread{3, 10}, Spread{4, 10}};
    EXPECT_NEAR(sum_of(two).deviation, 5, 1e-12);
    EXPECT_NEAR(sum_of(two).degrees, 625.0 / (81 / 10.0 + 256 / 10.0), 1e-9);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
