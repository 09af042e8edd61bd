#pragma once
/// Nested uniform scrambling of the binary digits of a coordinate.
///
/// Source: Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995.
/// Differs: the flips of six successive digits are the bits of one hash of the digits above them,
/// and the digits below the first `kTreeDigits` are drawn for each point: exact for points of which
/// no two share so many.

#include <cstdint>

#include "alhazen/sampling/random.h"

namespace alhazen {

/// Scrambles the first 53 digits; the highest bit of `digits` is the first. `tree` selects the
/// flips. The result is in [0, 1).
template <int kTreeDigits>
[[nodiscard]] constexpr double nested_scramble(std::uint64_t tree, std::uint64_t digits) {
    /// Digits whose flips come from one hash: a tree of six levels has 63 nodes.
    constexpr int kLevels = 6;
    static_assert(kTreeDigits % kLevels == 0 && kTreeDigits <= 30);
    std::uint64_t scrambled = 0;
    for (int done = 0; done < kTreeDigits; done += kLevels) {
        // The digits above select the subtree; their number separates the levels.
        const std::uint64_t above = done == 0 ? 0 : digits >> (64 - done);
        const std::uint64_t flips = mix64(tree ^ (above | std::uint64_t(done + 1) << 32));
        const std::uint32_t six = static_cast<std::uint32_t>(digits >> (64 - kLevels - done)) & 63u;
        // Node 1 is the root; the children of node n are 2n and 2n + 1: the nodes on the way are
        // the beginnings of the digits behind a one.
        const std::uint32_t way = 64u | six;
        const auto flip = [&](int level) {
            return static_cast<std::uint32_t>((flips >> (way >> (level + 1))) & 1u) << level;
        };
        const std::uint32_t flipped = flip(0) | flip(1) | flip(2) | flip(3) | flip(4) | flip(5);
        scrambled = scrambled << kLevels | (six ^ flipped);
    }
    // The remaining digits are drawn for this point alone.
    const std::uint64_t rest =
        mix64(tree ^ (digits >> (64 - kTreeDigits) | std::uint64_t{63} << 32));
    scrambled = scrambled << (53 - kTreeDigits) | rest >> (64 - (53 - kTreeDigits));
    return static_cast<double>(scrambled) * 0x1p-53;
}

}  // namespace alhazen
