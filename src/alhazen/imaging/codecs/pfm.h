#pragma once
/// Reads and writes portable float maps: a text header, then floats.
///
/// Source: P. Debevec, "PFM Portable FloatMap Image Format", 2001.
/// Conventions: the file has the bottom row first. The sign of its scale is the byte order
/// (negative: little endian, which is written); its magnitude multiplies the values.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

/// Throws Error: Scene if malformed, Resource beyond the limits.
[[nodiscard]] Image decode_pfm(std::string_view bytes, const std::string& name,
                               const ImageLimits& limits);

/// Precondition: `image` has valid sizes. Drops alpha; writes every float unchanged.
[[nodiscard]] std::vector<std::byte> encode_pfm(const Image& image);

}  // namespace alhazen
