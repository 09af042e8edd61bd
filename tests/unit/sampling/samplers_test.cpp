#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "alhazen/sampling/analysis/discrepancy.h"
#include "alhazen/sampling/analysis/periodogram.h"
#include "alhazen/sampling/nested_scramble.h"
#include "alhazen/sampling/random.h"
#include "alhazen/sampling/samplers/point_sets.h"
#include "alhazen/sampling/samplers/sampler.h"
#include "alhazen/sampling/samplers/sobol_points.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::unique_ptr<Sampler> made(const std::string& name, std::uint32_t count,
                              std::uint64_t seed = 1) {
    const SamplerEntry* entry = find_sampler(name);
    EXPECT_NE(entry, nullptr) << name;
    return entry->make(seed, count);
}

std::vector<Vec2> points_of(const Sampler& sampler, const SamplePixel& pixel, std::uint32_t count,
                            std::uint32_t pair = 0) {
    std::vector<Vec2> points(count);
    sampler.points(pixel, pair, 0, points);
    return points;
}

/// Each cell of a grid of `columns` x `rows` has one point.
bool fills_grid(const std::vector<Vec2>& points, std::uint32_t columns, std::uint32_t rows) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> cells;
    for (const Vec2& p : points) {
        cells.insert(
            {static_cast<std::uint32_t>(p.x * columns), static_cast<std::uint32_t>(p.y * rows)});
    }
    return cells.size() == points.size() && points.size() == std::size_t{columns} * rows;
}

TEST(Samplers, GiveTheSameValuesInAnyPiecesAndOrder) {
    for (const SamplerEntry& entry : samplers()) {
        for (const std::uint32_t count : {1u, 7u, 16u, 100u}) {
            const auto whole = entry.make(3, count), again = entry.make(3, count);
            for (const std::uint32_t pair : {0u, 1u, 5u, 40u}) {
                const SamplePixel pixel{12, 65535};
                const std::vector<Vec2> points = points_of(*whole, pixel, count, pair);
                points_of(*again, {9, 9}, count, pair + 1);
                for (std::uint32_t s = count; s-- > 0;) {
                    EXPECT_EQ(again->at(pixel, pair, s), points[s]) << entry.name << " " << s;
                    EXPECT_TRUE(points[s].x >= 0 && points[s].x < 1 && points[s].y >= 0 &&
                                points[s].y < 1)
                        << entry.name;
                }
            }
        }
    }
}

TEST(Samplers, GiveRunsOfManyPixelsTheValuesOfEach) {
    for (const SamplerEntry& entry : samplers()) {
        for (const std::uint32_t count : {1u, 5u, 16u, 1u << 17}) {
            if (count > 16 && !entry.progressive) continue;
            const auto sampler = entry.make(7, count);
            // Neighbours, jumps, a pixel twice, parts of sets; enough points for the code of many
            // points.
            std::vector<SampleRun> runs;
            for (int i = 0; i < 60; ++i) {
                const SamplePixel pixel{i < 40 ? i % 8 : 65535 - 97 * i, i < 40 ? i / 8 : i * i};
                const std::uint32_t first = count > 16 ? 977u * static_cast<std::uint32_t>(i) : 0u;
                const std::uint32_t skipped = i % 3 == 0 ? 0 : std::min(count - 1, 2u);
                runs.push_back({pixel, first + skipped, std::min(count - skipped, 37u)});
                if (i % 7 == 0) runs.push_back(runs.back());
            }
            std::size_t size = 0;
            for (const SampleRun& run : runs) size += run.count;
            for (const std::uint32_t pair : {0u, 2u, 40u}) {
                std::vector<Vec2> points(size);
                sampler->points_of(runs, pair, points);
                for (std::size_t next = 0; const SampleRun& run : runs) {
                    for (std::uint32_t k = 0; k < run.count; ++k) {
                        EXPECT_EQ(points[next++], sampler->at(run.pixel, pair, run.first + k))
                            << entry.name << " " << run.first + k << " of " << count;
                    }
                }
            }
        }
    }
}

