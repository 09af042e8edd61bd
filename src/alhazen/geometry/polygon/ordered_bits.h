#pragma once
/// A set of numbers below n with a fast cyclic search for the next member.
///
/// Source: the 64-ary tree of summary words, as in van Emde Boas, "Preserving order in a forest in
/// less than logarithmic time", FOCS 1975.
/// Differs: uses levels of words instead of a recursion on the square root.
/// Complexity and threads: set, clear and next O(log64 n); n / 63 words of memory; no locking.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace alhazen {

class OrderedBits {
  public:
    explicit OrderedBits(std::size_t n) {
        do {
            n = (n + 63) / 64;
            levels_.emplace_back(n, 0);
        } while (n > 1);
    }
    [[nodiscard]] bool contains(std::uint32_t i) const {
        return (levels_[0][i / 64] >> i % 64 & 1) != 0;
    }
    void assign(std::uint32_t i, bool member) { member ? set(i) : clear(i); }

    /// The least member that is at least `i` or, without one, the least of all.
    [[nodiscard]] std::optional<std::uint32_t> next_around(std::uint32_t i) const {
        const std::optional<std::uint32_t> found = next(i);
        return found ? found : next(0);
    }

  private:
    void set(std::size_t i) {
        for (std::vector<std::uint64_t>& words : levels_) {
            words[i / 64] |= std::uint64_t{1} << i % 64;
            i /= 64;
        }
    }
    void clear(std::size_t i) {
        for (std::vector<std::uint64_t>& words : levels_) {
            words[i / 64] &= ~(std::uint64_t{1} << i % 64);
            if (words[i / 64] != 0) return;
            i /= 64;
        }
    }
    [[nodiscard]] std::optional<std::uint32_t> next(std::size_t i) const {
        // Goes up to a word with a member at or after i, then down to its first member.
        for (std::size_t level = 0; level < levels_.size(); ++level) {
            if (i / 64 >= levels_[level].size()) return std::nullopt;
            const std::uint64_t word = levels_[level][i / 64] >> i % 64;
            if (word != 0) {
                i += std::size_t(std::countr_zero(word));
                while (level > 0) {
                    --level;
                    i = 64 * i + std::size_t(std::countr_zero(levels_[level][i]));
                }
                return std::uint32_t(i);
            }
            i = i / 64 + 1;
        }
        return std::nullopt;
    }

    std::vector<std::vector<std::uint64_t>>
        levels_;  ///< [0] the members; [k] the nonzero words of level k - 1
};

}  // namespace alhazen
