#include "alhazen/sampling/samplers/sobol_points.h"

#include <algorithm>
#include <cstring>

#include "alhazen/sampling/nested_scramble.h"

// Clang refuses to pass AVX vectors to functions that are compiled without AVX, inlined or not.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ALHAZEN_SOBOL_LANES 1
#include <immintrin.h>
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
/// bits take half the time of those of 256 on Zen 5; processors that lower their clock for them
/// were not measured.
__attribute__((target("avx512f,avx512dq,prefer-vector-width=512"))) void scrambled_points_avx512(
    const ScrambleTrees& trees, std::span<const std::uint64_t> numbers, Vec2* out) {
    scrambled_points_in_lanes<EightWords>(trees, numbers, out);
}

// Also with products of matrices of bits (GFNI) and bytes that begin at any bit of a word
// (AVX-512VBMI): no loops over levels.
// GCC's intrinsics begin with a value that is undefined on purpose.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#define ALHAZEN_SOBOL_BYTES \
    __attribute__((target("avx512f,avx512dq,avx512bw,avx512vbmi,gfni,prefer-vector-width=512")))

/// Eight bytes, of(j) the byte j from below, in all words.
template <class F>
constexpr std::uint64_t bytes_of(const F& of) {
    std::uint64_t bytes = 0;
    for (unsigned j = 0; j < 8; ++j) bytes |= std::uint64_t{of(j) & 255u} << (8 * j);
    return bytes;
}

/// `scrambled_digits`, all six levels of a tree together: byte j of a word is for level j.
ALHAZEN_SOBOL_BYTES inline __m512i scrambled_digits_by_bytes(std::uint64_t tree, __m512i digits) {
    using namespace nested_scramble_detail;
    static_assert(kLevels == 6);
    constexpr int kTree = kSobolScrambledDigits;
    constexpr auto kEach = [](std::uint64_t word) { return static_cast<long long>(word); };
    // Of the node of level j, (six | 64) >> (j + 1), the digits and the 1 before them; j less, so
    // that its flip is bit j of a byte.
    constexpr auto kDigitsOfLevel = bytes_of([](unsigned j) { return j < 6 ? (32u >> j) - 1 : 0; });
    constexpr auto kBehindOne = bytes_of([](unsigned j) { return j < 6 ? (32u >> j) - j : 0; });
    constexpr auto kBitOfLevel = bytes_of([](unsigned j) { return j < 6 ? 1u << j : 0; });
    __m512i all_flips = _mm512_setzero_si512();
#pragma GCC unroll 5
    for (int done = 0; done < kTree; done += kLevels) {
        const EightWords above =
            done == 0 ? EightWords{} : reinterpret_cast<EightWords>(digits) >> (64 - done);
        const EightWords flips = mixed((tree ^ std::uint64_t(done + 1) << 32) ^ above);
        const std::uint64_t from = bytes_of([&](unsigned j) { return unsigned(59 - done) + j; });
        const __m512i six = _mm512_multishift_epi64_epi8(_mm512_set1_epi64(kEach(from)), digits);
        const __m512i nodes =
            _mm512_add_epi8(_mm512_and_si512(six, _mm512_set1_epi64(kEach(kDigitsOfLevel))),
                            _mm512_set1_epi64(kEach(kBehindOne)));
        const __m512i chosen =
            _mm512_and_si512(_mm512_multishift_epi64_epi8(nodes, reinterpret_cast<__m512i>(flips)),
                             _mm512_set1_epi64(kEach(kBitOfLevel)));
        // The sum of bytes that share no bits joins them.
        all_flips = _mm512_or_si512(_mm512_slli_epi64(all_flips, kLevels),
                                    _mm512_sad_epu8(chosen, _mm512_setzero_si512()));
    }
    const EightWords first = reinterpret_cast<EightWords>(digits) >> (64 - kTree);
    const EightWords rest = mixed((tree ^ std::uint64_t{63} << 32) ^ first);
    const EightWords scrambled = first ^ reinterpret_cast<EightWords>(all_flips);
    return reinterpret_cast<__m512i>(scrambled << (53 - kTree) | rest >> (64 - (53 - kTree)));
}