TEST(Samplers, PointsInLanesAreThoseOneByOne) {
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t i = 0; i < 503; ++i) numbers.push_back(i < 8 ? i - 4 : mix64(i) >> i % 64);
    for (std::uint64_t tree = 0; tree < 20; ++tree) {
        const ScrambleTrees trees{mix64(tree), mix64(tree + 100)};
        for (const std::size_t count :
             {std::size_t{0}, std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{5},
              std::size_t{7}, std::size_t{8}, std::size_t{9}, numbers.size()}) {
            std::vector<Vec2> alone(count);
            scrambled_points_one_by_one(trees, std::span(numbers).first(count), alone.data());
            for (const ScrambledPoints variant : variants_of_scrambled_points()) {
                std::vector<Vec2> lanes(count);
                variant(trees, std::span(numbers).first(count), lanes.data());
                EXPECT_EQ(lanes, alone);
            }
        }
    }
}

TEST(Samplers, ShuffledIndicesInLanesAreThoseOfEachSample) {
    const ShuffledIndices shuffle = shuffled_indices_in_lanes();
    if (shuffle == nullptr) GTEST_SKIP() << "no products of 64-bit words in lanes";
    PixelSamples samples;
    std::array<std::uint64_t, PixelSamples::kMost> found{};
    for (const int bits : {0, 1, 3, 8, 20}) {
        for (std::size_t i = 0; i < PixelSamples::kMost; ++i) {
            samples.first[i] = (mix64(i) >> 24) << bits;
            samples.key[i] = mix64(i / 5 + 1000);
            samples.number[i] = (i % 5 + mix64(i / 5)) & ((1u << bits) - 1);
        }
        shuffle(samples, PixelSamples::kMost, bits, found.data());
        for (std::size_t i = 0; i < PixelSamples::kMost; ++i) {
            const auto number = static_cast<std::uint32_t>(samples.number[i]);
            std::uint32_t shuffled = number;
            for (int bit = 0; bit < bits; ++bit) {
                shuffled ^= flip_of_sample(number, bit, samples.key[i]);
            }
            ASSERT_EQ(found[i], samples.first[i] | shuffled) << bits << " " << i;
        }
    }
}

TEST(Samplers, FewSobolPointsAreThoseOfLongRuns) {
    // Few are shuffled one after the other, many in lanes.
    constexpr std::uint32_t kCount = 1000;
    const auto sampler = find_sampler("sobol")->make(3, kCount);
    std::vector<Vec2> all(kCount), few(3);
    for (const std::uint32_t pair : {0u, 4u}) {
        sampler->points({17, 40}, pair, 0, all);
        for (std::uint32_t first = 0; first + 3 <= kCount; ++first) {
            sampler->points({17, 40}, pair, first, few);
            for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(few[k], all[first + k]) << first;
        }
    }
}

TEST(Samplers, SobolsSecondDimensionIsPascalsTriangle) {
    // Digit j of number i is the sum of the binomials (k over j) of the bits k of i, modulo two;
    // the digits of the scrambled point are those, by nested_scramble.
    std::uint64_t column = std::uint64_t{1} << 63;
    for (int bit = 0; bit < 64; ++bit) {
        const std::uint64_t number = std::uint64_t{1} << bit;
        Vec2 point;
        scrambled_points_one_by_one({3, 4}, {&number, 1}, &point);
        EXPECT_EQ(point.y, nested_scramble<kSobolScrambledDigits>(4, column)) << bit;
        EXPECT_EQ(point.x,
                  nested_scramble<kSobolScrambledDigits>(3, std::uint64_t{1} << (63 - bit)));
        column ^= column >> 1;
    }
}

