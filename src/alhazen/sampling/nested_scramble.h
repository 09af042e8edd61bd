#pragma once
/// Nested uniform scrambling of the binary digits of a coordinate.
///
/// Source: Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995.
/// Differs: the flips of six successive digits are the bits of one hash of the digits above them,
/// and the digits below the first `kTreeDigits` are drawn for each point. Exact for points of which
/// no two share so many digits.

#include <array>
#include <cstdint>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace nested_scramble_detail {

/// Number of digits whose flips come from one hash: a tree of six levels has 63 nodes.
inline constexpr int kLevels = 6;

/// [flips][first two digits] The flips of three digits, from the flips of a tree of three levels
/// (node 1 is the root, bit n the flip of node n).
inline constexpr std::array<std::array<std::uint8_t, 4>, 256> kThreeFlips = [] {
    std::array<std::array<std::uint8_t, 4>, 256> table{};
    for (unsigned flips = 0; flips < 256; ++flips) {
        for (unsigned digits = 0; digits < 4; ++digits) {
            const unsigned flip[] = {flips >> 1, flips >> (2 | digits >> 1), flips >> (4 | digits)};
            table[flips][digits] = static_cast<std::uint8_t>((flip[0] & 1u) << 2 |
                                                             (flip[1] & 1u) << 1 | (flip[2] & 1u));
        }
    }
    return table;
}();

/// Six digits, flipped along their path through a tree: node 1 is the root, the children of node n
/// are 2n and 2n + 1.
[[nodiscard]] constexpr std::uint32_t flipped(std::uint64_t flips, std::uint32_t six) {
    const std::uint32_t upper = six >> 3;
    // The tree of three levels below the upper digits: nodes 8 + upper, 16 + 2 upper, 32 + 4 upper.
    const std::uint64_t below = (flips >> (8 + upper) & 1u) << 1 |
                                (flips >> (16 + 2 * upper) & 3u) << 2 |
                                (flips >> (32 + 4 * upper) & 15u) << 4;
    return six ^ (std::uint32_t{kThreeFlips[flips & 255u][upper >> 1]} << 3 |
                  kThreeFlips[below][six >> 1 & 3u]);
}

}  // namespace nested_scramble_detail

/// Scrambles the first 53 digits; the highest bit of `digits` is the first digit. `tree` selects
/// the flips. The result is in [0, 1).
template <int kTreeDigits>
[[nodiscard]] constexpr double nested_scramble(std::uint64_t tree, std::uint64_t digits) {
    using namespace nested_scramble_detail;
    static_assert(kTreeDigits % kLevels == 0 && kTreeDigits <= 30);
    std::uint64_t scrambled = 0;
    for (int done = 0; done < kTreeDigits; done += kLevels) {
        // The digits above select the subtree; their number distinguishes the levels.
        const std::uint64_t above = done == 0 ? 0 : digits >> (64 - done);
        const std::uint64_t flips = mix64(tree ^ (above | std::uint64_t(done + 1) << 32));
        const std::uint32_t six = static_cast<std::uint32_t>(digits >> (64 - kLevels - done)) & 63u;
        scrambled = scrambled << kLevels | flipped(flips, six);
    }
    // The remaining digits are random for each point.
    const std::uint64_t rest =
        mix64(tree ^ (digits >> (64 - kTreeDigits) | std::uint64_t{63} << 32));
    scrambled = scrambled << (53 - kTreeDigits) | rest >> (64 - (53 - kTreeDigits));
    return static_cast<double>(scrambled) * 0x1p-53;
}

}  // namespace alhazen
