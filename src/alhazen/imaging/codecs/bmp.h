#pragma once
/// Reads Windows and OS/2 bitmaps.
///
/// Source: Microsoft, "Bitmap Storage" (BITMAPCOREHEADER to BITMAPV5HEADER).
/// Differs: refuses bitmaps that embed a JPEG or PNG. Pixels that a run-length code skips have the
/// first colour of the palette.
/// Conventions: palettes of 1, 4 and 8 bits; 16, 24 and 32 bits; bottom row or top row first.
/// Samples are code / max. The fourth byte of a pixel is alpha only if a mask says so. A palette
/// index beyond the palette is an error.

#include <string>
#include <string_view>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

/// Throws Error: Scene if malformed or not supported, Resource beyond the limits.
[[nodiscard]] StoredImage decode_bmp(std::string_view bytes, const std::string& name,
                                     const ImageLimits& limits);

}  // namespace alhazen
