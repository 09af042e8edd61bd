#pragma once
/// The filter of a row of a PNG picture: how its bytes are predicted from those before them.
///
/// Source: ISO/IEC 15948 (PNG), clause 9 (the filters), and 12.7 (the filter whose differences, as
/// signed bytes, have the least sum is chosen). The sign test in place of Paeth's sum is ours.
/// Differs: sums in lanes, where libpng takes byte after byte; the choice is the same.
/// Conventions: of equal sums the first filter is taken, as by libpng.

#include <cstddef>
#include <cstdint>
#include <span>

namespace alhazen {

/// In the order of their numbers in the file.
enum class PngFilter : std::uint8_t { None, Sub, Up, Average, Paeth };

/// The filter for `row`, below `above`, of as many bytes; `pixel`: the bytes of a pixel, 1 to 8.
/// Each has `kPngRowMargin` zeros in memory before its first byte.
[[nodiscard]] PngFilter best_png_filter(std::span<const std::uint8_t> row,
                                        std::span<const std::uint8_t> above, std::size_t pixel);
inline constexpr std::size_t kPngRowMargin = 8;

}  // namespace alhazen
