#include <gtest/gtest.h>

#include "alhazen/imaging/image/image_difference.h"
#include "support/test_data.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::error_of;

void put(std::string& bytes, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i, value >>= 8) bytes += char(value);
}

struct Bitmap {
    std::int32_t width = 2, height = 2;
    int bits = 24;
    std::uint32_t compression = 0;
    std::string palette = {};  // includes masks
    std::string pixels = {};
    std::uint32_t palette_entries = 0;
};

std::string file_of(const Bitmap& bitmap) {
    std::string bytes = "BM";
    const auto pixels_at = std::uint32_t(54 + bitmap.palette.size());
    put(bytes, std::uint32_t(pixels_at + bitmap.pixels.size()), 4);
    put(bytes, 0, 4);
    put(bytes, pixels_at, 4);
    put(bytes, 40, 4);
    put(bytes, std::uint32_t(bitmap.width), 4);
    put(bytes, std::uint32_t(bitmap.height), 4);
    put(bytes, 1, 2);
    put(bytes, std::uint32_t(bitmap.bits), 2);
    put(bytes, bitmap.compression, 4);
    put(bytes, 0, 4 * 3);
    put(bytes, bitmap.palette_entries, 4);
    put(bytes, 0, 4);
    return bytes + bitmap.palette + bitmap.pixels;
}

Image decode(const Bitmap& bitmap) {
    return decode_image(file_of(bitmap), "test.bmp");
}

std::vector<int> codes(const Image& image) {
    std::vector<int> result;
    for (const float sample : image.samples) result.push_back(int(sample * 255 + 0.5f));
    return result;
}

// Two rows of two pixels in the order blue, green, red, padded to 8 bytes.
const std::string kRows24("\x01\x02\x03\x04\x05\x06\0\0\x07\x08\x09\x0a\x0b\x0c\0\0", 16);

TEST(Bmp, RowsGoUpAndNegativeHeightsGoDown) {
    EXPECT_EQ(codes(decode({.pixels = kRows24})),
              (std::vector<int>{9, 8, 7, 12, 11, 10, 3, 2, 1, 6, 5, 4}));
    EXPECT_EQ(codes(decode({.height = -2, .pixels = kRows24})),
              (std::vector<int>{3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10}));
}

