#pragma once
/// Reads and writes Radiance HDR: three mantissas that share an exponent, run-length coded.
///
/// Source: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the file format page of Radiance.
/// Differs: mantissas are rounded to the nearest on writing, and read as m * 2^(e - 136). Radiance
/// cuts them off, and adds half a step on reading. EXPOSURE and other header lines are ignored.
/// Conventions: only the common orientation (-Y height +X width: top row first); RGB, not XYZ. On
/// writing, negative values and NaN become 0, and infinity becomes the largest value.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "alhazen/imaging/codecs/image_io.h"

namespace alhazen {

/// Throws Error: Scene if malformed or not supported, Resource beyond the limits.
[[nodiscard]] Image decode_hdr(std::string_view bytes, const std::string& name,
                               const ImageLimits& limits);

/// Precondition: `image` has valid sizes. Grey is repeated, alpha dropped. The error of each
/// channel is at most 1/255 of the largest.
[[nodiscard]] std::vector<std::byte> encode_hdr(const Image& image);

}  // namespace alhazen
