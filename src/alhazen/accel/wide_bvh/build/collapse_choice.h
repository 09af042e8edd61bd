#pragma once
/// The choices of `collapse`, and the step of its dynamic program for nodes of eight children,
/// compiled for several instruction sets.
///
/// Conventions: results do not depend on the instruction set.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace alhazen {

/// The cheapest conversions of the subtree of a binary node to at most i wide subtrees.
template <std::uint32_t kWidth>
struct ChoiceOf {
    std::array<std::uint8_t, kWidth> lefts;  ///< [i - 1] number for the left child, 0: as for i - 1
    std::uint8_t inner_left;                 ///< as left(kWidth), for a wide node made of this node
    bool as_leaf;                            ///< the single subtree is a leaf

    [[nodiscard]] std::uint32_t left(std::uint32_t i) const { return lefts[i - 1]; }
    /// The number of subtrees made of at most i.
    [[nodiscard]] std::uint32_t used(std::uint32_t i) const {
        if constexpr (kWidth == 8 && std::endian::native == std::endian::little) {
            // The highest byte that is not 0, of the lowest i.
            std::uint64_t all;
            std::memcpy(&all, lefts.data(), sizeof(all));
            all &= ~std::uint64_t{0} >> (64 - 8 * i);
            return (static_cast<std::uint32_t>(std::bit_width(all | 1)) + 7) / 8;
        }
        while (i > 1 && left(i) == 0) --i;
        return i;
    }
};

/// Sets the costs of an inner node of the binary tree from those of its children: [i - 1] the least
/// cost of the subtree as at most i wide subtrees. `as_leaf` is its cost as a leaf, or infinite.
using ChooseEight = ChoiceOf<8> (*)(const float* left, const float* right, float area,
                                    float as_leaf, float* costs);
/// That of this machine.
[[nodiscard]] ChooseEight choose_eight();

}  // namespace alhazen
