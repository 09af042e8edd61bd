#pragma once
/// Pixels in the layout of screens: red, green, blue and 255, one byte each.

#include <cstddef>
#include <cstdint>

#include "alhazen/imaging/image/encoding.h"

namespace alhazen {

/// Writes four bytes for each of `pixels` triples of linear values: the 8-bit codes of `encode`.
void write_screen_pixels(const double* rgb, std::size_t pixels, Encoding encoding,
                         std::uint8_t* bytes);

}  // namespace alhazen
