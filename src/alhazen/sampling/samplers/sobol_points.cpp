#include "alhazen/sampling/samplers/sobol_points.h"

#include <algorithm>
#include <cstring>

#include "alhazen/sampling/nested_scramble.h"

// Clang refuses to pass AVX vectors to functions that are compiled without AVX, inlined or not.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ALHAZEN_SOBOL_LANES 1
#else
#define ALHAZEN_SOBOL_LANES 0
#endif

namespace alhazen {

namespace {

// For one word or for lanes of words. Inlined into functions of any instruction set.
#if ALHAZEN_SOBOL_LANES
#define ALHAZEN_SOBOL_INLINE [[gnu::always_inline]] inline
#else
#define ALHAZEN_SOBOL_INLINE inline
#endif

/// The word with its bits in reverse order: the digits of the first dimension.
template <class Word>
ALHAZEN_SOBOL_INLINE Word with_reversed_bits(Word x) {
    x = (x >> 32) | (x << 32);
    x = ((x >> 16) & 0x0000FFFF0000FFFFu) | ((x & 0x0000FFFF0000FFFFu) << 16);
    x = ((x >> 8) & 0x00FF00FF00FF00FFu) | ((x & 0x00FF00FF00FF00FFu) << 8);
    x = ((x >> 4) & 0x0F0F0F0F0F0F0F0Fu) | ((x & 0x0F0F0F0F0F0F0F0Fu) << 4);
    x = ((x >> 2) & 0x3333333333333333u) | ((x & 0x3333333333333333u) << 2);
    return ((x >> 1) & 0x5555555555555555u) | ((x & 0x5555555555555555u) << 1);
}

/// The digits of the second dimension in reverse order. Its matrix is Pascal's triangle modulo two:
/// digit j is the sum of the bits i of the number for which i contains all bits of j (Lucas'
/// theorem).
template <class Word>
ALHAZEN_SOBOL_INLINE Word with_sums_of_bits_above(Word x) {
    x ^= (x >> 1) & 0x5555555555555555u;
    x ^= (x >> 2) & 0x3333333333333333u;
    x ^= (x >> 4) & 0x0F0F0F0F0F0F0F0Fu;
    x ^= (x >> 8) & 0x00FF00FF00FF00FFu;
    x ^= (x >> 16) & 0x0000FFFF0000FFFFu;
    return x ^ (x >> 32);
}

}  // namespace

void scrambled_points_one_by_one(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                                 Vec2* out) {
    for (const std::uint64_t number : numbers) {
        const std::uint64_t y = with_reversed_bits(with_sums_of_bits_above(number));
        *out++ = {nested_scramble<kSobolScrambledDigits>(trees.x, with_reversed_bits(number)),
                  nested_scramble<kSobolScrambledDigits>(trees.y, y)};
    }
}

#if ALHAZEN_SOBOL_LANES

namespace {

using FourWords = std::uint64_t __attribute__((vector_size(32)));
using EightWords = std::uint64_t __attribute__((vector_size(64)));
using EightIntegers = std::int64_t __attribute__((vector_size(64)));
using EightNumbers = double __attribute__((vector_size(64)));

/// `mix64` of each lane.
template <class Words>
ALHAZEN_SOBOL_INLINE Words mixed(Words x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// The first 53 digits of `nested_scramble` of each lane.
template <class Words>
ALHAZEN_SOBOL_INLINE Words scrambled_digits(std::uint64_t tree, Words digits) {
    using namespace nested_scramble_detail;
    constexpr int kTree = kSobolScrambledDigits;
    Words scrambled = {};
#pragma GCC unroll 5
    for (int done = 0; done < kTree; done += kLevels) {
        const Words above = done == 0 ? Words{} : digits >> (64 - done);
        const Words flips = mixed(tree ^ (above | std::uint64_t(done + 1) << 32));
        const Words six = (digits >> (64 - kLevels - done)) & 63u;
        // The node of a level is the first digits behind a 1.
        const Words way = six | 64u;
        Words flipped = six;
#pragma GCC unroll 6
        for (int level = 0; level < kLevels; ++level) {
            flipped ^= ((flips >> (way >> (level + 1))) & 1u) << level;
        }
        scrambled = scrambled << kLevels | flipped;
    }
    const Words rest = mixed(tree ^ (digits >> (64 - kTree) | std::uint64_t{63} << 32));
    return scrambled << (53 - kTree) | rest >> (64 - (53 - kTree));
}

template <class Words>
ALHAZEN_SOBOL_INLINE Words loaded(const std::uint64_t* from) {
    Words words;
    std::memcpy(&words, from, sizeof(Words));
    return words;
}

/// Writes words below 2^53, times 2^-53. Signed integers are converted faster.
ALHAZEN_SOBOL_INLINE void write_units(FourWords words, double* out) {
    for (int k = 0; k < 4; ++k) {
        out[k] = static_cast<double>(static_cast<std::int64_t>(words[k])) * 0x1p-53;
    }
}
ALHAZEN_SOBOL_INLINE void write_units(EightWords words, double* out) {
    const EightNumbers numbers =
        __builtin_convertvector(reinterpret_cast<EightIntegers>(words), EightNumbers) * 0x1p-53;
    std::memcpy(out, &numbers, sizeof(numbers));
}

template <class Words>
ALHAZEN_SOBOL_INLINE void scrambled_points_in_lanes(const ScrambleTrees& trees,
                                                    std::span<const std::uint64_t> numbers,
                                                    Vec2* out) {
    constexpr std::size_t kLanes = sizeof(Words) / sizeof(std::uint64_t);
    alignas(64) double x_lanes[kLanes], y_lanes[kLanes];
    for (std::size_t i = 0; i < numbers.size(); i += kLanes) {
        const std::size_t count = std::min(kLanes, numbers.size() - i);
        Words number = {};
        if (count == kLanes) {
            number = loaded<Words>(&numbers[i]);
        } else {
            for (std::size_t k = 0; k < count; ++k) number[k] = numbers[i + k];
        }
        write_units(scrambled_digits(trees.x, with_reversed_bits(number)), x_lanes);
        write_units(scrambled_digits(trees.y, with_reversed_bits(with_sums_of_bits_above(number))),
                    y_lanes);
        for (std::size_t k = 0; k < count; ++k) out[i + k] = {x_lanes[k], y_lanes[k]};
    }
}

__attribute__((target("avx2"))) void scrambled_points_avx2(const ScrambleTrees& trees,
                                                           std::span<const std::uint64_t> numbers,
                                                           Vec2* out) {
    scrambled_points_in_lanes<FourWords>(trees, numbers, out);
}

/// AVX-512DQ has products of 64-bit words, which AVX2 composes of shorter ones. Registers of 512
/// bits take half the time of those of 256 (6.2 and 14 ns a point on Zen 5); processors that lower
/// their clock for them were not measured.
__attribute__((target("avx512f,avx512dq,prefer-vector-width=512"))) void scrambled_points_avx512(
    const ScrambleTrees& trees, std::span<const std::uint64_t> numbers, Vec2* out) {
    scrambled_points_in_lanes<EightWords>(trees, numbers, out);
}

__attribute__((target("avx512f,avx512dq,prefer-vector-width=512"))) void shuffled_indices_avx512(
    const PixelSamples& samples, std::size_t count, int bits, std::uint64_t* out) {
    constexpr std::size_t kLanes = sizeof(EightWords) / sizeof(std::uint64_t);
    for (std::size_t i = 0; i < count; i += kLanes) {
        const EightWords key = loaded<EightWords>(&samples.key[i]);
        const EightWords number = loaded<EightWords>(&samples.number[i]);
        EightWords flips = {};
        for (int bit = 0; bit < bits; ++bit) {
            // As `flip_of_sample`.
            const EightWords above = number >> bit >> 1 | std::uint64_t(bit + 1) << 32;
            flips |= mixed(key ^ above) >> 63 << bit;
        }
        const EightWords indices = loaded<EightWords>(&samples.first[i]) + (number ^ flips);
        std::memcpy(out + i, &indices, sizeof(indices));
    }
}

[[nodiscard]] bool has_products_of_words() {
    return __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
}

}  // namespace

std::vector<ScrambledPoints> variants_of_scrambled_points() {
    std::vector<ScrambledPoints> variants{scrambled_points_one_by_one};
    if (__builtin_cpu_supports("avx2")) variants.push_back(scrambled_points_avx2);
    if (has_products_of_words()) variants.push_back(scrambled_points_avx512);
    return variants;
}

ShuffledIndices shuffled_indices_in_lanes() {
    static const ShuffledIndices found =
        has_products_of_words() ? shuffled_indices_avx512 : nullptr;
    return found;
}

#else

std::vector<ScrambledPoints> variants_of_scrambled_points() {
    return {scrambled_points_one_by_one};
}

ShuffledIndices shuffled_indices_in_lanes() {
    return nullptr;
}

#endif

void scrambled_points(const ScrambleTrees& trees, std::span<const std::uint64_t> numbers,
                      Vec2* out) {
    static const ScrambledPoints fastest = variants_of_scrambled_points().back();
    fastest(trees, numbers, out);
}

}  // namespace alhazen
