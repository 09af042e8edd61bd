#pragma once
/// Whether renderers show the same light: differences of means of independent pictures against
/// their standard errors.
///
/// Source: Welch, "The Generalization of Student's Problem when Several Different Population
/// Variances are Involved", Biometrika 34, 1947 (degrees of freedom: Satterthwaite, as in
/// sampling/confidence.h). Independent, unequally weighted means: each counts by the inverse of its
/// variance.
/// Differs: a renderer's weight is one for all blocks, so that blocks which missed what is bright
/// and rare count no more than others.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "alhazen/sampling/confidence.h"
#include "support/light_pictures.h"

namespace alhazen::testing {

/// Of one block: a comparison fails by chance in so many cases. As a t of 22 degrees of freedom
/// beyond 5.7.
inline constexpr double kByChance = 1e-5;

/// What a renderer shows.
struct Shown {
    std::string renderer;
    Blocks blocks;
    double bias = 0.0;  ///< allowed, of the picture
};

/// The mean of a block over some renderers.
struct GroupMean {
    double mean = 0.0, bias = 0.0;
    std::vector<Spread> spreads;  ///< of its parts
    std::string names;
};

/// `weights`: of all renderers; `group`: bits of those that count.
inline GroupMean group_mean(const std::vector<Shown>& shown, const std::vector<double>& weights,
                            unsigned group, std::size_t block) {
    double sum = 0.0;
    for (std::size_t r = 0; r < shown.size(); ++r) {
        if ((group >> r & 1u) != 0) sum += weights[r];
    }
    GroupMean of;
    for (std::size_t r = 0; r < shown.size(); ++r) {
        if ((group >> r & 1u) == 0) continue;
        const double share = weights[r] / sum;
        const Blocks& b = shown[r].blocks;
        of.mean += share * b.mean[block];
        of.bias += share * shown[r].bias;
        of.spreads.push_back({share * b.error[block], double(b.runs - 1)});
        of.names += (of.names.empty() ? "" : ", ") + shown[r].renderer;
    }
    return of;
}

/// Fails where two groups of renderers differ, in whatever way all are divided in two: so whether
/// one is wrong, or some have a fault in common, it is compared with all that may be right. A
/// difference of `finds` of the block, or of the picture where that is brighter, would be found
/// (0: of any size).
inline void expect_same_light(const std::vector<Shown>& shown, const std::string& name,
                              double chance, double finds) {
    const double whole = shown[0].blocks.whole();
    std::vector<double> weights;
    for (const Shown& s : shown) {
        double variance = 1e-24 + 1e-18 * whole * whole;
        for (const double e : s.blocks.error) variance += e * e;
        weights.push_back(1.0 / variance);
    }
    const unsigned all = (1u << shown.size()) - 1u;
    // The last renderer is always in the second group.
    for (unsigned first = 1; first <= all / 2; ++first) {
        for (std::size_t i = 0; i < shown[0].blocks.mean.size(); ++i) {
            const GroupMean a = group_mean(shown, weights, first, i),
                            b = group_mean(shown, weights, all & ~first, i);
            std::vector<Spread> spreads = a.spreads;
            spreads.insert(spreads.end(), b.spreads.begin(), b.spreads.end());
            const Spread spread = sum_of(spreads);
            const double most =
                estimate_of(0.0, spread, 1.0 - chance).half_width + (a.bias + b.bias) * whole;
            EXPECT_LE(std::abs(a.mean - b.mean), most + 1e-12)
                << name << ", block " << i << ": " << a.names << ": " << a.mean << "; " << b.names
                << ": " << b.mean << " +- " << spread.deviation;
            if (finds > 0.0) {
                EXPECT_LE(most, finds * std::max(whole, shown[0].blocks.mean[i]))
                    << name << ", block " << i << ": " << a.names << "; " << b.names;
            }
        }
    }
}

/// The same of `runs` pictures of each renderer, of that many samples for a pixel.
inline void expect_same_light(const Scene& scene, const std::string& name,
                              const std::vector<std::string>& renderers, int samples,
                              double chance = kByChance, int runs = 12) {
    std::vector<Shown> shown;
    for (const std::string& r : renderers) {
        shown.push_back({r, blocks_of(scene, r, samples, runs)});
    }
    expect_same_light(shown, name, chance, 0.0);
}

/// How many pictures, how wide, and of how many samples for a pixel.
struct Pictures {
    int runs = 12, side = 4, samples = 16;
};

/// The mean of independent pictures against a closed form, channel by channel. A difference of
/// `finds` of it would be found; `bias` of it is allowed.
inline void expect_mean(const Scene& scene, const std::string& renderer, const Rgb& expected,
                        const Pictures& pictures, double chance, double finds, double bias = 1e-9) {
    const int runs = pictures.runs;
    std::vector<double> seen[3];
    for (int run = 0; run < runs; ++run) {
        const Rgb m = mean_of(
            picture_of(scene, renderer, pictures.side, pictures.samples, std::uint64_t(1 + run)));
        for (int i = 0; i < 3; ++i) seen[i].push_back(m[i]);
    }
    for (int i = 0; i < 3; ++i) {
        const Estimate mean = alhazen::mean_of(seen[i], 1.0 - chance);
        const double most = mean.half_width + bias * expected[i];
        EXPECT_LE(std::abs(mean.value - expected[i]), most)
            << renderer << " " << i << ": " << mean.value << ", expected " << expected[i];
        EXPECT_LE(most, finds * expected[i]) << renderer << " " << i;
    }
}

}  // namespace alhazen::testing