TEST(Samplers, NestedScramblesFlipEachDigitByTheDigitsAbove) {
    // Six digits: the flip of a digit is the bit of its node in a tree whose root is 1.
    for (std::uint64_t tree = 0; tree < 50; ++tree) {
        const std::uint64_t flips = mix64(tree ^ std::uint64_t{1} << 32);
        for (std::uint32_t six = 0; six < 64; ++six) {
            std::uint32_t expected = 0, node = 1;
            for (int bit = 5; bit >= 0; --bit) {
                const std::uint32_t digit = six >> bit & 1u;
                expected = expected << 1 | (digit ^ static_cast<std::uint32_t>(flips >> node & 1u));
                node = 2 * node + digit;
            }
            const double scrambled = nested_scramble<6>(tree, std::uint64_t{six} << 58);
            EXPECT_EQ(static_cast<std::uint32_t>(scrambled * 64.0), expected);
        }
    }
}

TEST(Samplers, DifferFromSeedToSeedAndPixelToPixelAndPairToPair) {
    for (const SamplerEntry& entry : samplers()) {
        if (std::string(entry.name) == "regular") continue;
        const auto one = entry.make(1, 16), two = entry.make(2, 16);
        EXPECT_NE(one->at({3, 4}, 0, 5), two->at({3, 4}, 0, 5)) << entry.name;
        EXPECT_NE(one->at({3, 4}, 0, 5), one->at({4, 3}, 0, 5)) << entry.name;
        EXPECT_NE(one->at({3, 4}, 0, 5), one->at({3, 4}, 1, 5)) << entry.name;
        EXPECT_NE(one->at({3, 4}, 20, 5), one->at({3, 4}, 21, 5)) << entry.name;
    }
}

TEST(Samplers, ASampleIsUniformAndThePairsOfASampleAreIndependent) {
    constexpr int kPixels = 6400;
    for (const SamplerEntry& entry : samplers()) {
        if (std::string(entry.name) == "regular") continue;
        const auto sampler = entry.make(9, 16);
        std::vector<int> cells(64);
        double product = 0;
        for (int k = 0; k < kPixels; ++k) {
            const SamplePixel pixel{k % 80, k / 80};
            // One sample alone is uniform only where its place in the set is: pair 1 is shuffled.
            const Vec2 p = sampler->at(pixel, 1, 5), q = sampler->at(pixel, 2, 5);
            ++cells[static_cast<std::size_t>(p.x * 8) * 8 + static_cast<std::size_t>(p.y * 8)];
            product += (p.x - 0.5) * (q.y - 0.5);
        }
        double chi_squared = 0;
        for (const int n : cells) chi_squared += (n - 100.0) * (n - 100.0) / 100.0;
        // 63 degrees of freedom: probability 1 in 10^5 above 118; stratified over pixels: less.
        EXPECT_LT(chi_squared, 118) << entry.name;
        EXPECT_LT(std::abs(product / kPixels), 4.5 / 12 / std::sqrt(double{kPixels})) << entry.name;
    }
}

TEST(Samplers, GridsHaveOnePointInEachCell) {
    for (int x = 0; x < 20; ++x) {
        const SamplePixel pixel{x, 3};
        for (const std::uint32_t pair : {0u, 3u}) {
            for (const char* name : {"regular", "jittered", "multi_jittered", "sobol"}) {
                EXPECT_TRUE(fills_grid(points_of(*made(name, 64), pixel, 64, pair), 8, 8)) << name;
            }
            for (const char* name : {"n_rooks", "multi_jittered", "sobol"}) {
                const auto points = points_of(*made(name, 64), pixel, 64, pair);
                EXPECT_TRUE(fills_grid(points, 64, 1)) << name;
                EXPECT_TRUE(fills_grid(points, 1, 64)) << name;
            }
            // Hammersley's first coordinate before the shift.
            const auto points = points_of(*made("hammersley", 50), pixel, 50, pair);
            EXPECT_TRUE(fills_grid(points, 50, 1));
        }
    }
}

