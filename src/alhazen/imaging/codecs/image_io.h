#pragma once
/// Reads and writes image files. The suffix of the name determines the format when writing, the
/// content when reading.
///
/// Reads: PNG (all colour types, 1 to 16 bit), JPEG, TGA, BMP (1, 4 and 8-bit palette, 16, 24, 32
/// bit, RLE), EXR (flat: RGB, RGBA, grey or one channel), HDR, PFM. Writes: PNG, JPG, EXR, HDR,
/// PFM.
/// Conventions: reading checks the header against `ImageLimits` before it allocates or decodes: the
/// sizes, and the bytes of the samples and of the decoder's buffers. Memory grows with the decoded
/// data, not with the sizes in the header, except that an EXR has the size of its display window:
/// pixels outside of the data window are 0, data outside of the display window are dropped. The
/// colours of an EXR with alpha are associated with it (Image::associated), those of other formats
/// are not.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "alhazen/base/error.h"
#include "alhazen/imaging/codecs/stored_image.h"
#include "alhazen/imaging/image/encoding.h"
#include "alhazen/imaging/image/image.h"

namespace alhazen {

struct ImageLimits {
    int max_side = 32768;                               ///< set by --max-image-side
    std::uint64_t max_pixels = std::uint64_t{1} << 26;  ///< set by --max-image-pixels
    /// Maximum memory for reading an image, at its peak: the file, the samples, and the decoder's
    /// buffers. The images of a scene share it (TextureTable). Set by --max-image-mib.
    std::uint64_t max_bytes = std::uint64_t{640} << 20;
};

/// Thrown if reading an image would take more than ImageLimits::max_bytes.
class ImageMemoryExceeded : public Error {
  public:
    using Error::Error;
};

/// Reads an image. Throws Error: File if it cannot be read, Scene if it is malformed or of an
/// unknown format, Resource if it exceeds the limits.
[[nodiscard]] Image read_image(const std::filesystem::path& path, const ImageLimits& limits = {});
/// Reads an image from bytes; `name` is used in messages.
[[nodiscard]] Image decode_image(std::string_view bytes, const std::string& name,
                                 const ImageLimits& limits = {});

/// Reads an image as the file's own codes, if it has codes, which take a quarter of the memory.
[[nodiscard]] StoredImage read_stored_image(const std::filesystem::path& path,
                                            const ImageLimits& limits = {});
[[nodiscard]] StoredImage decode_stored_image(std::string_view bytes, const std::string& name,
                                              const ImageLimits& limits = {});

using ImageMetadata = std::vector<std::pair<std::string, std::string>>;

struct ImageWriteOptions {
    Encoding encoding = Encoding::Srgb;
    int bits = 8;             ///< PNG: 8 or 16
    bool full_float = false;  ///< EXR: float instead of half
    int jpeg_quality = 95;    ///< 1 to 100
    /// Key and value in UTF-8, written as PNG text chunks and EXR string attributes.
    ImageMetadata metadata = {};
    /// EXR: displayWindow of an image that is a crop at (x0, y0) of a larger frame; 0 = no crop.
    int full_width = 0, full_height = 0, crop_x0 = 0, crop_y0 = 0;
};

/// Suffixes that `write_image` accepts: png, jpg, jpeg, exr, hdr, pfm.
[[nodiscard]] const std::vector<std::string>& image_suffixes();

/// For callers with long work before the write. Throws Error: Usage, listing the known suffixes, if
/// the suffix of `path` is not one of them; Resource if its codec cannot be loaded.
void check_image_suffix(const std::filesystem::path& path);

/// Writes in the format of the suffix of `path`, in one step (see write_file_atomically). EXR, HDR
/// and PFM hold linear values: an encoded image is first decoded from sRGB. EXR holds colours
/// multiplied by alpha, unless that is 0: those of an image that is not associated are multiplied.
/// Throws Error: Usage for
/// an unknown suffix, an empty image or invalid options, File if writing fails.
void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options = {});

/// The bytes that `write_image` would write to a file with this suffix (without the dot).
[[nodiscard]] std::vector<std::byte> encode_image(const std::string& suffix, const Image& image,
                                                  const ImageWriteOptions& options = {});

/// Writes exactly these codes, in one step. Throws Error: Usage for codes that do not fit, File if
/// writing fails.
void write_png(const std::filesystem::path& path, const EncodedImage& image,
               const ImageMetadata& metadata = {});

}  // namespace alhazen
