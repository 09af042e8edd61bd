#pragma once
/// Reads and writes JPEG with libjpeg-turbo.
///
/// Source: ITU-T T.81 (JPEG), JFIF 1.02; Adobe's APP14 for the polarity of CMYK.
/// Differs: data that end early or do not decode are an error, where libjpeg only warns.
/// Conventions: read samples are code / 255, grey or RGB; CMYK is converted to RGB.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

/// Throws Error: Scene if malformed, Resource beyond the limits.
[[nodiscard]] StoredImage decode_jpeg(std::string_view bytes, const std::string& name,
                                      const ImageLimits& limits);

/// Encodes without chroma subsampling; drops alpha. Throws Error (Usage) if sizes, bits (8) or
/// quality (1 to 100) are invalid.
[[nodiscard]] std::vector<std::byte> encode_jpeg(const EncodedImage& image, int quality);

}  // namespace alhazen
