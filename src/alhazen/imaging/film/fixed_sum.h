#pragma once
/// A sum of doubles from several threads that does not depend on the order of its terms.
///
/// Differs: an ordinary sum rounds after each term. This one is a fixed-point number of 128 bits
/// with a quantum of 2^-80: each term is rounded once, to a multiple of it.

#include <atomic>
#include <cmath>
#include <cstdint>

namespace alhazen {

class FixedSum {
  public:
    /// Largest magnitude of a term.
    static constexpr double kLargest = 0x1p40;

    /// Adds a term; false if it is not finite or too large, and therefore left out.
    bool add(double term) {
        if (!(std::abs(term) <= kLargest)) return false;
        const auto fixed = static_cast<Wide>(std::ldexp(term, kBits));
        const auto low = static_cast<std::uint64_t>(fixed);
        const auto high = static_cast<std::uint64_t>(fixed >> 64);
        const std::uint64_t before = low_.fetch_add(low, std::memory_order_relaxed);
        const std::uint64_t carry = before + low < before ? 1 : 0;
        if (high + carry != 0) high_.fetch_add(high + carry, std::memory_order_relaxed);
        return true;
    }
    /// The sum. Not to be called during `add`.
    [[nodiscard]] double value() const {
        const std::uint64_t high = high_.load(std::memory_order_relaxed);
        const std::uint64_t low = low_.load(std::memory_order_relaxed);
        const Wide fixed = static_cast<Wide>(static_cast<UnsignedWide>(high) << 64 |
                                             static_cast<UnsignedWide>(low));
        return std::ldexp(static_cast<double>(fixed), -kBits);
    }

  private:
    __extension__ typedef __int128 Wide;
    __extension__ typedef unsigned __int128 UnsignedWide;
    static constexpr int kBits = 80;

    std::atomic<std::uint64_t> low_{0}, high_{0};
};

}  // namespace alhazen
