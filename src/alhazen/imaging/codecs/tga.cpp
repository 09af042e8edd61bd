#include "alhazen/imaging/codecs/tga.h"

#include <algorithm>
#include <array>

#include "alhazen/imaging/codecs/byte_reader.h"

namespace alhazen {

namespace {

constexpr std::size_t kHeaderBytes = 18, kFooterBytes = 26;
constexpr std::string_view kSignature{"TRUEVISION-XFILE.\0", 18};

struct TgaHeader {
    unsigned id_length = 0, map_kind = 0, kind = 0;
    std::uint64_t map_first = 0, map_length = 0;
    unsigned map_bits = 0;
    std::int64_t width = 0, height = 0;
    unsigned bits = 0, descriptor = 0;

    [[nodiscard]] bool run_length() const { return kind >= 8; }
    /// 1 palette, 2 colour, 3 grey.
    [[nodiscard]] unsigned model() const { return kind & 7u; }
    [[nodiscard]] unsigned alpha_bits() const { return descriptor & 15u; }
    [[nodiscard]] bool from_right() const { return (descriptor & 16u) != 0; }
    [[nodiscard]] bool from_top() const { return (descriptor & 32u) != 0; }
    [[nodiscard]] std::uint64_t pixels() const {
        return std::uint64_t(width) * std::uint64_t(height);
    }
};

constexpr unsigned bytes_of(unsigned bits) {
    return (bits + 7) / 8;
}

TgaHeader read_tga_header(ByteReader& reader) {
    TgaHeader h;
    h.id_length = reader.u8();
    h.map_kind = reader.u8();
    h.kind = reader.u8();
    h.map_first = reader.u16_little();
    h.map_length = reader.u16_little();
    h.map_bits = reader.u8();
    (void)reader.take(4);
    h.width = reader.u16_little();
    h.height = reader.u16_little();
    h.bits = reader.u8();
    h.descriptor = reader.u8();
    return h;
}

bool is_color_size(unsigned bits) {
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

/// The reason why the header is not supported, or null.
const char* fault_of(const TgaHeader& h) {
    if (h.model() < 1 || h.model() > 3 || (h.kind & ~11u) != 0) return "an unknown kind of picture";
    if (h.map_kind > 1) return "an unknown kind of palette";
    if ((h.descriptor & 0xC0u) != 0) return "interleaved rows";
    if (h.model() == 1) {
        if (h.map_kind != 1 || h.map_length == 0) return "no palette";
        if (!is_color_size(h.map_bits)) return "a palette of unknown depth";
        if (h.bits != 8 && h.bits != 16) return "palette indices that are not of 8 or 16 bits";
        return nullptr;
    }
    if (h.map_kind == 1 && !is_color_size(h.map_bits)) return "a palette of unknown depth";
    if (h.model() == 2 && !is_color_size(h.bits))
        return "a depth that is not 15, 16, 24 or 32 bits";
    if (h.model() == 3 && h.bits != 8 && h.bits != 16) return "a depth that is not 8 or 16 bits";
    return nullptr;
}

std::uint64_t bytes_before_pixels(const TgaHeader& h) {
    return kHeaderBytes + h.id_length + (h.map_kind == 1 ? h.map_length * bytes_of(h.map_bits) : 0);
}

/// A lower bound of the bytes of all pixels: a run of 128 pixels takes at least one byte and one
/// pixel.
std::uint64_t least_pixel_bytes(const TgaHeader& h) {
    const std::uint64_t each = bytes_of(h.bits);
    return h.run_length() ? (h.pixels() + 127) / 128 * (1 + each) : h.pixels() * each;
}

/// False if the extension area of a version 2 file says that attribute bits are not alpha.
bool alpha_is_meant(std::string_view bytes) {
    if (bytes.size() < kHeaderBytes + kFooterBytes || !bytes.ends_with(kSignature)) return true;
    const std::string name;
    ByteReader reader(bytes, name);
    reader.seek(bytes.size() - kFooterBytes);
    const std::uint64_t extension = reader.u32_little();
    constexpr std::uint64_t kAttributesAt = 494;
    if (extension == 0 || extension + kAttributesAt >= bytes.size()) return true;
    reader.seek(extension);
    if (reader.u16_little() <= kAttributesAt) return true;
    reader.seek(extension + kAttributesAt);
    return reader.u8() >= 3;
}

using Color = std::array<std::uint8_t, 4>;

/// The colour of a pixel, which the file stores blue first.
Color color_of(std::string_view p, unsigned bits) {
    const auto byte = [&](std::size_t i) { return std::uint8_t(p[i]); };
    if (bits <= 16) {
        const unsigned v = unsigned(byte(0)) | unsigned(byte(1)) << 8;
        const auto widened = [&](unsigned shift) {
            return std::uint8_t(((v >> shift & 31u) * 255u * 2u + 31u) / 62u);
        };
        return {widened(10), widened(5), widened(0), std::uint8_t((v >> 15) * 255u)};
    }
    return {byte(2), byte(1), byte(0), bits == 32 ? byte(3) : std::uint8_t{255}};
}

/// Converts the pixels of a file to samples, row by row in the file's order.
class PixelReader {
  public:
    PixelReader(ByteReader& reader, const TgaHeader& header, std::vector<Color> palette)
        : reader_(reader), header_(header), palette_(std::move(palette)) {}

    Color next() {
        if (!header_.run_length()) return decoded(reader_.take(bytes_of(header_.bits)));
        if (left_in_packet_ == 0) {
            const unsigned start = reader_.u8();
            left_in_packet_ = (start & 127u) + 1;
            repeats_ = (start & 128u) != 0;
            if (repeats_) repeated_ = decoded(reader_.take(bytes_of(header_.bits)));
        }
        --left_in_packet_;
        return repeats_ ? repeated_ : decoded(reader_.take(bytes_of(header_.bits)));
    }

  private:
    Color decoded(std::string_view p) const {
        const auto byte = [&](std::size_t i) { return std::uint8_t(p[i]); };
        if (header_.model() == 3) {
            return {byte(0), byte(0), byte(0), p.size() == 2 ? byte(1) : std::uint8_t{255}};
        }
        if (header_.model() == 2) return color_of(p, header_.bits);
        const std::uint64_t index = byte(0) | (p.size() == 2 ? std::uint64_t{byte(1)} << 8 : 0);
        if (index < header_.map_first || index - header_.map_first >= palette_.size()) {
            bad_image(reader_.name(), "damaged TGA: palette index " + std::to_string(index) +
                                          " of " + std::to_string(palette_.size()) + " entries");
        }
        return palette_[index - header_.map_first];
    }

    ByteReader& reader_;
    const TgaHeader& header_;
    std::vector<Color> palette_;
    unsigned left_in_packet_ = 0;
    bool repeats_ = false;
    Color repeated_{};
};

int channels_of(const TgaHeader& h, bool alpha_meant) {
    if (h.model() == 3) return h.bits == 16 && alpha_meant ? 2 : 1;
    const unsigned color_bits = h.model() == 1 ? h.map_bits : h.bits;
    const bool has_room = color_bits == 32 || color_bits == 16;
    return has_room && alpha_meant && h.alpha_bits() > 0 ? 4 : 3;
}

}  // namespace

bool is_plausible_tga(std::string_view bytes) {
    if (bytes.size() < kHeaderBytes) return false;
    const std::string name;
    ByteReader reader(bytes, name);
    const TgaHeader h = read_tga_header(reader);
    return fault_of(h) == nullptr && h.width > 0 && h.height > 0 && h.alpha_bits() <= 8 &&
           bytes_before_pixels(h) + least_pixel_bytes(h) <= bytes.size();
}

StoredImage decode_tga(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    ByteReader reader(bytes, name);
    const TgaHeader h = read_tga_header(reader);
    if (const char* fault = fault_of(h)) bad_image(name, std::string("TGA with ") + fault);
    check_image_size(h.width, h.height, limits, name);
    (void)reader.take(h.id_length);
    std::vector<Color> palette;
    if (h.map_kind == 1) {
        for (std::uint64_t i = 0; i < h.map_length; ++i) {
            palette.push_back(color_of(reader.take(bytes_of(h.map_bits)), h.map_bits));
        }
    }
    if (least_pixel_bytes(h) > reader.left()) reader.ends_early();

    StoredImage image{
        int(h.width), int(h.height), channels_of(h, alpha_is_meant(bytes)), false, {}};
    const auto channels = std::size_t(image.channels);
    const auto width = std::size_t(h.width), height = std::size_t(h.height);
    check_image_memory(width * height * channels, limits, name);
    std::vector<std::uint8_t> samples(width * height * channels);
    PixelReader pixels(reader, h, std::move(palette));
    for (std::size_t j = 0; j < height; ++j) {
        const std::size_t y = h.from_top() ? j : height - 1 - j;
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t x = h.from_right() ? width - 1 - i : i;
            const Color c = pixels.next();
            std::uint8_t* out = samples.data() + (y * width + x) * channels;
            if (channels >= 3) {
                std::copy_n(c.begin(), channels, out);
            } else {
                out[0] = c[0];
                if (channels == 2) out[1] = c[3];
            }
        }
    }
    image.samples = std::move(samples);
    return image;
}

}  // namespace alhazen
