#include "alhazen/sampling/samplers/sobol_sampler.h"

#include <algorithm>
#include <array>
#include <bit>

#include "alhazen/sampling/nested_scramble.h"

namespace alhazen {

namespace {

/// Two samples of a pixel, or of neighbours, share no more digits.
constexpr int kScrambledDigits = 24;

/// Columns of the second dimension's matrix: the digits of the powers of two.
constexpr std::array<std::uint64_t, 64> kSecond = [] {
    std::array<std::uint64_t, 64> v{};
    v[0] = std::uint64_t{1} << 63;
    for (std::size_t i = 1; i < v.size(); ++i) v[i] = v[i - 1] ^ (v[i - 1] >> 1);
    return v;
}();

std::uint64_t second_digits(std::uint64_t index) {
    std::uint64_t x = 0;
    for (; index != 0; index &= index - 1) {
        x ^= kSecond[static_cast<std::size_t>(std::countr_zero(index))];
    }
    return x;
}

std::uint64_t reversed_bits(std::uint64_t x) {
    x = (x >> 32) | (x << 32);
    x = ((x >> 16) & 0x0000FFFF0000FFFFu) | ((x & 0x0000FFFF0000FFFFu) << 16);
    x = ((x >> 8) & 0x00FF00FF00FF00FFu) | ((x & 0x00FF00FF00FF00FFu) << 8);
    x = ((x >> 4) & 0x0F0F0F0F0F0F0F0Fu) | ((x & 0x0F0F0F0F0F0F0F0Fu) << 4);
    x = ((x >> 2) & 0x3333333333333333u) | ((x & 0x3333333333333333u) << 2);
    return ((x >> 1) & 0x5555555555555555u) | ((x & 0x5555555555555555u) << 1);
}

/// The bit of each of the four quadrants goes where the permutation says: all 24, two bits each.
constexpr std::array<std::uint8_t, 24> kOrders = [] {
    std::array<std::uint8_t, 24> orders{};
    std::size_t n = 0;
    for (unsigned a = 0; a < 4; ++a) {
        for (unsigned b = 0; b < 4; ++b) {
            for (unsigned c = 0; c < 4; ++c) {
                if (a == b || a == c || b == c) continue;
                const unsigned d = 6 - a - b - c;
                orders[n++] = static_cast<std::uint8_t>(a | b << 2 | c << 4 | d << 6);
            }
        }
    }
    return orders;
}();

/// Bits [least, bits) of the number of a sample, flipped by hashes of the bits above: each first
/// 2^k numbers stay an aligned block.
std::uint32_t shuffled_number(std::uint32_t s, int bits, int least, std::uint64_t key) {
    std::uint32_t out = 0;
    for (int bit = bits - 1; bit >= least; --bit) {
        const std::uint64_t above = std::uint64_t{s >> bit >> 1} | std::uint64_t(bit + 1) << 32;
        out |= (((s >> bit) & 1u) ^ static_cast<std::uint32_t>(mix64(key ^ above) >> 63)) << bit;
    }
    return out;
}

}  // namespace

SobolSampler::SobolSampler(std::uint64_t seed, std::uint32_t count)
    : key_(mix64(seed)), sample_bits_(std::bit_width(count - 1)) {}

std::uint32_t SobolSampler::curve_place(const SamplePixel& pixel, std::uint64_t key) {
    const auto x = static_cast<std::uint32_t>(pixel.x), y = static_cast<std::uint32_t>(pixel.y);
    std::uint32_t place = 0;
    std::uint64_t above = 1;  // the quadrants so far, behind a one that tells their number
    for (int bit = 15; bit >= 0; --bit) {
        const unsigned quadrant = ((x >> bit) & 1u) | ((y >> bit) & 1u) << 1;
        const std::uint64_t order = (mix64(key ^ above) >> 32) % kOrders.size();
        place = place << 2 | ((unsigned{kOrders[order]} >> (2 * quadrant)) & 3u);
        above = above << 2 | quadrant;
    }
    return place;
}

void SobolSampler::points(const SamplePixel& pixel, std::uint32_t pair, std::uint32_t first,
                          std::span<Vec2> out) const {
    const std::uint64_t key = mix64(key_ ^ pair);
    const std::uint64_t trees[] = {mix64(key + 1), mix64(key + 2)};
    const std::uint64_t place = std::uint64_t{curve_place(pixel, key)} << sample_bits_;
    const std::uint64_t order = mix64(key ^ mix64(pixel.id()));
    const std::uint64_t second = second_digits(place);
    // Bits that are zero in all of these numbers are flipped alike.
    const auto end = static_cast<std::uint32_t>(first + out.size());
    const int low = std::min(sample_bits_, static_cast<int>(std::bit_width(end - 1)));
    const std::uint32_t high = pair > 0 ? shuffled_number(0, sample_bits_, low, order) : 0;
    for (std::uint32_t k = 0; k < out.size(); ++k) {
        std::uint32_t s = first + k;
        if (pair > 0) s = high | shuffled_number(s, low, 0, order);
        out[k] = {nested_scramble<kScrambledDigits>(trees[0], reversed_bits(place | s)),
                  nested_scramble<kScrambledDigits>(trees[1], second ^ second_digits(s))};
    }
}

}  // namespace alhazen
