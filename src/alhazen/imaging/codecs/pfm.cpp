#include "alhazen/imaging/codecs/pfm.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

#include "alhazen/imaging/codecs/byte_reader.h"

namespace alhazen {

namespace {

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The next word of the header; also skips the single white space after it.
std::string_view take_word(ByteReader& reader) {
    constexpr std::size_t kMaxWord = 64;
    char c = reader.take(1)[0];
    for (std::size_t i = 0; is_space(c) && i < kMaxWord; ++i) c = reader.take(1)[0];
    const std::size_t start = reader.position() - 1;
    while (!is_space(c)) {
        if (reader.position() - start > kMaxWord) break;
        c = reader.take(1)[0];
    }
    const std::size_t end = reader.position() - 1;
    reader.seek(start);
    const std::string_view word = reader.take(end - start);
    reader.seek(end + 1);
    return word;
}

template <class Number>
Number take_number(ByteReader& reader, const char* what) {
    const std::string_view word = take_word(reader);
    Number number{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
        bad_image(reader.name(),
                  std::string("damaged PFM: the ") + what + " is \"" + std::string(word) + "\"");
    }
    return number;
}

void append_floats(Image& image, std::string_view row, bool little, float scale) {
    for (std::size_t i = 0; i + 4 <= row.size(); i += 4) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            bits |= std::uint32_t{std::uint8_t(row[i + (little ? k : 3 - k)])} << (8 * k);
        }
        const float value = std::bit_cast<float>(bits);
        image.samples.push_back(scale == 1.0f ? value : value * scale);
    }
}

}  // namespace

Image decode_pfm(std::string_view bytes, const std::string& name, const ImageLimits& limits) {
    ByteReader reader(bytes, name);
    const int channels = reader.take(2) == "PF" ? 3 : 1;
    const auto width = take_number<std::int64_t>(reader, "width");
    const auto height = take_number<std::int64_t>(reader, "height");
    const double scale = take_number<double>(reader, "scale");
    check_image_size(width, height, limits, name);
    if (!std::isfinite(scale) || scale == 0) {
        bad_image(name, "damaged PFM: the scale is zero or not finite");
    }
    const std::uint64_t row_bytes = std::uint64_t(width) * std::uint64_t(channels) * 4;
    const std::string_view rows = reader.take(row_bytes * std::uint64_t(height));
    Image image = reserved_image(int(width), int(height), channels, true, limits, name);
    for (std::int64_t y = height - 1; y >= 0; --y) {
        append_floats(image, rows.substr(std::size_t(y) * row_bytes, row_bytes), scale < 0,
                      float(std::abs(scale)));
    }
    return image;
}

std::vector<std::byte> encode_pfm(const Image& image) {
    const int channels = image.channels < 3 ? 1 : 3;
    const std::string header = std::string(channels == 3 ? "PF" : "Pf") + "\n" +
                               std::to_string(image.width) + " " + std::to_string(image.height) +
                               "\n-1.0\n";
    std::vector<std::byte> out;
    out.reserve(header.size() +
                std::size_t(image.width) * std::size_t(image.height) * std::size_t(channels) * 4);
    for (const char c : header) out.push_back(std::byte(c));
    for (int y = image.height - 1; y >= 0; --y) {
        for (int x = 0; x < image.width; ++x) {
            for (int i = 0; i < channels; ++i) {
                const auto bits = std::bit_cast<std::uint32_t>(image.pixel(x, y)[i]);
                for (unsigned k = 0; k < 4; ++k) out.push_back(std::byte(bits >> (8 * k)));
            }
        }
    }
    return out;
}

}  // namespace alhazen
