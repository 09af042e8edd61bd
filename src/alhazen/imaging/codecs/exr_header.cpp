#include "alhazen/imaging/codecs/exr_header.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "alhazen/imaging/codecs/byte_reader.h"

namespace alhazen {

namespace {

constexpr std::uint32_t kTiledFlag = 0x200, kLongNamesFlag = 0x400, kDeepFlag = 0x800,
                        kMultiPartFlag = 0x1000;
constexpr std::uint32_t kKnownFlags = kTiledFlag | kLongNamesFlag | kDeepFlag | kMultiPartFlag;
constexpr std::size_t kMaxName = 255;
constexpr int kMaxParts = 1000;
constexpr int kMaxAttributes = 10'000;
constexpr std::uint32_t kMaxTileSide = 4096;
/// Limit of width times channels: the library decodes up to 256 rows at a time, with 4 bytes per
/// sample. Also bounds the products in `decoder_bytes`: 2^12 * 2^12 * 2^18 * 2^4 < 2^63.
constexpr std::uint64_t kMaxRowSamples = std::uint64_t{1} << 18;

struct PartHeader {
    std::int64_t width = 0, height = 0;
    ExrWindow data;
    std::optional<ExrWindow> display;
    std::uint64_t channels = 0;
    bool has_window = false;
    std::uint8_t compression = 0;
    std::uint64_t tile_width = 0, tile_height = 0;  ///< 0: scan lines
    bool deep = false;
};

/// [compression] Number of rows that are compressed together.
std::uint64_t rows_together(std::uint8_t compression) {
    constexpr std::array<std::uint8_t, 9> kRows{1, 1, 1, 16, 32, 16, 32, 32, 32};
    return compression < kRows.size() ? kRows[compression] : 256;
}

/// Precondition: width times channels is at most kMaxRowSamples.
std::uint64_t decoder_bytes(const PartHeader& part) {
    constexpr std::uint64_t kSampleBytes = 4, kCopies = 4;
    const auto width = std::uint64_t(part.width), height = std::uint64_t(part.height);
    if (part.tile_width == 0) {
        const std::uint64_t rows = std::min(rows_together(part.compression), height);
        return width * part.channels * rows * kSampleBytes * kCopies;
    }
    const std::uint64_t kept = std::min<std::uint64_t>(part.channels, 4);
    return part.tile_width * part.tile_height * part.channels * kSampleBytes * kCopies +
           width * part.tile_height * kept * kSampleBytes;
}

std::uint64_t count_channels(ByteReader list) {
    std::uint64_t count = 0;
    while (!list.until('\0', kMaxName).empty()) {
        (void)list.take(16);  // pixel type, pLinear, reserved, xSampling, ySampling
        ++count;
    }
    if (list.left() != 0) bad_image(list.name(), "damaged EXR: the list of channels is too long");
    return count;
}

ExrWindow read_window(ByteReader value, const char* which) {
    ExrWindow window;
    window.x0 = value.i32_little(), window.y0 = value.i32_little();
    window.x1 = value.i32_little(), window.y1 = value.i32_little();
    // The library computes the corners in int.
    constexpr std::int64_t kFar = std::int64_t{1} << 29;
    if (window.x0 < -kFar || window.y0 < -kFar || window.x1 > kFar || window.y1 > kFar) {
        bad_image(value.name(), std::string("damaged EXR: the ") + which + " is out of range");
    }
    return window;
}

void read_tiles(ByteReader value, PartHeader& part) {
    const std::uint32_t width = value.u32_little(), height = value.u32_little();
    if (width < 1 || height < 1 || width > kMaxTileSide || height > kMaxTileSide) {
        bad_image(value.name(), "EXR tiles of " + std::to_string(width) + " x " +
                                    std::to_string(height) + " pixels, expected sides of 1 to " +
                                    std::to_string(kMaxTileSide));
    }
    part.tile_width = width;
    part.tile_height = height;
}

/// An attribute that the library needs, and the number of bytes of its value (0: any).
struct Needed {
    std::string_view name, type;
    std::uint32_t bytes;
};
constexpr std::array<Needed, 13> kNeeded{{{"channels", "chlist", 0},
                                          {"chunkCount", "int", 4},
                                          {"compression", "compression", 1},
                                          {"dataWindow", "box2i", 16},
                                          {"displayWindow", "box2i", 16},
                                          {"lineOrder", "lineOrder", 1},
                                          {"name", "string", 0},
                                          {"pixelAspectRatio", "float", 4},
                                          {"screenWindowCenter", "v2f", 8},
                                          {"screenWindowWidth", "float", 4},
                                          {"tiles", "tiledesc", 9},
                                          {"type", "string", 0},
                                          {"version", "int", 4}}};

/// True if decoding needs the attribute. The library reads a value by its type and ignores the
/// stored size.
bool is_needed(std::string_view attribute, std::string_view type, std::uint32_t size,
               const std::string& name) {
    for (const Needed& needed : kNeeded) {
        if (attribute != needed.name) continue;
        if (type != needed.type || (needed.bytes != 0 && size != needed.bytes)) {
            bad_image(name, "damaged EXR: the attribute " + std::string(attribute) +
                                " has a wrong type or size");
        }
        return true;
    }
    return false;
}

void read_value(std::string_view attribute, ByteReader value, PartHeader& part) {
    if (attribute == "dataWindow") {
        part.data = read_window(value, "data window");
        part.width = part.data.width();
        part.height = part.data.height();
        part.has_window = true;
    } else if (attribute == "displayWindow") {
        part.display = read_window(value, "display window");
    } else if (attribute == "channels") {
        part.channels = count_channels(value);
    } else if (attribute == "tiles") {
        read_tiles(value, part);
    } else if (attribute == "compression") {
        part.compression = value.u8();
    } else if (attribute == "type") {
        part.deep = value.take(value.left()).starts_with("deep");
    }
}

/// Reads one attribute; in the copy, replaces the type of an attribute that is not needed by an
/// unknown one.
void read_attribute(std::string_view attribute, ByteReader& reader,
                    std::vector<std::string_view>& ignored, PartHeader& part) {
    const std::string& name = reader.name();
    const std::string_view type = reader.until('\0', kMaxName);
    const std::uint32_t size = reader.u32_little();
    const std::string_view value = reader.take(size);
    if (is_needed(attribute, type, size, name)) {
        read_value(attribute, ByteReader(value, name), part);
    } else {
        ignored.push_back(type);
    }
}

/// Reads a part; false at the empty header that ends the list of parts.
bool read_part(ByteReader& reader, std::vector<std::string_view>& ignored,
               const ImageLimits& limits, PartHeader& part) {
    const std::string& name = reader.name();
    for (int i = 0;; ++i) {
        const std::string_view attribute = reader.until('\0', kMaxName);
        if (attribute.empty() && i == 0) return false;
        if (attribute.empty()) break;
        if (i == kMaxAttributes) bad_image(name, "damaged EXR: too many attributes");
        read_attribute(attribute, reader, ignored, part);
    }
    if (!part.has_window) bad_image(name, "damaged EXR: there is no dataWindow");
    check_image_size(part.width, part.height, limits, name);
    if (part.display) {
        check_image_size(part.display->width(), part.display->height(), limits, name);
    }
    if (part.channels == 0) bad_image(name, "damaged EXR: there are no channels");
    if (part.channels > kMaxRowSamples / std::uint64_t(part.width)) {
        throw Error(ErrorKind::Resource,
                    "the picture is too large: rows of " + std::to_string(part.width) + " x " +
                        std::to_string(part.channels) + " samples",
                    {name, 0, 0});
    }
    return true;
}

}  // namespace

ExrHeader checked_exr_header(std::string_view bytes, const std::string& name,
                             const ImageLimits& limits) {
    ByteReader reader(bytes, name);
    (void)reader.u32_little();
    const std::uint32_t version = reader.u32_little();
    if ((version & 0xff) != 2 || (version & ~(kKnownFlags | 0xffu)) != 0) {
        bad_image(name, "EXR of an unknown version or kind");
    }
    std::vector<std::string_view> ignored;
    std::vector<ExrPart> parts;
    for (PartHeader part; read_part(reader, ignored, limits, part); part = {}) {
        parts.push_back({part.display.value_or(part.data), decoder_bytes(part), part.deep});
        check_image_memory(parts.back().decoder_bytes, limits, name);
        if ((version & kMultiPartFlag) == 0) break;
        if (parts.size() > kMaxParts) bad_image(name, "damaged EXR: too many parts");
    }
    if (parts.empty()) bad_image(name, "damaged EXR: the header is empty");
    // A single part is deep by the flag, too.
    const bool deep_flag = (version & (kDeepFlag | kMultiPartFlag)) == kDeepFlag;
    if (deep_flag || std::all_of(parts.begin(), parts.end(), [](auto& p) { return p.deep; })) {
        bad_image(name, "deep EXR pictures are not supported");
    }
    std::string header(bytes.substr(0, reader.position()));
    for (const std::string_view type : ignored) {
        header.replace(std::size_t(type.data() - bytes.data()), type.size(), type.size(), '?');
    }
    return {std::move(header), std::move(parts)};
}

}  // namespace alhazen
