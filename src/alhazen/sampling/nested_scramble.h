#pragma once
/// Nested uniform scrambling of the binary digits of a coordinate.
///
/// Source: Owen, "Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences", 1995.
/// Differs: the flips of six successive digits are the bits of one hash of the digits above them,
/// and the digits below the first `kTreeDigits` are drawn for each point: exact for points of which
/// no two share so many.

#include <array>
#include <cstdint>

#include "alhazen/sampling/random.h"

namespace alhazen {

namespace nested_scramble_detail {

/// Digits whose flips come from one hash: a tree of six levels has 63 nodes.
inline constexpr int kLevels = 6;

/// Flips of three digits, by the flips of a tree of three levels (node 1 is the root, bit n is that
/// of node n) and the first two digits.
inline constexpr std::array<std::array<std::uint8_t, 4>, 256> kThreeFlips = [] {
    std::array<std::array<std::uint8_t, 4>, 256> table{};
    for (unsigned flips = 0; flips < 256; ++flips) {
        for (unsigned digits = 0; digits < 4; ++digits) {
            const unsigned flip[] = {flips >> 1, flips >> (2 | digits >> 1), flips >> (4 | digits)};
            table[flips][digits] = static_cast<std::uint8_t>(
                (flip[0] & 1u) << 2 | (flip[1] & 1u) << 1 | (flip[2] & 1u));
        }
    }
    return table;
}();

/// Six digits with the flips of their way through a tree: node 1 is the root, the children of node
/// n are 2n and 2n + 1.
[[nodiscard]] constexpr std::uint32_t flipped(std::uint64_t flips, std::uint32_t six) {
    const std::uint32_t upper = six >> 3;
    // The tree of three levels below the upper digits: nodes 8 + upper, 16 + 2 upper, 32 + 4 upper.
    const std::uint64_t below = (flips >> (8 + upper) & 1u) << 1 |
                                (flips >> (16 + 2 * upper) & 3u) << 2 |
                                (flips >> (32 + 4 * upper) & 15u) << 4;
    return six ^ (std::uint32_t{kThreeFlips[flips & 255u][upper >> 1]} << 3 |
                  kThreeFlips[below][six >> 1 & 3u]);
}

/// Flips of the six digits behind `done` others. The digits above select the subtree; their number
/// separates the levels.
[[nodiscard]] constexpr std::uint64_t flips_behind(std::uint64_t tree, std::uint64_t digits,
                                                   int done) {
    const std::uint64_t above = done == 0 ? 0 : digits >> (64 - done);
    return mix64(tree ^ (above | std::uint64_t(done + 1) << 32));
}

[[nodiscard]] constexpr std::uint32_t six_behind(std::uint64_t digits, int done) {
    return static_cast<std::uint32_t>(digits >> (64 - kLevels - done)) & 63u;
}

/// Goes on from `scrambled`, the first `done` digits.
template <int kTreeDigits>
[[nodiscard]] constexpr double scramble_rest(std::uint64_t tree, std::uint64_t digits, int done,
                                             std::uint64_t scrambled) {
    static_assert(kTreeDigits % kLevels == 0 && kTreeDigits <= 30);
    for (; done < kTreeDigits; done += kLevels) {
        scrambled = scrambled << kLevels |
                    flipped(flips_behind(tree, digits, done), six_behind(digits, done));
    }
    // The remaining digits are drawn for this point alone.
    const std::uint64_t rest =
        mix64(tree ^ (digits >> (64 - kTreeDigits) | std::uint64_t{63} << 32));
    scrambled = scrambled << (53 - kTreeDigits) | rest >> (64 - (53 - kTreeDigits));
    return static_cast<double>(scrambled) * 0x1p-53;
}

}  // namespace nested_scramble_detail

/// Scrambles the first 53 digits; the highest bit of `digits` is the first. `tree` selects the
/// flips. The result is in [0, 1).
template <int kTreeDigits>
[[nodiscard]] constexpr double nested_scramble(std::uint64_t tree, std::uint64_t digits) {
    return nested_scramble_detail::scramble_rest<kTreeDigits>(tree, digits, 0, 0);
}

/// The same for many points: the hashes of the first twelve digits are computed once. Worth it from
/// some 64 points on.
template <int kTreeDigits>
class NestedScrambles {
  public:
    explicit constexpr NestedScrambles(std::uint64_t tree) : tree_(tree) {
        using namespace nested_scramble_detail;
        static_assert(kTreeDigits >= 2 * kLevels);
        const std::uint64_t flips = flips_behind(tree, 0, 0);
        for (std::uint32_t six = 0; six < 64; ++six) {
            first_[six] = static_cast<std::uint8_t>(flipped(flips, six));
            second_[six] = flips_behind(tree, std::uint64_t{six} << (64 - kLevels), kLevels);
        }
    }

    [[nodiscard]] constexpr double operator()(std::uint64_t digits) const {
        using namespace nested_scramble_detail;
        const std::uint32_t six = six_behind(digits, 0);
        const std::uint64_t twelve = std::uint64_t{first_[six]} << kLevels |
                                     flipped(second_[six], six_behind(digits, kLevels));
        return scramble_rest<kTreeDigits>(tree_, digits, 2 * kLevels, twelve);
    }

  private:
    std::uint64_t tree_;
    std::array<std::uint8_t, 64> first_{};    ///< [first six digits] the same scrambled
    std::array<std::uint64_t, 64> second_{};  ///< [first six digits] flips of the next six
};

}  // namespace alhazen
