#pragma once
/// The range of half precision, in which EXR pictures hold their samples by default.
///
/// Source: IEEE 754-2019, binary16. A number from half a step beyond the largest rounds to
/// infinity.
/// Conventions: infinities and NaN are not numbers beyond the range; they stay.

#include <cmath>

namespace alhazen {

inline constexpr double kLargestHalf = 65504.0;
inline constexpr double kRoundsToInfinity = 65520.0;

/// True for a finite number that half precision would round to infinity.
[[nodiscard]] inline bool is_beyond_half(double value) {
    return std::abs(value) >= kRoundsToInfinity && std::isfinite(value);
}

/// The number, or the largest of its sign in half precision if it is beyond the range.
[[nodiscard]] inline double within_half(double value) {
    return is_beyond_half(value) ? std::copysign(kLargestHalf, value) : value;
}

}  // namespace alhazen
