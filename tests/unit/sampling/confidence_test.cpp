#include "alhazen/sampling/confidence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "alhazen/sampling/random.h"

namespace alhazen {
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

}  // namespace
}  // namespace alhazen
