#include "alhazen/imaging/film/filter_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "alhazen/imaging/film/sample_sum.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Integrals of the kernel and of its magnitude by the midpoint rule.
struct Integrals {
    double kernel = 0, magnitude = 0;
};
Integrals integrals(const FilterEntry& entry, double radius, double from, double to) {
    constexpr int kSteps = 40000;
    Integrals sum;
    for (int k = 0; k < kSteps; ++k) {
        const double value = entry.value(from + (to - from) * (k + 0.5) / kSteps, radius);
        sum.kernel += value * (to - from) / kSteps;
        sum.magnitude += std::abs(value) * (to - from) / kSteps;
    }
    return sum;
}

TEST(FilterKernel, IsThatOfItsSource) {
    const auto value = [](const char* name, double x, double radius) {
        return find_filter(name)->value(x, radius);
    };
    EXPECT_EQ(value("tent", 0.25, 1), 0.75);
    // Mitchell and Netravali 1988, equation 8 with B = C = 1/3.
    EXPECT_NEAR(value("mitchell", 0, 2), 16.0 / 18, 1e-15);
    EXPECT_NEAR(value("mitchell", 1, 2), 1.0 / 18, 1e-15);
    EXPECT_NEAR(value("mitchell", 2, 2), 0, 1e-14);
    EXPECT_NEAR(integrals(*find_filter("mitchell"), 2, -2, 2).kernel, 1, 1e-8);
    EXPECT_NEAR(value("gaussian", 0.5, 1.5), std::exp(-0.5), 1e-15);
    EXPECT_NEAR(value("blackman_harris", 0, 1.5), 1, 1e-15);
    EXPECT_NEAR(value("blackman_harris", 1.5, 1.5), 6e-5, 1e-12);
    for (const double zero : {1.0, 2.0, 3.0}) EXPECT_NEAR(value("lanczos", zero, 3), 0, 1e-15);
    EXPECT_EQ(value("lanczos", 0, 3), 1);
    EXPECT_EQ(find_filter("Box"), nullptr);
}

TEST(FilterKernel, OfAnEvenKernelHasTheBitsOfTheTable) {
    // A kernel of 2 instead of 1 has the same shares, and all its arithmetic is exact.
    const FilterEntry twice{"twice", "", 0.5, [](double, double) { return 2.0; }, nullptr};
    for (const double radius : {0.5, 0.7}) {
        const FilterKernel even(*find_filter("box"), radius), table(twice, radius);
        for (int k = 0; k < 100000; ++k) {
            const Vec2 u{k / 100000.0, std::ldexp(1.0 + k / 100000.0, -1 - k % 60)};
            const auto a = even.draw(u), b = table.draw(u);
            ASSERT_EQ(a.offset, b.offset) << k;
            ASSERT_EQ(a.sign, b.sign);
        }
    }
}

TEST(FilterKernel, DrawsInProportionToItsMagnitude) {
    for (const FilterEntry& entry : filters()) {
        for (const double radius : {0.3, entry.radius, 4.0}) {
            SCOPED_TRACE(entry.name);
            const FilterKernel kernel(entry, radius);
            constexpr int kBins = 24, kDraws = 240000;
            std::vector<double> counts(kBins), signs(kBins);
            double last = -radius;
            for (int k = 0; k < kDraws; ++k) {
                const auto drawn = kernel.draw({(k + 0.5) / kDraws, 0.5});
                ASSERT_GE(drawn.offset.x, last);
                ASSERT_LE(drawn.offset.x, radius);
                last = drawn.offset.x;
                const double at =
                    std::min((drawn.offset.x + radius) / (2 * radius) * kBins, kBins - 1.0);
                counts[static_cast<std::size_t>(at)] += 1.0 / kDraws;
                // The sign of the other coordinate is that of the middle: positive.
                signs[static_cast<std::size_t>(at)] += drawn.sign / kDraws;
            }
            const Integrals whole = integrals(entry, radius, -radius, radius);
            for (int bin = 0; bin < kBins; ++bin) {
                const double from = radius * (2.0 * bin / kBins - 1),
                             to = from + 2 * radius / kBins;
                const Integrals part = integrals(entry, radius, from, to);
                const auto b = static_cast<std::size_t>(bin);
                EXPECT_NEAR(counts[b], part.magnitude / whole.magnitude, 2e-5) << bin;
                EXPECT_NEAR(signs[b], part.kernel / whole.magnitude, 1e-3) << bin;
            }
            const double sign = whole.kernel / whole.magnitude;
            EXPECT_NEAR(kernel.mean_sign(), sign * sign, 2e-4);
            const std::string name = entry.name;
            EXPECT_EQ(kernel.has_negative_lobes(),
                      name == "mitchell" || (name == "lanczos" && radius > 1));
        }
    }
}

TEST(FilterKernel, KeepsAnEvenAreaWhateverTheSignsAre) {
    for (const double mean_sign : {1.0, 0.7}) {
        SampleSum sum;
        EXPECT_EQ(sum.value(mean_sign), Rgb{});
        for (int k = 0; k < 9; ++k) {
            EXPECT_TRUE(sum.add({0.25, 0.5, 1}, mean_sign < 1 && k % 4 == 0 ? -1.0 : 1.0));
        }
        EXPECT_FALSE(sum.add({NAN, 0, 0}, 1));
        EXPECT_EQ(sum.value(mean_sign), (Rgb{0.25, 0.5, 1}));
    }
}

TEST(FilterKernel, TheMeanOfManySignedSamplesIsTheFilteredEdge) {
    // An edge through the pixel's middle, shifted by s: the integral of the kernel beyond it.
    for (const char* name : {"mitchell", "lanczos", "gaussian", "tent"}) {
        const FilterEntry& entry = *find_filter(name);
        const FilterKernel kernel(entry, entry.radius);
        for (const double shift : {-1.3, -0.4, 0.0, 0.7, 1.9}) {
            constexpr int kSide = 500;
            SampleSum sum;
            for (int i = 0; i < kSide * kSide; ++i) {
                const auto drawn =
                    kernel.draw({(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide});
                const double seen = drawn.offset.x > shift ? 1.0 : 0.0;
                sum.add({seen, seen, seen}, drawn.sign);
            }
            const double expected =
                shift >= entry.radius
                    ? 0.0
                    : integrals(entry, entry.radius, std::max(shift, -entry.radius), entry.radius)
                              .kernel /
                          integrals(entry, entry.radius, -entry.radius, entry.radius).kernel;
            EXPECT_NEAR(sum.value(kernel.mean_sign()).r, expected, 0.006) << name << " " << shift;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
