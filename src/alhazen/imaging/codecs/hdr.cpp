#include "alhazen/imaging/codecs/hdr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "alhazen/imaging/codecs/byte_reader.h"

namespace alhazen {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Range of row widths that can be coded channel by channel.
constexpr int kMinPackedWidth = 8, kMaxPackedWidth = 0x7fff;

struct Size {
    std::int64_t width = 0, height = 0;
};

bool take_number(std::string_view& text, std::int64_t& value) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    text.remove_prefix(std::size_t(end - text.data()));
    return error == std::errc();
}

Size read_size(std::string_view line, const std::string& name) {
    const std::string shown(line.substr(0, 80));
    Size size;
    bool good = line.starts_with("-Y ");
    if (good) line.remove_prefix(3);
    good = good && take_number(line, size.height) && line.starts_with(" +X ");
    if (good) line.remove_prefix(4);
    good = good && take_number(line, size.width) && line.find_first_not_of(" \r") == line.npos;
    if (!good) bad_image(name, "expected \"-Y height +X width\", found \"" + shown + "\"");
    return size;
}

Size read_header(ByteReader& reader) {
    constexpr std::size_t kMaxLine = 4096;
    constexpr int kMaxLines = 1000;
    for (int i = 0; i < kMaxLines; ++i) {
        std::string_view line = reader.until('\n', kMaxLine);
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.empty()) return read_size(reader.until('\n', kMaxLine), reader.name());
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe") {
            bad_image(reader.name(), "HDR of an unknown format, expected 32-bit_rle_rgbe");
        }
    }
    bad_image(reader.name(), "damaged HDR: the header is too long");
}

/// Reads the channels of a row one after another, each in runs (count > 128) and literals.
void read_packed_row(ByteReader& reader, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
        std::size_t x = 0;
        while (x < row.size()) {
            std::size_t count = reader.u8();
            const bool run = count > 128;
            if (run) count -= 128;
            if (count == 0 || count > row.size() - x) {
                bad_image(reader.name(), "damaged HDR: a run leaves its row");
            }
            const std::string_view values = reader.take(run ? 1 : count);
            for (std::size_t i = 0; i < count; ++i) {
                row[x++][channel] = std::uint8_t(values[run ? 0 : i]);
            }
        }
    }
}

/// Reads whole pixels; 1 1 1 n repeats the previous one n times, and the counts of consecutive
/// repeats are digits in base 256.
void read_plain_row(ByteReader& reader, std::vector<Rgbe>& row) {
    std::size_t x = 0;
    unsigned shift = 0;
    while (x < row.size()) {
        const std::string_view bytes = reader.take(4);
        Rgbe pixel{};
        std::copy(bytes.begin(), bytes.end(), pixel.begin());
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            row[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::size_t count = shift < 32 ? std::size_t{pixel[3]} << shift : 0;
        if (x == 0 || shift > 24 || count > row.size() - x) {
            bad_image(reader.name(), "damaged HDR: a run leaves its row");
        }
        std::fill_n(row.begin() + std::ptrdiff_t(x), count, row[x - 1]);
        x += count;
        shift += 8;
    }
}

void read_row(ByteReader& reader, std::vector<Rgbe>& row) {
    const std::size_t start = reader.position();
    const std::string_view first = reader.take(4);
    const auto byte = [&](std::size_t i) { return std::uint8_t(first[i]); };
    const bool packed = row.size() >= kMinPackedWidth && row.size() <= kMaxPackedWidth &&
                        byte(0) == 2 && byte(1) == 2 && byte(2) < 128;
    if (!packed) {
        reader.seek(start);
        read_plain_row(reader, row);
        return;
    }
    if (std::size_t{byte(2)} * 256 + byte(3) != row.size()) {
        bad_image(reader.name(), "damaged HDR: the length of a row does not fit the width");
    }
    read_packed_row(reader, row);
}

Rgbe rgbe_of(const Rgb& colour) {
    std::array<double, 3> values{colour.r, colour.g, colour.b};
    constexpr double kLargest = 0x1.fep126;  // mantissa 255, exponent 255 - 128
    for (double& value : values) value = value > 0 ? std::min(value, kLargest) : 0.0;  // NaN: 0
    const double largest = std::max({values[0], values[1], values[2]});
    int exponent = 0;
    (void)std::frexp(largest, &exponent);
    if (largest == 0 || exponent < -127) return {};
    // A largest channel that rounds up to 256 takes the next exponent.
    if (std::round(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
    Rgbe pixel{};
    for (std::size_t i = 0; i < 3; ++i) {
        pixel[i] = std::uint8_t(std::round(std::ldexp(values[i], 8 - exponent)));
    }
    pixel[3] = std::uint8_t(exponent + 128);
    return pixel;
}

/// Codes runs of at least 4; shorter runs become part of the literals around them.
void pack_channel(const std::vector<Rgbe>& row, std::size_t channel, std::vector<std::byte>& out) {
    const auto run_at = [&](std::size_t x) {
        std::size_t end = x + 1;
        while (end < row.size() && end - x < 127 && row[end][channel] == row[x][channel]) ++end;
        return end - x;
    };
    constexpr std::size_t kMinRun = 4;
    std::size_t x = 0;
    while (x < row.size()) {
        if (const std::size_t run = run_at(x); run >= kMinRun) {
            out.push_back(std::byte(128 + run));
            out.push_back(std::byte(row[x][channel]));
            x += run;
            continue;
        }
        std::size_t end = x + 1;
        while (end < row.size() && end - x < 128 && run_at(end) < kMinRun) ++end;
        out.push_back(std::byte(end - x));
        for (; x < end; ++x) out.push_back(std::byte(row[x][channel]));
    }
}

void append(std::vector<std::byte>& out, const std::string& text) {
    for (const char c : text) out.push_back(std::byte(c));
}

}  // namespace

Image decode_hdr(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    ByteReader reader(bytes, name);
    const Size size = read_header(reader);
    check_image_size(size.width, size.height, limits, name);
    Image image = reserved_image(int(size.width), int(size.height), 3, true, limits, name);
    std::vector<Rgbe> row(std::size_t(size.width));
    for (std::int64_t y = 0; y < size.height; ++y) {
        read_row(reader, row);
        for (const Rgbe& pixel : row) {
            const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, int(pixel[3]) - 136);
            for (std::size_t i = 0; i < 3; ++i) image.samples.push_back(float(pixel[i]) * scale);
        }
    }
    return image;
}

std::vector<std::byte> encode_hdr(const Image& image) {
    std::vector<std::byte> out;
    append(out, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(image.height) +
                    " +X " + std::to_string(image.width) + "\n");
    const bool packed = image.width >= kMinPackedWidth && image.width <= kMaxPackedWidth;
    std::vector<Rgbe> row(std::size_t(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) row[std::size_t(x)] = rgbe_of(image.rgb(x, y));
        if (!packed) {
            for (const Rgbe& pixel : row) {
                for (const std::uint8_t value : pixel) out.push_back(std::byte(value));
            }
            continue;
        }
        for (const int value : {2, 2, image.width >> 8, image.width & 255}) {
            out.push_back(std::byte(value));
        }
        for (std::size_t channel = 0; channel < 4; ++channel) pack_channel(row, channel, out);
    }
    return out;
}

}  // namespace alhazen
