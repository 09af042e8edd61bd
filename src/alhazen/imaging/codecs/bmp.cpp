#include "alhazen/imaging/codecs/bmp.h"

#include <array>
#include <bit>
#include <utility>

#include "alhazen/imaging/codecs/byte_reader.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kFileHeaderBytes = 14, kCoreHeaderBytes = 12, kInfoHeaderBytes = 40;
constexpr std::uint32_t kUncompressed = 0, kRuns8 = 1, kRuns4 = 2, kBitFields = 3,
                        kAlphaBitFields = 6;

struct Header {
    std::int64_t width = 0, height = 0;
    bool top_down = false;
    unsigned bits = 0;
    std::uint32_t compression = 0;
    std::uint32_t palette_entries = 0;
    unsigned palette_entry_bytes = 4;
    std::array<std::uint32_t, 4> masks{};  ///< red, green, blue, alpha
    std::uint32_t pixels_at = 0;
};

bool has_runs(const Header& header) {
    return header.compression == kRuns8 || header.compression == kRuns4;
}

using Palette = std::vector<std::array<std::uint8_t, 3>>;
using Codes = std::vector<std::uint8_t>;

void read_masks(ByteReader& reader, Header& header, std::uint32_t header_bytes) {
    if (has_runs(header)) return;
    if (header.compression == kUncompressed) {
        if (header.bits == 16) header.masks = {0x7c00, 0x03e0, 0x001f, 0};
        if (header.bits == 32) header.masks = {0xff0000, 0xff00, 0xff, 0};
        return;
    }
    // The masks follow the fields of the small header and are the next fields of the large ones.
    const bool has_alpha = header_bytes >= 56 || header.compression == kAlphaBitFields;
    for (std::size_t i = 0; i < (has_alpha ? 4u : 3u); ++i) header.masks[i] = reader.u32_little();
    if (header.bits != 16 && header.bits != 32) {
        bad_image(reader.name(), "damaged BMP: colour masks need 16 or 32 bits");
    }
    for (const std::uint32_t mask : header.masks) {
        const std::uint32_t low = mask == 0 ? 0 : mask >> std::countr_zero(mask);
        if ((low & (low + 1)) != 0) bad_image(reader.name(), "damaged BMP: a mask has gaps");
    }
}

void read_core_header(ByteReader& reader, Header& header) {
    header.width = reader.u16_little();
    header.height = reader.u16_little();
    (void)reader.u16_little();
    header.bits = reader.u16_little();
    header.palette_entry_bytes = 3;
}

void read_info_header(ByteReader& reader, Header& header) {
    header.width = reader.i32_little();
    header.height = reader.i32_little();
    header.top_down = header.height < 0;
    if (header.top_down) header.height = -header.height;
    (void)reader.u16_little();
    header.bits = reader.u16_little();
    header.compression = reader.u32_little();
    (void)reader.take(12);
    header.palette_entries = reader.u32_little();
    (void)reader.u32_little();
}

void check_kind(const Header& header, const std::string& name) {
    if (has_runs(header)) {
        if (header.bits != (header.compression == kRuns8 ? 8 : 4) || header.top_down) {
            bad_image(name, "damaged BMP: run-length codes need 8 or 4 bits and rows that go up");
        }
        return;
    }
    if (header.compression != kUncompressed && header.compression != kBitFields &&
        header.compression != kAlphaBitFields) {
        bad_image(name, "BMP of an unknown compression " + std::to_string(header.compression));
    }
    switch (header.bits) {
        case 1:
        case 4:
        case 8:
        case 16:
        case 24:
        case 32:
            return;
        default:
            bad_image(name, "BMP of " + std::to_string(header.bits) +
                                " bits, expected 1, 4, 8, 16, 24 or 32");
    }
}

