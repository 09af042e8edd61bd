#include "alhazen/imaging/codecs/tga.h"

#include <gtest/gtest.h>

#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::error_of;

std::string bytes(std::initializer_list<int> values) {
    std::string result;
    for (const int v : values) result += char(v);
    return result;
}

/// A header without a palette.
std::string header(int kind, int width, int height, int bits, int descriptor) {
    return bytes({0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, width & 255, width >> 8, height & 255,
                  height >> 8, bits, descriptor});
}

std::vector<std::uint8_t> codes_of(const std::string& file, int channels) {
    const StoredImage image = decode_tga(file, "a.tga", {});
    EXPECT_EQ(image.channels, channels);
    EXPECT_FALSE(image.linear);
    return std::get<std::vector<std::uint8_t>>(image.samples);
}

using Codes = std::vector<std::uint8_t>;

TEST(Tga, TrueColourIsStoredBlueFirstAndBottomRowFirst) {
    const std::string file =
        header(2, 2, 2, 24, 0) + bytes({3, 2, 1, 6, 5, 4, 9, 8, 7, 12, 11, 10});
    EXPECT_EQ(codes_of(file, 3), (Codes{7, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, 6}));
}

TEST(Tga, TheDescriptorSaysWhichCornerComesFirst) {
    const std::string pixels = bytes({1, 2, 3, 4});
    EXPECT_EQ(codes_of(header(3, 2, 2, 8, 0x00) + pixels, 1), (Codes{3, 4, 1, 2}));
    EXPECT_EQ(codes_of(header(3, 2, 2, 8, 0x20) + pixels, 1), (Codes{1, 2, 3, 4}));
    EXPECT_EQ(codes_of(header(3, 2, 2, 8, 0x10) + pixels, 1), (Codes{4, 3, 2, 1}));
    EXPECT_EQ(codes_of(header(3, 2, 2, 8, 0x30) + pixels, 1), (Codes{2, 1, 4, 3}));
}

TEST(Tga, AlphaIsReadWhereBitsAreSetAsideForIt) {
    const std::string pixel = bytes({3, 2, 1, 4});
    EXPECT_EQ(codes_of(header(2, 1, 1, 32, 0x28) + pixel, 4), (Codes{1, 2, 3, 4}));
    EXPECT_EQ(codes_of(header(2, 1, 1, 32, 0x20) + pixel, 3), (Codes{1, 2, 3}));
    EXPECT_EQ(codes_of(header(3, 1, 1, 16, 0x28) + bytes({7, 9}), 2), (Codes{7, 9}));
}

TEST(Tga, AnExtensionAreaMaySayThatAlphaMeansNothing) {
    const auto with_attributes = [](int kind) {
        std::string file = header(2, 1, 1, 32, 0x28) + bytes({3, 2, 1, 4});
        const int extension_at = int(file.size());
        file += bytes({495 & 255, 495 >> 8}) + std::string(492, '\0') + bytes({kind});
        file += bytes({extension_at, 0, 0, 0, 0, 0, 0, 0});
        return file + std::string("TRUEVISION-XFILE.\0", 18);
    };
    EXPECT_EQ(codes_of(with_attributes(3), 4), (Codes{1, 2, 3, 4}));
    EXPECT_EQ(codes_of(with_attributes(0), 3), (Codes{1, 2, 3}));
}

TEST(Tga, FiveBitsBecomeEight) {
    // 0 11111 00000 10000: red 31, green 0, blue 16.
    const std::string pixel = bytes({0x10, 0x7c});
    EXPECT_EQ(codes_of(header(2, 1, 1, 16, 0x20) + pixel, 3), (Codes{255, 0, 132}));
    EXPECT_EQ(codes_of(header(2, 1, 1, 15, 0x20) + pixel, 3), (Codes{255, 0, 132}));
    EXPECT_EQ(codes_of(header(2, 1, 1, 16, 0x21) + bytes({0x10, 0xfc}), 4),
              (Codes{255, 0, 132, 255}));
}

