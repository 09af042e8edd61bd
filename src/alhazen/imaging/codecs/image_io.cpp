#include "alhazen/imaging/codecs/image_io.h"

#include <algorithm>
#include <new>
#include <span>

#include "alhazen/base/file.h"
#include "alhazen/base/lower_case.h"
#include "alhazen/imaging/codecs/bmp.h"
#include "alhazen/imaging/codecs/exr.h"
#include "alhazen/imaging/codecs/exr_layers.h"
#include "alhazen/imaging/codecs/hdr.h"
#include "alhazen/imaging/codecs/image_size.h"
#include "alhazen/imaging/codecs/jpeg.h"
#include "alhazen/imaging/codecs/pfm.h"
#include "alhazen/imaging/codecs/png.h"
#include "alhazen/imaging/codecs/tga.h"

namespace alhazen {

namespace {

using Decoder = StoredImage (*)(std::string_view, const std::string&, const ImageLimits&);

/// Decodes a format whose samples are floats.
template <Image (*decode)(std::string_view, const std::string&, const ImageLimits&)>
StoredImage decode_floats(std::string_view bytes, const std::string& name,
                          const ImageLimits& limits) {
    return stored(decode(bytes, name, limits));
}

/// An image format, identified by its first bytes. ADD A FORMAT THAT IS READ HERE.
struct Signature {
    std::string_view start;
    Decoder decode;
};

constexpr Signature kSignatures[] = {
    {"\x89PNG\r\n\x1a\n", decode_png},
    {"\xff\xd8\xff", decode_jpeg},
    {"\x76\x2f\x31\x01", decode_floats<decode_exr>},
    {"#?", decode_floats<decode_hdr>},
    {"PF", decode_floats<decode_pfm>},
    {"Pf", decode_floats<decode_pfm>},
    {"BM", decode_bmp},
};

std::string suffix_of(const std::filesystem::path& path) {
    std::string suffix = lower_suffix(path);
    if (!suffix.empty()) suffix.erase(0, 1);
    return suffix;
}

[[noreturn]] void unknown_suffix(const std::string& suffix, FileLocation location) {
    std::string known;
    for (const std::string& name : image_suffixes()) known += (known.empty() ? "" : ", ") + name;
    throw Error(ErrorKind::Usage,
                "cannot write a picture as \"" + suffix + "\", expected one of " + known,
                std::move(location));
}

void check_samples(const Image& image) {
    const auto count =
        std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
    if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4 ||
        image.samples.size() != count) {
        throw Error(ErrorKind::Usage, "cannot write a picture of " + std::to_string(image.width) +
                                          " x " + std::to_string(image.height) + " pixels with " +
                                          std::to_string(image.samples.size()) + " samples");
    }
}

/// Reads the bytes of a file; their memory counts towards the limit.
std::string file_within(const std::filesystem::path& path, const ImageLimits& limits) {
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (!failed) check_image_memory(size, limits, path.string());
    return read_file(path);
}

/// The limits that remain while `bytes` are in memory.
ImageLimits beside(const std::string& bytes, ImageLimits limits) {
    limits.max_bytes -= std::min<std::uint64_t>(limits.max_bytes, bytes.size());
    return limits;
}

/// True if straight colours differ from associated ones.
bool has_partial_cover(const Image& image) {
    const auto step = std::size_t(image.channels);
    if (image.associated || (step != 2 && step != 4)) return false;
    for (std::size_t i = step - 1; i < image.samples.size(); i += step) {
        if (image.samples[i] != 1.0f) return true;
    }
    return false;
}

/// The image with linear values; alpha is linear already.
Image linear_copy(Image image) {
    image.linear = true;
    const auto channels = std::size_t(image.channels);
    const bool has_alpha = channels == 2 || channels == 4;
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        if (has_alpha && i % channels == channels - 1) continue;
        image.samples[i] = float(linear_from_srgb(double(image.samples[i])));
    }
    return image;
}

}  // namespace

StoredImage decode_stored_image(std::string_view bytes, const std::string& name,
                                const ImageLimits& limits) {
    try {
        for (const Signature& signature : kSignatures) {
            if (bytes.starts_with(signature.start)) return signature.decode(bytes, name, limits);
        }
        // TGA has no signature, so it is tried last.
        if (suffix_of(name) == "tga" || is_plausible_tga(bytes)) {
            return decode_tga(bytes, name, limits);
        }
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, "not enough memory for the picture", {name, 0, 0});
    }
    bad_image(name, "not a picture of a known kind; expected PNG, JPEG, BMP, TGA, EXR, HDR or PFM");
}

Image decode_image(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    try {
        StoredImage image = decode_stored_image(bytes, name, limits);
        if (!std::holds_alternative<std::vector<float>>(image.samples)) {
            const std::uint64_t floats =
                sample_bytes(image.width, image.height, std::uint64_t(image.channels), 4);
            check_image_memory(image.memory_bytes() + floats, limits, name);
        }
        return expanded(std::move(image));
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resource, "not enough memory for the picture", {name, 0, 0});
    }
}

StoredImage read_stored_image(const std::filesystem::path& path, const ImageLimits& limits) {
    const std::string bytes = file_within(path, limits);
    return decode_stored_image(bytes, path.string(), beside(bytes, limits));
}

Image read_image(const std::filesystem::path& path, const ImageLimits& limits) {
    const std::string bytes = file_within(path, limits);
    return decode_image(bytes, path.string(), beside(bytes, limits));
}

const std::vector<std::string>& image_suffixes() {
    static const std::vector<std::string> suffixes{"png", "jpg", "jpeg", "exr", "hdr", "pfm"};
    return suffixes;
}

void check_image_suffix(const std::filesystem::path& path) {
    const std::string suffix = suffix_of(path);
    const std::vector<std::string>& known = image_suffixes();
    if (std::find(known.begin(), known.end(), suffix) == known.end()) {
        unknown_suffix(suffix, {path.string(), 0, 0});
    }
    if (suffix == "exr") require_exr();
}

std::vector<std::byte> encode_image(const std::string& suffix, const Image& image,
                                    const ImageWriteOptions& options) {
    check_samples(image);
    if (suffix == "png") {
        return encode_png(encode(image, options.encoding, options.bits), options.metadata);
    }
    if (suffix == "jpg" || suffix == "jpeg") {
        return encode_jpeg(encode(image, options.encoding, 8), options.jpeg_quality);
    }
    // Linear images, which can be large, are not copied.
    if ((suffix == "exr" || suffix == "hdr" || suffix == "pfm") && !image.linear) {
        return encode_image(suffix, linear_copy(image), options);
    }
    if (suffix == "exr" && has_partial_cover(image)) {
        return encode_exr(associated_copy(image), options);
    }
    if (suffix == "exr") return encode_exr(image, options);
    if (suffix == "hdr") return encode_hdr(image);
    if (suffix == "pfm") return encode_pfm(image);
    unknown_suffix(suffix, {});
}

void write_image(const std::filesystem::path& path, const Image& image,
                 const ImageWriteOptions& options) {
    check_image_suffix(path);
    write_file_atomically(path, encode_image(suffix_of(path), image, options));
}

void write_png(const std::filesystem::path& path, const EncodedImage& image,
               const ImageMetadata& metadata) {
    write_file_atomically(path, encode_png(image, metadata));
}

}  // namespace alhazen
