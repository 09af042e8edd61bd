#pragma once
/// The filters of a PNG row, which predict its bytes from earlier ones, and the selection of one.
///
/// Source: ISO/IEC 15948 (PNG), clause 9 (the filters), and 12.7 (the filter with the least sum of
/// absolute differences, as signed bytes).
/// Differs: the sums are computed in lanes, and a sign test replaces Paeth's sum; the selected
/// filter is that of libpng, which tries fewer for one row or column.
/// Conventions: among equal sums the first filter is selected, as in libpng.

#include <cstddef>
#include <cstdint>
#include <span>

namespace alhazen {

/// Ordered by their numbers in the file.
enum class PngFilter : std::uint8_t { None, Sub, Up, Average, Paeth };

/// The filter for `row`. `above`: the row above it, of equal size. `pixel`: bytes per pixel, 1 to
/// 8. Both rows are preceded by `kPngRowMargin` zeros in memory.
[[nodiscard]] PngFilter best_png_filter(std::span<const std::uint8_t> row,
                                        std::span<const std::uint8_t> above, std::size_t pixel);
/// Sets `filtered`, of the size of `row`, to the differences of its bytes and their predictions.
/// The other arguments are as above.
void apply_png_filter(PngFilter filter, std::span<const std::uint8_t> row,
                      std::span<const std::uint8_t> above, std::size_t pixel,
                      std::uint8_t* filtered);
inline constexpr std::size_t kPngRowMargin = 8;

}  // namespace alhazen