TEST(Tga, PalettesMayStartBeyondZero) {
    std::string file = bytes({2, 1, 1, 5, 0, 2, 0, 24, 0, 0, 0, 0, 2, 0, 1, 0, 8, 0x20});
    file += "id";
    file += bytes({3, 2, 1, 6, 5, 4});
    EXPECT_EQ(codes_of(file + bytes({6, 5}), 3), (Codes{4, 5, 6, 1, 2, 3}));
    for (const int bad : {4, 7}) {
        EXPECT_EQ(error_of([&] {
                      (void)decode_tga(file + bytes({5, bad}), "a.tga", {});
                  }),
                  ErrorKind::Scene);
    }
}

TEST(Tga, RunsMayCrossRows) {
    const std::string runs = bytes({0x83, 7, 0x01, 8, 9});  // four of 7, then 8 and 9
    EXPECT_EQ(codes_of(header(11, 3, 2, 8, 0x20) + runs, 1), (Codes{7, 7, 7, 7, 8, 9}));
    const std::string colours = bytes({0x81, 3, 2, 1, 0x00, 6, 5, 4});
    EXPECT_EQ(codes_of(header(10, 3, 1, 24, 0x20) + colours, 3),
              (Codes{1, 2, 3, 1, 2, 3, 4, 5, 6}));
    std::string palette = bytes({0, 1, 9, 0, 0, 1, 0, 24, 0, 0, 0, 0, 2, 0, 1, 0, 8, 0x20});
    palette += bytes({3, 2, 1, 0x81, 0});
    EXPECT_EQ(codes_of(palette, 3), (Codes{1, 2, 3, 1, 2, 3}));
}

TEST(Tga, ASuffixOrAPlausibleHeaderIsEnoughToBeTaken) {
    const std::string file = header(2, 2, 1, 24, 0x20) + bytes({3, 2, 1, 6, 5, 4});
    EXPECT_EQ(decode_image(file, "a.tga").width, 2);
    EXPECT_EQ(decode_image(file, "embedded").width, 2);
    EXPECT_EQ(decode_image(file, "a.TGA").rgb(0, 0).r, double(1.0f / 255.0f));
    EXPECT_FALSE(is_plausible_tga(file.substr(0, file.size() - 1)));
    EXPECT_FALSE(is_plausible_tga(std::string(1000, '\0')));
    EXPECT_FALSE(is_plausible_tga("solid cube\nfacet normal 0 0 1\n"));
}

TEST(Tga, EveryTruncationIsAnErrorThatNamesTheFile) {
    const std::string file =
        header(10, 3, 2, 24, 0x20) + bytes({0x83, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7});
    EXPECT_EQ(codes_of(file, 3).size(), 18u);
    for (std::size_t size = 0; size < file.size(); ++size) {
        try {
            (void)decode_tga(std::string_view(file).substr(0, size), "cut.tga", {});
            ADD_FAILURE() << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Scene);
            EXPECT_EQ(error.location().file, "cut.tga");
        }
    }
}

TEST(Tga, WrongHeadersAndSizesAreRefused) {
    const auto kind_of = [](const std::string& file, ImageLimits limits = {}) {
        return error_of([&] { (void)decode_tga(file, "a.tga", limits); });
    };
    const std::string pixels(64, 'x');
    EXPECT_EQ(kind_of(header(4, 2, 2, 24, 0) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(32, 2, 2, 24, 0) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(2, 2, 2, 8, 0) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(1, 2, 2, 8, 0) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(2, 2, 2, 24, 0x40) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(2, 0, 2, 24, 0) + pixels), ErrorKind::Scene);
    EXPECT_EQ(kind_of(header(2, 65500, 65500, 24, 0) + pixels), ErrorKind::Resource);
    EXPECT_EQ(kind_of(header(3, 8, 8, 8, 0) + pixels, {.max_side = 7}), ErrorKind::Resource);
    // A run holds at most 128 pixels: the data cannot fill the declared size.
    EXPECT_EQ(kind_of(header(11, 8000, 8000, 8, 0) + pixels), ErrorKind::Scene);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
