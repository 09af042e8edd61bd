#pragma once
/// Picture files in and out, chosen by name, recognised by content.
///
/// In: PNG (all colour types, 8 and 16 bit), JPEG, BMP (8-bit palette, 24, 32 bit uncompressed), EXR, HDR,
/// PFM. Out: PNG, JPG, EXR, HDR, PFM. Reading checks the header against `ImageLimits` before it allocates
/// or decodes.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/imaging/image.h"

namespace alhazen {

struct ImageLimits {
    int max_side = 32768;
    std::uint64_t max_pixels = std::uint64_t{1} << 28;
};

/// Reads a picture. Throws Error: File when it cannot be read, Scene when it is malformed or of an unknown
/// kind, Resource when it exceeds the limits.
[[nodiscard]] Image read_image(const std::filesystem::path& path, const ImageLimits& limits = {});
/// The same from bytes; `name` is used in messages.
[[nodiscard]] Image decode_image(std::string_view bytes, const std::string& name,
                                 const ImageLimits& limits = {});

/// How linear values become the integers of PNG and JPG.
enum class Encoding {
    LinearTruncated,  ///< floor(max * clamp(c, 0, 1)): the course's and the old formats' pictures
    Srgb,             ///< IEC 61966-2-1 transfer curve, rounded to nearest
};

struct ImageWriteOptions {
    Encoding encoding = Encoding::Srgb;
    int bits = 8;             ///< PNG: 8 or 16
    bool full_float = false;  ///< EXR: float instead of half
    int jpeg_quality = 95;
    /// Written as PNG text chunks and EXR string attributes.
    std::vector<std::pair<std::string, std::string>> metadata;
    /// EXR: displayWindow when the image is a crop of a larger frame (x0, y0 its place); 0 = no crop.
    int full_width = 0, full_height = 0, crop_x0 = 0, crop_y0 = 0;
};

/// Suffixes that `write_image` knows: png, jpg, jpeg, exr, hdr, pfm.
[[nodiscard]] const std::vector<std::string>& image_suffixes();

/// Writes by the suffix of `path`, as one step (see write_file_atomically). Throws Error: Usage for an
/// unknown suffix (the message lists the known ones), File when writing fails.
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {});

}  // namespace alhazen