TEST(Samplers, CellsOfEveryCountHaveEqualAreas) {
    for (std::uint32_t count = 1; count <= 40; ++count) {
        // The mean of many pixels' points falls everywhere alike only if cells have equal areas.
        const auto sampler = made("jittered", count);
        double x = 0, y = 0, xx = 0;
        constexpr int kPixels = 4000;
        for (int k = 0; k < kPixels; ++k) {
            for (const Vec2& p : points_of(*sampler, {k, 0}, count)) {
                x += p.x;
                y += p.y;
                xx += p.x * p.x;
            }
        }
        const double n = double{kPixels} * count, limit = 4.5 * 0.29 / std::sqrt(n);
        EXPECT_NEAR(x / n, 0.5, limit) << count;
        EXPECT_NEAR(y / n, 0.5, limit) << count;
        EXPECT_NEAR(xx / n, 1.0 / 3, 1.1 * limit) << count;
    }
}

TEST(Samplers, EachBeginningOfSobolsSamplesIsANet) {
    const auto sampler = made("sobol", 256);
    for (int k = 0; k < 12; ++k) {
        for (const std::uint32_t pair : {0u, 2u}) {
            for (std::uint32_t digits = 0; digits <= 8; ++digits) {
                const auto points = points_of(*sampler, {k, 7 * k}, 1u << digits, pair);
                for (std::uint32_t wide = 0; wide <= digits; ++wide) {
                    EXPECT_TRUE(fills_grid(points, 1u << wide, 1u << (digits - wide)))
                        << "pixel " << k << " digits " << digits << " of x " << wide;
                }
            }
        }
    }
}

TEST(Samplers, SobolsSamplesOfNeighboursComplementEachOther) {
    // Of 16 pixels in an aligned block, too, all samples are a net.
    const auto sampler = made("sobol", 4);
    std::vector<Vec2> all;
    for (int k = 0; k < 16; ++k) {
        for (const Vec2& p : points_of(*sampler, {20 + k % 4, 8 + k / 4}, 4)) all.push_back(p);
    }
    EXPECT_TRUE(fills_grid(all, 8, 8));
    EXPECT_TRUE(fills_grid(all, 64, 1));
    EXPECT_TRUE(fills_grid(all, 1, 64));
}

TEST(Samplers, BeginningsOfHaltonsSamplesFillTheIntervalsOfItsBases) {
    const auto sampler = made("halton", 1000);
    for (int k = 0; k < 10; ++k) {
        EXPECT_TRUE(fills_grid(points_of(*sampler, {k, 1}, 128), 128, 1));
        EXPECT_TRUE(fills_grid(points_of(*sampler, {k, 1}, 243), 1, 243));
        EXPECT_TRUE(fills_grid(points_of(*sampler, {k, 1}, 72), 8, 9));
        EXPECT_TRUE(fills_grid(points_of(*sampler, {k, 1}, 125, 1), 125, 1));
    }
}

TEST(Samplers, PoissonDiscsKeepTheirRadius) {
    for (const std::uint32_t count : {1u, 2u, 13u, 64u, 400u}) {
        const DiscSet set = poisson_disc_set(77, count);
        ASSERT_EQ(set.points.size(), count);
        EXPECT_GE(smallest_distance(set.points), set.radius);
        // At least 0.7 of the radius of the densest packing (Lagae and Dutre 2008: 0.65 to 0.85).
        if (count >= 13) {
            EXPECT_GT(set.radius, 0.65 * std::sqrt(2 / (std::sqrt(3.0) * count)));
        }
        for (int k = 0; k < 5; ++k) {
            const auto points = points_of(*made("poisson_disc", count), {k, k}, count);
            if (count >= 13) {
                EXPECT_GT(smallest_distance(points),
                          0.64 * std::sqrt(2 / (std::sqrt(3.0) * count)));
            }
        }
    }
}

