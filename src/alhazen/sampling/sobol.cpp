#include "alhazen/sampling/sobol.h"

#include <array>

#include "alhazen/sampling/nested_scramble.h"
#include "alhazen/sampling/random.h"

namespace alhazen {

namespace {

constexpr int kDigits = 32;
/// Number of digits that are scrambled exactly: two points of the sequence may share as many.
constexpr int kTreeDigits = 30;

/// A primitive polynomial over GF(2) of a degree (its inner coefficients as bits) and the first
/// direction numbers, from Joe and Kuo's table new-joe-kuo-6.
struct Direction {
    int degree;
    std::uint32_t inner;
    std::array<std::uint32_t, 6> m;
};
constexpr std::array<Direction, kSobolDimensions - 1> kTable{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
}};

using Matrix = std::array<std::uint32_t, kDigits>;  // [digit of the index] is its column

constexpr Matrix columns_of(const Direction& d) {
    Matrix v{};
    for (int i = 0; i < kDigits; ++i) {
        if (i < d.degree) {
            v[static_cast<std::size_t>(i)] = d.m[static_cast<std::size_t>(i)] << (kDigits - 1 - i);
            continue;
        }
        std::uint32_t x = v[static_cast<std::size_t>(i - d.degree)];
        x ^= x >> d.degree;
        for (int k = 1; k < d.degree; ++k) {
            if ((d.inner >> (d.degree - 1 - k)) & 1u) x ^= v[static_cast<std::size_t>(i - k)];
        }
        v[static_cast<std::size_t>(i)] = x;
    }
    return v;
}

constexpr std::array<Matrix, kSobolDimensions> kColumns = [] {
    std::array<Matrix, kSobolDimensions> all{};
    // The first dimension is van der Corput's sequence: the digits in reverse.
    for (int i = 0; i < kDigits; ++i) {
        all[0][static_cast<std::size_t>(i)] = std::uint32_t{1} << (kDigits - 1 - i);
    }
    for (std::size_t d = 1; d < all.size(); ++d) all[d] = columns_of(kTable[d - 1]);
    return all;
}();

}  // namespace

std::uint32_t sobol_digits(std::uint32_t index, int dimension) {
    const Matrix& columns = kColumns[static_cast<std::size_t>(dimension)];
    std::uint32_t x = 0;
    for (std::size_t i = 0; index != 0; ++i, index >>= 1) {
        if (index & 1u) x ^= columns[i];
    }
    return x;
}

double scrambled_sobol(std::uint64_t key, std::uint32_t index, int dimension) {
    const std::uint32_t digits = sobol_digits(index, dimension);
    const std::uint64_t tree = mix64(mix64(key) ^ static_cast<std::uint64_t>(dimension));
    return nested_scramble<kTreeDigits>(tree, std::uint64_t{digits} << (64 - kDigits));
}

}  // namespace alhazen
