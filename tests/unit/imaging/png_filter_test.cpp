#include "alhazen/imaging/codecs/png_filter.h"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <cstring>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/imaging/codecs/png.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Row = std::vector<std::uint8_t>;

/// The bytes of a picture, behind a margin of zeros.
std::span<const std::uint8_t> without_margin(const Row& row) {
    return std::span(row).subspan(kPngRowMargin);
}

/// Of bytes as the standard has it.
int predicted(int filter, int a, int b, int c) {
    const int p = a + b - c;
    const int pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
    switch (filter) {
        case 1:
            return a;
        case 2:
            return b;
        case 3:
            return (a + b) / 2;
        case 4:
            return pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
        default:
            return 0;
    }
}

PngFilter least_by_the_standard(const Row& row, const Row& above, std::size_t pixel) {
    int best = 0;
    std::uint64_t least = ~std::uint64_t{0};
    for (int filter = 0; filter < 5; ++filter) {
        std::uint64_t sum = 0;
        for (std::size_t i = kPngRowMargin; i < row.size(); ++i) {
            const int p = predicted(filter, row[i - pixel], above[i], above[i - pixel]);
            sum += std::uint64_t(std::abs(int(std::int8_t(row[i] - p))));
        }
        if (sum < least) {
            least = sum;
            best = filter;
        }
    }
    return PngFilter(best);
}

/// Smooth where `noise` is small, so that each filter is the best of some row.
Row random_row(std::mt19937& random, std::size_t bytes, int noise) {
    Row row(kPngRowMargin + bytes);
    int value = int(random() & 255);
    for (std::size_t i = kPngRowMargin; i < row.size(); ++i) {
        value += int(random() % unsigned(2 * noise + 1)) - noise;
        row[i] = std::uint8_t(value);
    }
    return row;
}

TEST(PngFilter, IsThatOfTheLeastSumByTheStandard) {
    std::mt19937 random(7);
    std::array<int, 5> chosen{};
    for (int turn = 0; turn < 4000; ++turn) {
        const std::size_t pixel = 1 + random() % 8, bytes = 1 + random() % 300;
        const int noise = 1 << random() % 8;
        const Row above = random_row(random, bytes, noise);
        Row row = random_row(random, bytes, noise);
        if (turn % 3 == 0) {
            for (std::size_t i = kPngRowMargin; i < row.size(); ++i) {
                row[i] = std::uint8_t(above[i] + random() % 3);
            }
        }
        const PngFilter best = best_png_filter(without_margin(row), without_margin(above), pixel);
        ASSERT_EQ(best, least_by_the_standard(row, above, pixel)) << "turn " << turn;
        ++chosen[std::size_t(best)];
    }
    for (const int times : chosen) EXPECT_GT(times, 0);
}

TEST(PngFilter, TheFirstOfEqualSumsIsTaken) {
    const Row zeros(kPngRowMargin + 100);
    EXPECT_EQ(best_png_filter(without_margin(zeros), without_margin(zeros), 3), PngFilter::None);
    Row same(kPngRowMargin + 100, 9);
    std::fill_n(same.begin(), kPngRowMargin, std::uint8_t{0});
    EXPECT_EQ(best_png_filter(without_margin(same), without_margin(same), 3), PngFilter::Up);
}

TEST(PngFilter, DifferencesAreThoseOfTheStandard) {
    std::mt19937 random(5);
    for (int turn = 0; turn < 2000; ++turn) {
        const std::size_t pixel = 1 + random() % 8, bytes = 1 + random() % 300;
        const Row above = random_row(random, bytes, 64), row = random_row(random, bytes, 64);
        for (int filter = 0; filter < 5; ++filter) {
            Row filtered(bytes + 1, 77);
            apply_png_filter(PngFilter(filter), without_margin(row), without_margin(above), pixel,
                             filtered.data());
            for (std::size_t i = 0; i < bytes; ++i) {
                const std::size_t at = kPngRowMargin + i;
                const int p = predicted(filter, row[at - pixel], above[at], above[at - pixel]);
                ASSERT_EQ(filtered[i], std::uint8_t(row[at] - p)) << filter << ", byte " << i;
            }
            ASSERT_EQ(filtered[bytes], 77) << filter;
        }
    }
}