TEST(Samplers, EachBeginningOfBlueNoiseKeepsItsDistance) {
    const auto sampler = made("blue_noise", 256);
    for (const std::uint32_t count : {8u, 32u, 100u, 256u}) {
        const double densest = std::sqrt(2 / (std::sqrt(3.0) * count));
        for (int k = 0; k < 8; ++k) {
            EXPECT_GT(smallest_distance(points_of(*sampler, {k, 0}, count)), 0.5 * densest)
                << count;
        }
    }
}

/// Mean power at radii below `low` of the root of the number of points.
double low_power(const std::string& name, std::uint32_t count, double low) {
    Periodogram periodogram(static_cast<int>(std::sqrt(count) * 2));
    const auto sampler = made(name, count);
    for (int k = 0; k < 24; ++k) periodogram.add(points_of(*sampler, {k, 5}, count));
    const std::vector<double> mean = periodogram.radial_mean(count, 8);
    double sum = 0;
    const auto bins = static_cast<std::size_t>(8 * low);
    for (std::size_t k = 0; k < bins; ++k) sum += mean[k];
    return sum / static_cast<double>(bins);
}

TEST(Samplers, SpectraOfBlueNoiseAndPoissonDiscsAreEmptyAtLowFrequencies) {
    EXPECT_NEAR(low_power("independent", 256, 0.5), 1.0, 0.15);
    EXPECT_LT(low_power("poisson_disc", 256, 0.5), 0.12);
    EXPECT_LT(low_power("blue_noise", 256, 0.5), 0.12);
    // n-rooks are dark along the axes only.
    EXPECT_GT(low_power("n_rooks", 256, 0.5), 0.5);
}

TEST(Samplers, DiscrepanciesOfPointsAreInTheOrderOfTheLiterature) {
    const auto mean = [](const std::string& name) {
        double sum = 0;
        for (int k = 0; k < 20; ++k)
            sum += star_discrepancy(points_of(*made(name, 256), {k, k}, 256));
        return sum / 20;
    };
    const double independent = mean("independent"), jittered = mean("jittered");
    const double multi = mean("multi_jittered"), sobol = mean("sobol"), halton = mean("halton");
    EXPECT_LT(jittered, 0.75 * independent);
    EXPECT_LT(multi, 0.7 * jittered);
    EXPECT_LT(sobol, 0.6 * jittered);
    EXPECT_LT(halton, 0.7 * jittered);
    EXPECT_LT(mean("hammersley"), 0.7 * jittered);
    // Every corner of the box through a point, by definition, on three points.
    const std::vector<Vec2> three{{0.5, 0.5}, {0.25, 0.75}, {0.75, 0.25}};
    double largest = 0;
    for (const double x : {0.25, 0.5, 0.75, 1.0}) {
        for (const double y : {0.25, 0.5, 0.75, 1.0}) {
            double open = 0, closed = 0;
            for (const Vec2& p : three) {
                open += p.x < x && p.y < y;
                closed += p.x <= x && p.y <= y;
            }
            largest = std::max({largest, closed / 3 - x * y, x * y - open / 3});
        }
    }
    EXPECT_DOUBLE_EQ(star_discrepancy(three), largest);
}

/// Variance over pixels of the mean of `f` over a set of `count` samples.
template <class F>
double variance_of_mean(const std::string& name, std::uint32_t count, const F& f) {
    constexpr int kPixels = 600;
    const auto sampler = made(name, count, 4);
    double sum = 0, squares = 0;
    for (int k = 0; k < kPixels; ++k) {
        double mean = 0;
        // Pixels far from each other, for those nearby share their nets.
        for (const Vec2& p : points_of(*sampler, {97 * k % 40000, 53 * k % 30011}, count))
            mean += f(p);
        mean /= count;
        sum += mean;
        squares += mean * mean;
    }
    return (squares - sum * sum / kPixels) / (kPixels - 1);
}

