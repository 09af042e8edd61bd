#pragma once
/// Reads Truevision TGA.
///
/// Source: Truevision, "TGA File Format Specification", version 2.0, 1991.
/// Differs: ignores the postage stamp, the developer area, gamma and colour correction. Alpha is
/// read if the descriptor counts attribute bits, unless the extension area of a version 2 file
/// declares them meaningless.
/// Conventions: palette, true colour and grey, run-length coded or not, 8, 15, 16, 24 and 32 bits,
/// any corner first. Samples are codes of 8 bits; channels of 5 bits are expanded to round(255 v /
/// 31). The format has no signature: `is_plausible_tga` checks every field of the header.

#include <string>
#include <string_view>

#include "alhazen/imaging/codecs/image_io.h"
#include "alhazen/imaging/codecs/stored_image.h"

namespace alhazen {

/// True if the header is consistent and the data can be long enough for it.
[[nodiscard]] bool is_plausible_tga(std::string_view bytes);

/// Throws Error: Scene if malformed, Resource beyond the limits.
[[nodiscard]] StoredImage decode_tga(std::string_view bytes, const std::string& name,
                                     const ImageLimits& limits);

}  // namespace alhazen
