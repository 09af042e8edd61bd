#pragma once
/// Successive numbers that fill [0, 1) evenly, for few draws without a sampler.
///
/// Source: van der Corput, "Verteilungsfunktionen", Proceedings of the Royal Academy of Amsterdam
/// 38, 1935.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace alhazen {

/// The fractional part of v >= 0, below 1.
[[nodiscard]] inline double fraction(double v) {
    return std::min(v - std::floor(v), 0x1.fffffffffffffp-1);
}

/// The radical inverse of n in base 2: its bits in reverse order, behind the binary point.
[[nodiscard]] inline double mirrored_bits(std::uint32_t n) {
    double value = 0.0;
    for (double bit = 0.5; n != 0; n >>= 1, bit *= 0.5) value += (n & 1) != 0 ? bit : 0.0;
    return value;
}

}  // namespace alhazen
