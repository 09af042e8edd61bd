#include "alhazen/imaging/film/binned_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

double value_of(const BinnedSum<1>& sum) {
    return sum.value()[0];
}

TEST(BinnedSum, IsTheSameInEveryOrder) {
    RandomStream random(9);
    for (const double range : {20.0, 700.0}) {
        std::vector<double> terms;
        for (int i = 0; i < 1000; ++i) {
            terms.push_back(std::exp(random.uniform(-range, range)) * (i % 2 == 0 ? 1.0 : -1.0));
        }
        double sum = 0.0, largest = 0.0;
        for (const double t : terms) largest = std::max(largest, std::abs(t));
        BinnedSum<1> forward, backward, sorted;
        for (const double t : terms) EXPECT_TRUE(forward.add({t}));
        std::reverse(terms.begin(), terms.end());
        for (const double t : terms) EXPECT_TRUE(backward.add({t}));
        std::sort(terms.begin(), terms.end(),
                  [](double a, double b) { return std::abs(a) < std::abs(b); });
        for (const double t : terms) {
            EXPECT_TRUE(sorted.add({t}));
            sum += t;
        }
        EXPECT_EQ(value_of(forward), value_of(backward));
        EXPECT_EQ(value_of(forward), value_of(sorted));
        EXPECT_NEAR(value_of(forward), sum, 1e-13 * largest);
    }
}

TEST(BinnedSum, IsExactForTermsOfAnySize) {
    for (int exponent = -1074; exponent < 1000; exponent += 7) {
        const double unit = std::ldexp(1.0, exponent);
        BinnedSum<1> sum;
        for (int i = 0; i < 5; ++i) EXPECT_TRUE(sum.add({-unit}));
        EXPECT_EQ(value_of(sum), -5 * unit);
        EXPECT_TRUE(sum.add({0x1p20 * unit}));
        EXPECT_TRUE(sum.add({5 * unit}));
        EXPECT_EQ(value_of(sum), 0x1p20 * unit);
    }
    const double largest = std::numeric_limits<double>::max();
    BinnedSum<1> sum;
    for (const double t : {largest, largest, -largest}) EXPECT_TRUE(sum.add({t}));
    EXPECT_EQ(value_of(sum), largest);
}

TEST(BinnedSum, LeavesOutAllOfWhatIsNotFinite) {
    BinnedSum<3> sum;
    EXPECT_TRUE(sum.add({1, 2, 3}));
    EXPECT_FALSE(sum.add({1, std::nan(""), 1}));
    EXPECT_FALSE(sum.add({1, 1, -std::numeric_limits<double>::infinity()}));
    EXPECT_EQ(sum.value(), (std::array<double, 3>{1, 2, 3}));
}

TEST(BinnedSum, IsTheSameOfSeveralThreads) {
    BinnedSum<2> sum;
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t) {
        threads.emplace_back([&sum, t] {
            for (int i = 0; i < 5000; ++i) sum.add({std::ldexp(1.0, 10 * t), -1.0});
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(sum.value(),
              (std::array<double, 2>{5000.0 * (1.0 + 0x1p10 + 0x1p20 + 0x1p30), -20000.0}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
