#pragma once
/// A bitmap font of 5 x 7 pixels for the scales of false-colour pictures.
///
/// Conventions: digits, lower-case letters and . - + _ only; all other characters are blank.

#include <cstdint>
#include <string_view>

namespace alhazen {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7;
/// Distance between the left edges of successive letters, in pixels.
inline constexpr int kGlyphAdvance = 6;

/// True if the pixel belongs to the letter; x in [0, 5), y in [0, 7) from the top.
[[nodiscard]] bool glyph_pixel(char letter, int x, int y);

/// Width of a line of text, in pixels.
[[nodiscard]] inline int text_width(std::string_view text) {
    return text.empty() ? 0 : static_cast<int>(text.size()) * kGlyphAdvance - 1;
}

}  // namespace alhazen
