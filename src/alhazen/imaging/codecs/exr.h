#pragma once
/// Reads and writes OpenEXR, half and float, with the OpenEXR library.
///
/// Source: F. Kainz, R. Bogart, "Technical Introduction to OpenEXR", 2009.
/// Differs: reads flat images only: of a multi-part file the first flat part with colours; R, G, B
/// (A), or Y (A), or a single channel of any name. Refuses luminance with chroma and subsampled
/// channels.
/// Conventions: the image has the size of the display window; data outside of it are dropped,
/// pixels outside of the data window are 0 (Image::held). Colours are associated with alpha and
/// read and written as they are. A missing channel of R, G, B is 0. Written files are
/// ZIP-compressed scan lines; the same image gives the same bytes.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

/// For callers with long work before the write. Throws Error (Resource) if the codec is a module
/// (exr_functions.h) that cannot be loaded.
void require_exr();

/// Throws Error: Scene if malformed or not supported, Resource beyond the limits.
[[nodiscard]] Image decode_exr(std::string_view bytes, const std::string& name,
                               const ImageLimits& limits);

/// Precondition: `image` has valid sizes. Numbers beyond the range of half become the largest half
/// unless `full_float` (half_range.h). Throws Error (Usage) if the crop is not inside the full
/// frame, or a metadata key is empty or longer than 255.
[[nodiscard]] std::vector<std::byte> encode_exr(const Image& image,
                                                const ImageWriteOptions& options);

}  // namespace alhazen
