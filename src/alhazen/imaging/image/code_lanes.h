#pragma once
/// Conversions of whole rows of picture codes, in lanes.
///
/// Conventions: the codes are those of `encode_channel` (encoding.h).

#include <cstdint>
#include <span>

namespace alhazen {

/// Writes floor(most * c + offset) for each value c, clamped to [0, 1], as many as `codes` holds;
/// NaN becomes 0. Preconditions: `most` is at most 65535, `offset` is 0 or 0.5.
void linear_codes(const double* values, double most, double offset, std::span<std::uint16_t> codes);

/// Writes the low byte of each code; false if a code exceeds 255.
[[nodiscard]] bool narrow_codes(std::span<const std::uint16_t> codes, std::uint8_t* bytes);

}  // namespace alhazen
