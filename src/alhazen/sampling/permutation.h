#pragma once
/// Random permutations that are computed and need no storage.
///
/// Source: Luby and Rackoff, "How to Construct Pseudorandom Permutations from Pseudorandom
/// Functions", SIAM J. Comput. 17(2), 1988 (Feistel rounds); Black and Rogaway, "Ciphers with
/// Arbitrary Finite Domains", CT-RSA 2002 (cycle walking).
/// Complexity: on average at most four times as many rounds as for a power of four.

#include <bit>
#include <cstdint>

#include "alhazen/sampling/random.h"

namespace alhazen {

/// The image of `i` under the permutation of 0 .. size - 1 that `key` selects.
/// Precondition: i < size <= 2^30.
[[nodiscard]] constexpr std::uint32_t permuted(std::uint32_t i, std::uint32_t size,
                                               std::uint64_t key) {
    constexpr std::uint64_t kRounds = 4;
    if (size <= 1) return 0;
    const int half = (std::bit_width(size - 1) + 1) / 2;
    const std::uint32_t mask = (std::uint32_t{1} << half) - 1;
    do {
        std::uint32_t left = i >> half, right = i & mask;
        for (std::uint64_t round = 0; round < kRounds; ++round) {
            const std::uint64_t f = mix64(key ^ (right | round << 32));
            const std::uint32_t next = left ^ (static_cast<std::uint32_t>(f >> 20) & mask);
            left = right;
            right = next;
        }
        i = left << half | right;
    } while (i >= size);
    return i;
}

}  // namespace alhazen