ALHAZEN_SOBOL_BYTES inline __m512d units_of(__m512i words) {
    return _mm512_mul_pd(_mm512_cvtepi64_pd(words), _mm512_set1_pd(0x1p-53));
}

ALHAZEN_SOBOL_BYTES void scrambled_points_by_bytes(const ScrambleTrees& trees,
                                                   std::span<const std::uint64_t> numbers,
                                                   Vec2* out) {
    static_assert(sizeof(Vec2) == 2 * sizeof(double));
    // Byte 7 - i of a matrix has the bits of a byte whose sum is bit i of the product.
    constexpr std::uint64_t kReversed = bytes_of([](unsigned j) { return 1u << j; });
    constexpr std::uint64_t kSumsReversed = bytes_of([](unsigned j) {
        unsigned containing = 0;
        for (unsigned i = 0; i < 8; ++i) containing |= (i & j) == j ? 1u << i : 0u;
        return containing;
    });
    const __m512i reversed = _mm512_set1_epi64(static_cast<long long>(kReversed));
    const __m512i sums_reversed = _mm512_set1_epi64(static_cast<long long>(kSumsReversed));
    const __m512i bytes_reversed =
        _mm512_broadcast_i32x4(_mm_set_epi64x(0x08090A0B0C0D0E0F, 0x0001020304050607));
    const __m512i low = _mm512_set_epi64(11, 3, 10, 2, 9, 1, 8, 0);
    const __m512i high = _mm512_set_epi64(15, 7, 14, 6, 13, 5, 12, 4);
    for (std::size_t i = 0; i < numbers.size(); i += 8) {
        const std::size_t count = std::min<std::size_t>(8, numbers.size() - i);
        const auto used = static_cast<__mmask8>((1u << count) - 1);
        const __m512i number = _mm512_maskz_loadu_epi64(used, &numbers[i]);
        // with_sums_of_bits_above: first the bytes, then the bits in them.
        EightWords sums = reinterpret_cast<EightWords>(number);
        sums ^= (sums >> 8) & 0x00FF00FF00FF00FFu;
        sums ^= (sums >> 16) & 0x0000FFFF0000FFFFu;
        sums ^= sums >> 32;
        const auto digits_of = [&](const __m512i& word, const __m512i& matrix) ALHAZEN_SOBOL_BYTES {
            return _mm512_gf2p8affine_epi64_epi8(_mm512_shuffle_epi8(word, bytes_reversed), matrix,
                                                 0);
        };
        const __m512d x = units_of(scrambled_digits_by_bytes(trees.x, digits_of(number, reversed)));
        const __m512d y = units_of(scrambled_digits_by_bytes(
            trees.y, digits_of(reinterpret_cast<__m512i>(sums), sums_reversed)));
        const auto used_numbers = (1u << 2 * count) - 1;
        auto* const to = reinterpret_cast<double*>(out + i);
        _mm512_mask_storeu_pd(to, static_cast<__mmask8>(used_numbers),
                              _mm512_permutex2var_pd(x, low, y));
        _mm512_mask_storeu_pd(to + 8, static_cast<__mmask8>(used_numbers >> 8),
                              _mm512_permutex2var_pd(x, high, y));
    }
}
#pragma GCC diagnostic pop

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
[[nodiscard]] bool has_products_of_bits() {
    return has_products_of_words() && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vbmi") && __builtin_cpu_supports("gfni");
}

}  // namespace

std::vector<ScrambledPoints> variants_of_scrambled_points() {
    std::vector<ScrambledPoints> variants{scrambled_points_one_by_one};
    if (__builtin_cpu_supports("avx2")) variants.push_back(scrambled_points_avx2);
    if (has_products_of_words()) variants.push_back(scrambled_points_avx512);
    if (has_products_of_bits()) variants.push_back(scrambled_points_by_bytes);
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