/// Slope of log(variance) over log(count), from 16 to 1024 samples.
template <class F>
double slope(const std::string& name, const F& f) {
    return std::log(variance_of_mean(name, 1024, f) / variance_of_mean(name, 16, f)) /
           std::log(1024.0 / 16.0);
}
/// The same for the mean variance at edges of several directions.
double slope_at_edges(const std::string& name) {
    double few = 0, many = 0;
    for (int k = 0; k < 8; ++k) {
        const double angle = 0.2 + 0.71 * k, nx = std::cos(angle), ny = std::sin(angle);
        const auto edge = [&](const Vec2& p) {
            return nx * (p.x - 0.47) + ny * (p.y - 0.53) < 0.05 ? 1.0 : 0.0;
        };
        few += variance_of_mean(name, 16, edge);
        many += variance_of_mean(name, 1024, edge);
    }
    return std::log(many / few) / std::log(1024.0 / 16.0);
}

TEST(Samplers, TheVarianceFallsWithTheSlopeOfTheory) {
    const auto smooth = [](const Vec2& p) {
        return std::sin(std::numbers::pi * p.x) * (0.3 + p.y * p.y);
    };
    // Cook 1986, Mitchell 1996, Owen 1997: N^-1; stratified N^-1.5 at edges, N^-2 where smooth;
    // scrambled nets N^-3 (with a logarithm) where smooth.
    EXPECT_NEAR(slope("independent", smooth), -1.0, 0.12);
    EXPECT_NEAR(slope_at_edges("independent"), -1.0, 0.12);
    EXPECT_NEAR(slope("jittered", smooth), -2.0, 0.15);
    EXPECT_NEAR(slope_at_edges("jittered"), -1.5, 0.15);
    EXPECT_NEAR(slope_at_edges("multi_jittered"), -1.5, 0.15);
    EXPECT_NEAR(slope_at_edges("n_rooks"), -1.0, 0.15);
    EXPECT_NEAR(slope_at_edges("sobol"), -1.5, 0.2);
    EXPECT_LT(slope("sobol", smooth), -2.6);
}

/// A thread remembers where on the curve it was; a new one does not.
TEST(Samplers, SobolPointsOfAPixelDependOnNoOtherPixel) {
    const auto sampler = made("sobol", 4);
    std::uint64_t state = 9;
    for (int i = 0; i < 300; ++i) {
        state = mix64(state);
        // Some beside the last one, others far away.
        const int reach = i % 3 == 0 ? 4 : i % 3 == 1 ? 4096 : SamplePixel::kMaxSide;
        const SamplePixel pixel{static_cast<int>(state % reach),
                                static_cast<int>((state >> 32) % reach)};
        // Two pairs take the same place in a table of 256.
        const std::uint32_t pair = i % 4 == 0   ? 3
                                   : i % 4 == 1 ? 259
                                                : static_cast<std::uint32_t>(state >> 60);
        std::vector<Vec2> alone;
        std::thread([&] { alone = points_of(*sampler, pixel, 4, pair); }).join();
        EXPECT_EQ(points_of(*sampler, pixel, 4, pair), alone) << i;
    }
}

TEST(Samplers, SobolNeedsHalfTheSamplesOfIndependentOnes) {
    const auto edge = [](const Vec2& p) { return p.y < 0.3 + 0.37 * p.x ? 1.0 : 0.0; };
    // A rectangular light, half of it behind an edge: the cosine and the distance vary.
    const auto light = [](const Vec2& p) {
        const double x = 2 * p.x - 1, y = 2 * p.y - 1, squared = x * x + y * y + 2.25;
        return x + 0.4 * y < 0.2 ? 2.25 / (squared * squared) : 0.0;
    };
    EXPECT_LT(variance_of_mean("sobol", 32, edge), variance_of_mean("independent", 64, edge));
    EXPECT_LT(variance_of_mean("sobol", 32, light), variance_of_mean("independent", 64, light));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