/// The bytes of the rows with their filters, decompressed by zlib.
Row filtered_rows_of(const std::vector<std::byte>& file) {
    Row stream;
    std::size_t at = 8;
    const auto number = [&](std::size_t from) {
        std::size_t value = 0;
        for (std::size_t i = from; i < from + 4; ++i) value = value << 8 | std::size_t(file[i]);
        return value;
    };
    while (at < file.size()) {
        const std::size_t bytes = number(at);
        const auto* data = reinterpret_cast<const std::uint8_t*>(file.data()) + at + 4;
        if (std::memcmp(data, "IDAT", 4) == 0)
            stream.insert(stream.end(), data + 4, data + 4 + bytes);
        EXPECT_EQ(crc32(crc32(0, nullptr, 0), data, uInt(bytes + 4)), number(at + 8 + bytes));
        at += 12 + bytes;
    }
    EXPECT_EQ(at, file.size());
    Row rows(std::size_t{1} << 20);
    uLongf size = rows.size();
    EXPECT_EQ(uncompress(rows.data(), &size, stream.data(), stream.size()), Z_OK);
    rows.resize(size);
    return rows;
}

/// The file as libpng writes it when it chooses the filters.
std::vector<std::byte> written_by_libpng(const EncodedImage& image) {
    static constexpr int kColourType[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                          PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    std::vector<std::byte> bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    const auto write = [](png_structp p, png_bytep source, std::size_t count) {
        auto* to = static_cast<std::vector<std::byte>*>(png_get_io_ptr(p));
        const auto* from = reinterpret_cast<const std::byte*>(source);
        to->insert(to->end(), from, from + count);
    };
    png_set_write_fn(png, &bytes, write, [](png_structp) {});
    png_set_compression_level(png, 3);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), image.bits,
                 kColourType[image.channels], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    std::vector<png_byte> row;
    for (int y = 0; y < image.height; ++y) {
        row.clear();
        for (int i = 0; i < image.width * image.channels; ++i) {
            const unsigned code =
                image.samples[std::size_t(y) * std::size_t(image.width * image.channels) +
                              std::size_t(i)];
            if (image.bits == 16) row.push_back(png_byte(code >> 8));
            row.push_back(png_byte(code & 255));
        }
        png_write_row(png, row.data());
    }
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return bytes;
}

std::vector<std::uint16_t> codes_of(const StoredImage& image) {
    return std::visit(
        [](const auto& codes) { return std::vector<std::uint16_t>(codes.begin(), codes.end()); },
        image.samples);
}

/// Sizes above 1: for one row or column libpng tries fewer filters.
TEST(PngFilter, RowsAreThoseThatLibpngWritesWithItsOwnChoice) {
    std::mt19937 random(11);
    const std::array<std::array<int, 2>, 7> sizes = {
        {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {33, 17}, {120, 60}, {257, 90}}};
    for (const auto& [width, height] : sizes) {
        for (int channels = 1; channels <= 4; ++channels) {
            for (const int bits : {8, 16}) {
                EncodedImage image{width, height, channels, bits, {}};
                const auto count = std::size_t(width * height * channels);
                for (std::size_t i = 0; i < count; ++i) {
                    // A slope with noise, and rows alike.
                    const std::size_t y = i / std::size_t(width * channels);
                    const unsigned noise = y % 4 == 0 ? 0 : random() & 7;
                    image.samples.push_back(
                        std::uint16_t((i / 7 + y * y / 5 + noise) & (bits == 8 ? 255u : 65535u)));
                }
                const std::vector<std::byte> file = encode_png(image, {});
                const Row rows = filtered_rows_of(file);
                const std::string name = std::to_string(width) + "x" + std::to_string(height) +
                                         ", " + std::to_string(channels) + " channels, " +
                                         std::to_string(bits) + " bits";
                if (width > 1 && height > 1) {
                    EXPECT_EQ(rows, filtered_rows_of(written_by_libpng(image))) << name;
                }
                const auto* text = reinterpret_cast<const char*>(file.data());
                const StoredImage read = decode_png({text, file.size()}, "a.png", {});
                EXPECT_EQ(codes_of(read), image.samples) << name;
            }
        }
    }
}

TEST(PngFilter, CodesThatDoNotFitAreRefused) {
    for (int place = 0; place < 75; ++place) {  // in full lanes and behind them
        EncodedImage image{25, 1, 3, 8, std::vector<std::uint16_t>(75, 255)};
        EXPECT_FALSE(encode_png(image, {}).empty());
        image.samples[std::size_t(place)] = 256;
        EXPECT_THROW((void)encode_png(image, {}), Error) << place;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
