#include "alhazen/sampling/sobol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Sobol, FirstPointsAreThoseOfTheTable) {
    // Dimensions 1 to 3 in the order of the index, as multiples of 1/8.
    const int expected[8][3] = {{0, 0, 0}, {4, 4, 4}, {2, 6, 6}, {6, 2, 2},
                                {1, 5, 3}, {5, 1, 7}, {3, 3, 5}, {7, 7, 1}};
    for (std::uint32_t i = 0; i < 8; ++i) {
        for (int d = 0; d < 3; ++d) {
            EXPECT_EQ(sobol_digits(i, d) >> 29, static_cast<std::uint32_t>(expected[i][d]))
                << "point " << i << " dimension " << d;
        }
    }
}

TEST(Sobol, EveryDimensionOfEveryNetHasOnePointInEachInterval) {
    constexpr std::uint32_t kPoints = 1024;
    for (int d = 0; d < kSobolDimensions; ++d) {
        std::set<std::uint32_t> plain, scrambled;
        for (std::uint32_t i = 3 * kPoints; i < 4 * kPoints; ++i) {
            plain.insert(sobol_digits(i, d) >> 22);
            scrambled.insert(static_cast<std::uint32_t>(kPoints * scrambled_sobol(5, i, d)));
        }
        EXPECT_EQ(plain.size(), kPoints) << "dimension " << d;
        EXPECT_EQ(scrambled.size(), kPoints) << "dimension " << d;
    }
}

TEST(Sobol, ScramblingKeepsTheFirstTwoDimensionsANetInEveryShapeOfBox) {
    constexpr std::uint32_t kDigits = 8;
    for (std::uint64_t key = 0; key < 10; ++key) {
        for (std::uint32_t wide = 0; wide <= kDigits; ++wide) {
            std::set<std::uint32_t> boxes;
            for (std::uint32_t i = 0; i < 1u << kDigits; ++i) {
                const double x = scrambled_sobol(key, i, 0) * (1u << wide);
                const double y = scrambled_sobol(key, i, 1) * (1u << (kDigits - wide));
                boxes.insert(static_cast<std::uint32_t>(x) << 16 | static_cast<std::uint32_t>(y));
            }
            EXPECT_EQ(boxes.size(), 1u << kDigits) << "key " << key << " digits of x " << wide;
        }
    }
}

TEST(Sobol, AScrambledPointIsUniformAndScramblingsAreIndependent) {
    constexpr int kKeys = 40000;
    for (const int d : {0, 1, 15}) {
        std::vector<int> counts(64);
        double product = 0;
        for (std::uint64_t key = 0; key < kKeys; ++key) {
            const double x = scrambled_sobol(key, 777, d);
            ++counts[static_cast<std::size_t>(64 * x)];
            product += (x - 0.5) * (scrambled_sobol(key + 1, 777, d) - 0.5);
        }
        double chi_squared = 0;
        for (const int n : counts) chi_squared += (n - 625.0) * (n - 625.0) / 625.0;
        // 63 degrees of freedom: 63 +- 11; probability 1 in 10^5 above 118.
        EXPECT_LT(chi_squared, 118) << "dimension " << d;
        // Standard deviation 1 / 12 / sqrt(kKeys).
        EXPECT_LT(std::abs(product / kKeys), 4.5 / 12 / std::sqrt(double{kKeys}));
    }
}

TEST(Sobol, ScramblingKeepsHowManyDigitsTwoPointsShareAndMixesTheRest) {
    RandomStream random(3);
    int same_tail = 0;
    for (int round = 0; round < 4000; ++round) {
        const auto a = static_cast<std::uint32_t>(random.below(1 << 20));
        const auto b = static_cast<std::uint32_t>(random.below(1 << 20));
        if (a == b) continue;
        const std::uint32_t difference = sobol_digits(a, 4) ^ sobol_digits(b, 4);
        const double x = scrambled_sobol(9, a, 4);
        const double y = scrambled_sobol(9, b, 4);
        int shared = 0;
        while (((difference << shared) & 0x80000000u) == 0) ++shared;
        const auto digits = [](double v, int n) { return std::floor(std::ldexp(v, n)); };
        ASSERT_EQ(digits(x, shared), digits(y, shared)) << a << " " << b;
        ASSERT_NE(digits(x, shared + 1), digits(y, shared + 1)) << a << " " << b;
        const auto next = [&](double v) { return static_cast<int>(digits(v, shared + 3)) & 3; };
        same_tail += next(x) == next(y);
    }
    // Two digits of independent flips agree in a quarter of the cases; standard deviation 0.007.
    EXPECT_NEAR(same_tail / 4000.0, 0.25, 0.03);
}

TEST(Sobol, SumsOfASmoothFunctionConvergeMuchFasterThanIndependentPoints) {
    // Root mean square over keys of the error of the mean of x y over 2^12 points.
    double squares = 0;
    constexpr int kKeys = 50;
    constexpr std::uint32_t kPoints = 1 << 12;
    for (std::uint64_t key = 0; key < kKeys; ++key) {
        double sum = 0;
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            sum += scrambled_sobol(key, i, 2) * scrambled_sobol(key, i, 3);
        }
        const double error = sum / kPoints - 0.25;
        squares += error * error / kKeys;
    }
    // Independent points would have 0.22 / 64 = 3.4e-3.
    EXPECT_LT(std::sqrt(squares), 2e-5);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
