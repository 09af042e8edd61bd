#include "alhazen/sampling/samplers/low_discrepancy_samplers.h"

#include <algorithm>
#include <array>

namespace alhazen {

namespace {

constexpr std::array<std::uint32_t, 2 * HaltonSampler::kPairs> kPrimes{
    2,  3,  5,  7,  11, 13, 17, 19, 23, 29,  31,  37,  41,  43,  47,  53,
    59, 61, 67, 71, 73, 79, 83, 89, 97, 101, 103, 107, 109, 113, 127, 131};
constexpr double kBelowOne = 1.0 - 0x1p-53;

double radical_inverse_2(std::uint32_t i) {
    std::uint32_t reversed = 0;
    for (int bit = 0; bit < 32; ++bit) reversed |= ((i >> bit) & 1u) << (31 - bit);
    return reversed * 0x1p-32;
}

/// x + y modulo 1, for x and y in [0, 1).
double shifted(double x, double y) {
    const double sum = x + y;
    return sum < 1.0 ? sum : sum - 1.0;
}

/// The radical inverse of `i` with scrambled digits, as many as `count` - 1 has.
double scrambled_inverse(std::uint64_t key, std::uint32_t base, std::uint32_t i,
                         std::uint32_t count) {
    std::uint64_t above = 1;  // the digits so far, behind a 1 that encodes their number
    double value = 0.0, place = 1.0;
    for (std::uint32_t rest = count - 1; rest > 0; rest /= base) {
        const std::uint32_t digit = i % base;
        i /= base;
        const std::uint64_t h = mix64(key ^ above);
        const std::uint64_t factor = 1 + (h >> 32) % (base - 1);
        const std::uint64_t offset = (h & 0xFFFFFFFFu) % base;
        place /= base;
        value += static_cast<double>((factor * digit + offset) % base) * place;
        above = above * base + digit;
    }
    return std::min(value + place * unit_double(mix64(key ^ above ^ (std::uint64_t{1} << 63))),
                    kBelowOne);
}

}  // namespace

Vec2 HammersleySampler::point(std::uint64_t key, std::uint32_t i) const {
    const Vec2 shift = uniform_pair(key, 0);
    return {shifted(static_cast<double>(i) / count(), shift.x),
            shifted(radical_inverse_2(i), shift.y)};
}

void HaltonSampler::points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                           std::span<Vec2> out) const {
    if (pair >= kPairs) return IndependentSampler(seed_, 1).points(pixel, pair, first, out);
    const std::uint64_t key = mix64(mix64(mix64(seed_) ^ pixel.id()) ^ pair);
    for (std::uint32_t k = 0; k < out.size(); ++k) {
        out[k] = {scrambled_inverse(key, kPrimes[2 * pair], first + k, count_),
                  scrambled_inverse(mix64(key), kPrimes[2 * pair + 1], first + k, count_)};
    }
}

void IndependentSampler::points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                                std::span<Vec2> out) const {
    for (std::uint32_t k = 0; k < out.size(); ++k) {
        out[k] = {random_at(seed_, pixel.id(), first + k, 2 * std::uint64_t{pair}),
                  random_at(seed_, pixel.id(), first + k, 2 * std::uint64_t{pair} + 1)};
    }
}

}  // namespace alhazen
