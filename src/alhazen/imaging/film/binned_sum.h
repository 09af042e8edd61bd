#pragma once
/// Sums of N doubles each, from several threads, that do not depend on the order of the terms.
///
/// Source: Ahrens, Demmel and Nguyen, "Algorithms for Efficient Reproducible Floating Point
/// Summation", ACM TOMS 46(3), 2020 (bins at fixed places, of which the highest are kept).
/// Differs: bins are integers. A term is written in digits of base 2^28, at fixed places; a sum
/// keeps the sums of the three highest digits in which any term reaches. Digits below are cut off:
/// less than 2^-56 of the largest term. Which digits of which terms are summed does not depend on
/// the order.
/// Conventions: terms may be all finite doubles. The sum of 2^35 terms is exact but for the digits
/// cut off.
/// Threads: `add` may be called from several.

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <thread>

namespace alhazen {

template <std::size_t N>
class BinnedSum {
  public:
    /// Adds a term to each sum; false if one is not finite, and all are therefore left out.
    bool add(const std::array<double, N>& terms) {
        for (const double term : terms) {
            if (!std::isfinite(term)) return false;
        }
        while (busy_.test_and_set(std::memory_order_acquire)) std::this_thread::yield();
        for (std::size_t k = 0; k < N; ++k) add(terms[k], k);
        busy_.clear(std::memory_order_release);
        return true;
    }
    /// The sums. Not to be called during `add`.
    [[nodiscard]] std::array<double, N> value() const {
        std::array<double, N> values;
        for (std::size_t k = 0; k < N; ++k) {
            Wide sum = 0;
            for (int i = kKept - 1; i >= 0; --i) sum = sum * (Wide{1} << kBits) + digits_[k][i];
            values[k] = std::ldexp(static_cast<double>(sum), kBits * lowest_[k] + kFirstPlace);
        }
        return values;
    }

  private:
    __extension__ typedef __int128 Wide;
    __extension__ typedef unsigned __int128 UnsignedWide;
    static constexpr int kBits = 28, kKept = 3;
    static constexpr int kFirstPlace = -1074;  ///< exponent of the lowest bit of all doubles

    void add(double term, std::size_t k) {
        const auto bits = std::bit_cast<std::uint64_t>(term);
        const auto exponent = static_cast<int>(bits >> 52 & 0x7FF);
        std::uint64_t mantissa = bits & ((std::uint64_t{1} << 52) - 1);
        if (exponent > 0) mantissa |= std::uint64_t{1} << 52;
        if (mantissa == 0) return;
        // The place of the mantissa's lowest bit, and the digit of its highest one.
        const int place = exponent > 0 ? exponent - 1 : 0;
        const int highest = (place + static_cast<int>(std::bit_width(mantissa)) - 1) / kBits;
        if (highest >= lowest_[k] + kKept) raise(k, highest - (kKept - 1));
        const int shift = place - kBits * lowest_[k];
        if (shift <= -64) return;
        UnsignedWide whole = shift >= 0 ? UnsignedWide{mantissa} << shift : mantissa >> -shift;
        const bool negative = bits >> 63 != 0;
        for (std::int64_t& sum : digits_[k]) {
            const auto digit = static_cast<std::int64_t>(whole & ((1u << kBits) - 1));
            sum += negative ? -digit : digit;
            whole >>= kBits;
        }
    }
    /// Makes `lowest` the lowest digit of a sum.
    void raise(std::size_t k, int lowest) {
        const int by = lowest - lowest_[k];
        for (int i = 0; i < kKept; ++i) {
            digits_[k][i] = i + by < kKept ? digits_[k][i + by] : 0;
        }
        lowest_[k] = static_cast<std::uint8_t>(lowest);
    }

    std::int64_t digits_[N][kKept] = {};  ///< sums of digits, the lowest first
    std::uint8_t lowest_[N] = {};         ///< number of the lowest digit that is kept
    std::atomic_flag busy_;
};

}  // namespace alhazen
