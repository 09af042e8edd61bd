#pragma once
/// Reads and writes PNG, 8 and 16 bit, with libpng.
///
/// Source: ISO/IEC 15948 (PNG).
/// Differs: ignores gAMA, sBIT, ICC profiles and text: samples are sRGB display codes.
/// Conventions: read samples are code / 255 or code / 65535; palettes become RGB, tRNS becomes
/// alpha. Damage in critical chunks, including a truncated file, is an error. Threads: large
/// pictures are encoded by several, to the same bytes with any number of them.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

/// Throws Error: Scene if malformed, Resource beyond the limits.
[[nodiscard]] StoredImage decode_png(std::string_view bytes, const std::string& name,
                                     const ImageLimits& limits);

/// A file that holds exactly the codes of `image`. Throws Error (Usage) if the sizes or the codes
/// are invalid, or a key of `metadata` is not 1 to 79 printable ASCII characters.
[[nodiscard]] std::vector<std::byte> encode_png(const EncodedImage& image,
                                                const ImageMetadata& metadata);
[[nodiscard]] std::vector<std::byte> encode_png(const CodeRows& rows,
                                                const ImageMetadata& metadata);

}  // namespace alhazen