Header read_header(ByteReader& reader, const ImageLimits& limits) {
    Header header;
    reader.seek(10);
    header.pixels_at = reader.u32_little();
    const std::uint32_t header_bytes = reader.u32_little();
    if (header_bytes == kCoreHeaderBytes) {
        read_core_header(reader, header);
    } else if (header_bytes >= kInfoHeaderBytes && header_bytes <= 256) {
        read_info_header(reader, header);
    } else {
        bad_image(reader.name(),
                  "BMP with an unknown header of " + std::to_string(header_bytes) + " bytes");
    }
    check_kind(header, reader.name());
    check_image_size(header.width, header.height, limits, reader.name());
    read_masks(reader, header, header_bytes);
    // In the small header the masks lie between the header and the palette.
    if (reader.position() < kFileHeaderBytes + header_bytes) {
        reader.seek(kFileHeaderBytes + header_bytes);
    }
    return header;
}

Palette read_palette(ByteReader& reader, const Header& header) {
    if (header.bits > 8) return {};
    const std::uint32_t all = 1u << header.bits;
    std::uint32_t entries = header.palette_entries;
    if (entries == 0 || entries > all) entries = all;
    // Some writers declare all palette entries and store fewer.
    const std::size_t start = reader.position();
    if (header.pixels_at > start) {
        const auto room = (header.pixels_at - start) / header.palette_entry_bytes;
        entries = std::uint32_t(std::min<std::size_t>(entries, room));
    }
    Palette palette(entries);
    for (auto& colour : palette) {
        const std::string_view bytes = reader.take(header.palette_entry_bytes);
        for (std::size_t i = 0; i < 3; ++i) {
            colour[i] = std::uint8_t(bytes[2 - i]);
        }
    }
    return palette;
}

/// Decodes the palette indices of a run-length coded bitmap: one byte each, bottom row first.
class RunReader {
  public:
    RunReader(ByteReader& reader, const Header& header)
        : reader_(reader),
          width_(std::size_t(header.width)),
          height_(std::size_t(header.height)),
          half_bytes_(header.compression == kRuns4),
          indices_(width_ * height_, '\0') {}

    std::string read() {
        while (y_ < height_) {
            const std::size_t count = reader_.u8(), code = reader_.u8();
            if (count != 0) {
                const char same[] = {char(code)};
                for (std::size_t i = 0; i < count; ++i) {
                    put(index_in({same, 1}, half_bytes_ ? i % 2 : 0));
                }
            } else if (code == kEndOfBitmap) {
                break;
            } else if (code == kEndOfLine) {
                x_ = 0;
                ++y_;
            } else if (code == kMove) {
                x_ += reader_.u8();
                y_ += reader_.u8();
            } else {
                const std::string_view literal =
                    reader_.take(half_bytes_ ? (code + 3) / 4 * 2 : (code + 1) / 2 * 2);
                for (std::size_t i = 0; i < code; ++i) put(index_in(literal, i));
            }
        }
        return std::move(indices_);
    }

  private:
    static constexpr std::size_t kEndOfLine = 0, kEndOfBitmap = 1, kMove = 2;
    /// Indices beyond a row that are dropped: some writers code rows of whole groups of four.
    static constexpr std::size_t kPadding = 3;

    /// Index `i` of a run of codes.
    [[nodiscard]] char index_in(std::string_view codes, std::size_t i) const {
        if (!half_bytes_) return codes[i];
        const auto both = std::uint8_t(codes[i / 2]);
        return char(i % 2 == 0 ? both >> 4 : both & 15);
    }
    void put(char index) {
        if (x_ >= width_ + kPadding) bad_image(reader_.name(), "damaged BMP: a run leaves its row");
        if (x_ < width_) indices_[y_ * width_ + x_] = index;
        ++x_;
    }

    ByteReader& reader_;
    std::size_t width_, height_, x_ = 0, y_ = 0;
    bool half_bytes_;
    std::string indices_;
};