TEST(Bmp, PalettesOfOneFourAndEightBitsAreLookedUp) {
    std::string palette;
    for (std::uint32_t i = 0; i < 256; ++i) put(palette, i * 0x10000, 4);  // red = index
    const auto reds = [&](int bits, const std::string& pixels, std::int32_t width) {
        const Image image = decode({.width = width,
                                    .height = 1,
                                    .bits = bits,
                                    .palette = palette.substr(0, std::size_t(4 << bits)),
                                    .pixels = pixels});
        std::vector<int> result;
        for (int x = 0; x < width; ++x) result.push_back(int(image.rgb(x, 0).r * 255 + 0.5));
        return result;
    };
    EXPECT_EQ(reds(1, std::string("\xa1\x80\0\0", 4), 9),
              (std::vector<int>{1, 0, 1, 0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(reds(4, std::string("\x1f\xe0\0\0", 4), 3), (std::vector<int>{1, 15, 14}));
    EXPECT_EQ(reds(8, std::string("\x00\x7f\xff\0", 4), 3), (std::vector<int>{0, 127, 255}));
}

TEST(Bmp, RunLengthCodesOfFourAndEightBitsAreRead) {
    const auto reds = [](int bits, std::int32_t width, std::int32_t height, std::string runs) {
        std::string palette;
        for (std::uint32_t i = 0; i < 1u << bits; ++i) put(palette, i * 0x10000, 4);  // red = index
        const Image image = decode({.width = width,
                                    .height = height,
                                    .bits = bits,
                                    .compression = bits == 8 ? 1u : 2u,
                                    .palette = palette,
                                    .pixels = std::move(runs)});
        std::vector<int> result;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                result.push_back(int(image.rgb(x, y).r * 255 + 0.5));
            }
        }
        return result;
    };
    using std::string_literals::operator""s;
    // A run, three literal bytes and one that pads, the end of the line; a move; the end.
    EXPECT_EQ(reds(8, 5, 3, "\x02\x07\0\x03\x01\x02\xff\0\0\0\0\x02\x03\x01\x01\x09\0\x01"s),
              (std::vector<int>{0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 7, 7, 1, 2, 255}));
    // Alternating halves of a byte; five literal ones take four bytes.
    EXPECT_EQ(reds(4, 8, 1, "\x03\x1f\0\x05\x23\x45\x60\0\0\x01"s),
              (std::vector<int>{1, 15, 1, 2, 3, 4, 5, 6}));
    // The end of the bitmap may be missing behind the last row.
    EXPECT_EQ(reds(8, 1, 1, "\x01\x05\0\0"s), (std::vector<int>{5}));
    // Indices beyond the row, up to three, pad it.
    EXPECT_EQ(reds(8, 2, 2, "\x04\x07\0\0\0\x05\x01\x02\x03\x04\x05\0\0\x01"s),
              (std::vector<int>{1, 2, 7, 7}));
    EXPECT_EQ(reds(4, 5, 1, "\x08\x12\0\x01"s), (std::vector<int>{1, 2, 1, 2, 1}));
    for (const std::string& damaged :
         {"\x06\x05\0\x01"s, "\x01\x05"s, "\0\x04\x01\x02"s, "\0\x02\x05\0\x01\x01"s, ""s}) {
        EXPECT_EQ(error_of([&] { (void)reds(8, 2, 2, damaged); }), ErrorKind::Scene);
    }
}

TEST(Bmp, AnIndexBeyondThePaletteIsAnError) {
    Bitmap bitmap{.width = 1, .height = 1, .bits = 8, .palette = std::string(8, '\0')};
    bitmap.palette_entries = 2;
    bitmap.pixels = std::string("\x01\0\0\0", 4);
    EXPECT_EQ(codes(decode(bitmap)), (std::vector<int>{0, 0, 0}));
    bitmap.pixels = std::string("\x02\0\0\0", 4);
    EXPECT_EQ(error_of([&] { (void)decode(bitmap); }), ErrorKind::Scene);
    bitmap.palette_entries = 0;  // "all 256" but only two are stored
    EXPECT_EQ(error_of([&] { (void)decode(bitmap); }), ErrorKind::Scene);
}

TEST(Bmp, MasksOf16And32BitsAreScaledToTheirMaximum) {
    const std::string white_red("\xff\x7f\x00\x7c", 4);  // 5 5 5 bits
    EXPECT_EQ(codes(decode({.width = 2, .height = 1, .bits = 16, .pixels = white_red})),
              (std::vector<int>{255, 255, 255, 255, 0, 0}));
    std::string masks;
    for (const std::uint32_t mask : {0xf800u, 0x07e0u, 0x001fu}) put(masks, mask, 4);
    const std::string green_blue("\xe0\x07\x1f\0", 4);  // 5 6 5 bits
    EXPECT_EQ(codes(decode({.width = 2,
                            .height = 1,
                            .bits = 16,
                            .compression = 3,
                            .palette = masks,
                            .pixels = green_blue})),
              (std::vector<int>{0, 255, 0, 0, 0, 255}));
    const std::string pixel32("\x01\x02\x03\x00", 4);  // the fourth byte is unused
    const Image plain = decode({.width = 1, .height = 1, .bits = 32, .pixels = pixel32});
    EXPECT_EQ(plain.channels, 3);
    EXPECT_EQ(codes(plain), (std::vector<int>{3, 2, 1}));
}

TEST(Bmp, WhatIsNotSupportedIsSaid) {
    const auto message = [](const Bitmap& bitmap) {
        try {
            (void)decode(bitmap);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Scene);
            return std::string(error.what());
        }
        return std::string("nothing was thrown");
    };
    EXPECT_NE(message({.bits = 4, .compression = 1}).find("need 8 or 4 bits"), std::string::npos);
    EXPECT_NE(message({.height = -2, .bits = 8, .compression = 1}).find("rows that go up"),
              std::string::npos);
    EXPECT_NE(message({.bits = 5}).find("expected 1, 4, 8, 16, 24 or 32"), std::string::npos);
    EXPECT_NE(message({.width = 0}).find("empty"), std::string::npos);
    EXPECT_NE(message({.width = -5}).find("empty"), std::string::npos);
    EXPECT_NE(message({.pixels = kRows24.substr(0, 15)}).find("too early"), std::string::npos);
    EXPECT_EQ(error_of([] { (void)decode({.height = INT32_MIN, .pixels = kRows24}); }),
              ErrorKind::Resource);
}

TEST(Bmp, PicturesOfRealScenesAreRead) {
    const char* scenes = "ray/ut_austin/assets/scenes";
    ALHAZEN_NEEDS_DATA(scenes);
    for (const char* name :
         {"torus/donut.bmp", "simple/checkerboard.bmp", "skin1.bmp", "box_map1.bmp"}) {
        const Image image = read_image(testing::test_data() / scenes / name);
        EXPECT_GT(image.width, 1) << name;
        Image black = image;
        black.samples.assign(black.samples.size(), 0.0f);
        EXPECT_GT(difference(image, black).max_absolute, 0.1) << name;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