void append_palette_row(Codes& codes, std::string_view row, const Header& header,
                        const Palette& palette, const std::string& name) {
    const unsigned per_byte = 8 / header.bits, mask = (1u << header.bits) - 1;
    for (unsigned x = 0; x < unsigned(header.width); ++x) {
        const unsigned shift = 8 - header.bits * (x % per_byte + 1);
        const unsigned index = (unsigned(std::uint8_t(row[x / per_byte])) >> shift) & mask;
        if (index >= palette.size()) {
            bad_image(name, "damaged BMP: palette index " + std::to_string(index) + " of " +
                                std::to_string(palette.size()) + " entries");
        }
        codes.insert(codes.end(), palette[index].begin(), palette[index].end());
    }
}

void append_masked_row(Image& image, std::string_view row, const Header& header) {
    const std::size_t pixel_bytes = header.bits / 8;
    for (std::size_t x = 0; x < std::size_t(image.width); ++x) {
        std::uint32_t pixel = 0;
        for (std::size_t i = 0; i < pixel_bytes; ++i) {
            pixel |= std::uint32_t{std::uint8_t(row[x * pixel_bytes + i])} << (8 * i);
        }
        for (std::size_t i = 0; i < std::size_t(image.channels); ++i) {
            const std::uint32_t mask = header.masks[i];
            const int shift = mask == 0 ? 0 : std::countr_zero(mask);
            const auto max = double(mask >> shift);
            image.samples.push_back(mask == 0 ? 0.0f
                                              : float(double((pixel & mask) >> shift) / max));
        }
    }
}

void append_bgr_row(Codes& codes, std::string_view row, std::int64_t width) {
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
        for (std::size_t i = 0; i < 3; ++i) codes.push_back(std::uint8_t(row[3 * x + 2 - i]));
    }
}

}  // namespace

StoredImage decode_bmp(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    ByteReader reader(bytes, name);
    Header header = read_header(reader, limits);
    const Palette palette = read_palette(reader, header);
    std::uint64_t row_bytes = (std::uint64_t(header.width) * header.bits + 31) / 32 * 4;
    reader.seek(header.pixels_at);
    std::string indices;
    std::string_view rows;
    if (has_runs(header)) {
        check_image_memory(sample_bytes(header.width, header.height, 3 + 1, 1), limits, name);
        indices = RunReader(reader, header).read();
        header.bits = 8;
        row_bytes = std::uint64_t(header.width);
        rows = indices;
    } else {
        rows = reader.take(row_bytes * std::uint64_t(header.height));
    }
    const bool masked = header.bits == 16 || header.bits == 32;
    const int channels = header.masks[3] != 0 ? 4 : 3;
    // Masked channels may have any number of bits, which requires floats.
    Image floats;
    Codes codes;
    if (masked) {
        // The codes from which the floats are made, at most 16 bits each, are in memory too.
        const auto all_channels = std::uint64_t(channels);
        check_image_memory(sample_bytes(header.width, header.height, all_channels, 4 + 2), limits,
                           name);
        floats =
            reserved_image(int(header.width), int(header.height), channels, false, limits, name);
    } else {
        check_image_memory(sample_bytes(header.width, header.height, 3, 1), limits, name);
        codes.reserve(std::size_t(header.width) * std::size_t(header.height) * 3);
    }
    for (std::int64_t y = 0; y < header.height; ++y) {
        const std::int64_t in_file = header.top_down ? y : header.height - 1 - y;
        const std::string_view row = rows.substr(std::size_t(in_file) * row_bytes, row_bytes);
        if (masked) {
            append_masked_row(floats, row, header);
        } else if (header.bits == 24) {
            append_bgr_row(codes, row, header.width);
        } else {
            append_palette_row(codes, row, header, palette, name);
        }
    }
    if (masked) return stored(std::move(floats));
    return {int(header.width), int(header.height), 3, false, std::move(codes)};
}

}  // namespace alhazen
