#include "alhazen/imaging/image/encoding.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "alhazen/imaging/image/code_lanes.h"
#include "alhazen/imaging/image/screen_pixels.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::error_of;

TEST(Encoding, TruncationUsesTheDoubleNotItsFloat) {
    // 0.3 in double is just below 76.5 / 255; use the value just below a step, which float rounds
    // up to the step.
    const double just_below = std::nextafter(1.0 / 3.0, 0.0);
    EXPECT_EQ(encode_channel(just_below, Encoding::LinearTruncated, 8), 84u);
    EXPECT_EQ(encode_channel(double(float(just_below)), Encoding::LinearTruncated, 8), 85u);
    const double rgb[3] = {just_below, 0.5, 1.0 / 3.0};
    const EncodedImage encoded = encode(rgb, 1, 1, Encoding::LinearTruncated, 8);
    EXPECT_EQ(encoded.samples, (std::vector<std::uint16_t>{84, 127, 85}));
}

TEST(Encoding, RoundingTakesTheNearestCode) {
    for (int code = 0; code < 255; ++code) {
        const auto encoded = [&](double above) {
            return int(encode_channel((code + above) / 255.0, Encoding::LinearRounded, 8));
        };
        EXPECT_EQ(encoded(0.499), code);
        EXPECT_EQ(encoded(0.501), code + 1);
    }
}

TEST(Encoding, ValuesOutsideTheUnitRangeAndNanAreClamped) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const Encoding encoding :
         {Encoding::LinearTruncated, Encoding::LinearRounded, Encoding::Srgb}) {
        for (const int bits : {8, 16}) {
            const std::uint32_t max = bits == 8 ? 255 : 65535;
            for (const double low : {0.0, -0.0, -1.0, -infinity, nan, -nan}) {
                EXPECT_EQ(encode_channel(low, encoding, bits), 0u) << low;
            }
            for (const double high : {1.0, 2.0, 1e300, infinity}) {
                EXPECT_EQ(encode_channel(high, encoding, bits), max) << high;
            }
        }
    }
}

TEST(Encoding, SrgbMeetsTheValuesOfTheStandard) {
    EXPECT_EQ(encode_channel(0.5, Encoding::Srgb, 8), 188u);
    EXPECT_EQ(encode_channel(0.18, Encoding::Srgb, 8), 118u);
    EXPECT_EQ(encode_channel(0.0031308, Encoding::Srgb, 8), 10u);
    EXPECT_EQ(encode_channel(0.5, Encoding::Srgb, 16), 48192u);
    for (int code = 0; code < 256; ++code) {
        EXPECT_EQ(encode_channel(linear_from_srgb(code / 255.0), Encoding::Srgb, 8),
                  std::uint32_t(code));
    }
}

TEST(Encoding, CodesNeverFallWhereTheValueRises) {
    for (const Encoding encoding :
         {Encoding::LinearTruncated, Encoding::LinearRounded, Encoding::Srgb}) {
        std::uint32_t last = 0;
        for (int i = 0; i <= 100'000; ++i) {
            const std::uint32_t code = encode_channel(i / 100'000.0, encoding, 16);
            ASSERT_GE(code, last) << "at " << i;
            last = code;
        }
    }
}

TEST(Encoding, PicturesThatAreEncodedKeepTheirCodes) {
    Image image(256, 1, 1);
    image.linear = false;
    for (int i = 0; i < 256; ++i) image.pixel(i, 0)[0] = float(i) / 255.0f;
    for (const Encoding encoding :
         {Encoding::LinearTruncated, Encoding::LinearRounded, Encoding::Srgb}) {
        const EncodedImage encoded = encode(image, encoding, 8);
        for (std::size_t i = 0; i < 256; ++i) EXPECT_EQ(encoded.samples[i], i);
    }
}

TEST(Encoding, AlphaDoesNotGoThroughTheCurve) {
    Image image(1, 1, 4);
    image.samples = {0.5f, 0.5f, 0.5f, 0.5f};
    EXPECT_EQ(encode(image, Encoding::Srgb, 8).samples,
              (std::vector<std::uint16_t>{188, 188, 188, 128}));
}

TEST(Encoding, PicturesHaveTheCodesOfTheCurveToTheLastBit) {
    std::vector<double> values{-1.0, 0.0, 1e-300, 1.0, 2.0, std::nan(""), 0.0031308};
    for (int code = 0; code < 256; ++code) {  // where codes change, and next to it
        const double edge = linear_from_srgb((code + 0.5) / 255.0);
        double below = edge, above = edge;
        for (int k = 0; k < 20; ++k) {
            values.insert(values.end(), {below, above});
            below = std::nextafter(below, 0.0);
            above = std::nextafter(above, 1.0);
        }
    }
    for (int i = 0; i < 3000; ++i) values.push_back(std::pow(i / 3000.0, 3.0));
    while (values.size() % 3 != 0) values.push_back(0.5);
    const int pixels = static_cast<int>(values.size() / 3);
    const EncodedImage encoded = encode(values.data(), pixels, 1, Encoding::Srgb, 8);
    for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(encoded.samples[i], encode_channel(values[i], Encoding::Srgb, 8)) << values[i];
    }
    // With more pixels than one write takes.
    const auto count = static_cast<std::size_t>(pixels);
    ASSERT_GT(count, 4096U);
    for (const Encoding encoding : {Encoding::Srgb, Encoding::LinearTruncated}) {
        std::vector<std::uint8_t> bytes(4 * count + 1, 7);
        write_screen_pixels(values.data(), count, encoding, bytes.data());
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < 3; ++c) {
                const double value = values[3 * i + c];
                ASSERT_EQ(bytes[4 * i + c], encode_channel(value, encoding, 8)) << value;
            }
            ASSERT_EQ(bytes[4 * i + 3], 255);
        }
        EXPECT_EQ(bytes.back(), 7);
    }
}

TEST(Encoding, RowsHaveTheCodesOfTheirValues) {
    std::vector<double> values{-1.0, -0.0, 0.0, 1e-300, 1.0, 2.0, std::nan(""), -std::nan("")};
    for (const double most : {255.0, 65535.0}) {  // where codes change, and next to it
        for (int code = 0; code < 256; ++code) {
            for (const double edge : {code / most, (code + 0.5) / most}) {
                values.insert(values.end(),
                              {std::nextafter(edge, -1.0), edge, std::nextafter(edge, 2.0)});
            }
        }
    }
    values.push_back(std::nextafter(1.0, 0.0));
    while (values.size() % 3 != 0) values.push_back(0.5);
    for (const Encoding encoding :
         {Encoding::LinearTruncated, Encoding::LinearRounded, Encoding::Srgb}) {
        for (const int bits : {8, 16}) {
            // Rows that do not fill their last lanes, too.
            for (std::size_t count = 3; count <= values.size();
                 count = count < 30 || count == values.size() ? count + 3 : values.size()) {
                std::vector<std::uint16_t> codes(count + 1, 7);
                encode(values.data(), encoding, bits, std::span(codes).first(count));
                for (std::size_t i = 0; i < count; ++i) {
                    ASSERT_EQ(codes[i], encode_channel(values[i], encoding, bits)) << values[i];
                }
                EXPECT_EQ(codes.back(), 7);
            }
        }
    }
}

TEST(Encoding, CodesBecomeTheirLowBytesInOrder) {
    for (std::size_t count = 0; count < 70; ++count) {
        std::vector<std::uint16_t> codes(count);
        for (std::size_t i = 0; i < count; ++i) codes[i] = std::uint16_t(255 - 3 * i);
        std::vector<std::uint8_t> bytes(count);
        EXPECT_TRUE(narrow_codes(codes, bytes.data()));
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_EQ(bytes[i], codes[i]) << i << " of " << count;
        for (std::size_t i = 0; i < count; ++i) {
            std::vector<std::uint16_t> wide = codes;
            wide[i] = std::uint16_t(wide[i] + 0xFF00);
            EXPECT_FALSE(narrow_codes(wide, bytes.data()));
            EXPECT_EQ(bytes[i], codes[i]);
        }
    }
}

TEST(Encoding, WrongSizesAreUsageErrors) {
    const double rgb[3] = {};
    Image image(2, 2, 3);
    image.samples.pop_back();
    const auto srgb = Encoding::Srgb;
    EXPECT_EQ(error_of([&] { (void)encode(rgb, 0, 1, srgb, 8); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)encode(rgb, 1, -1, srgb, 8); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)encode(rgb, 1, 1, srgb, 10); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)encode(image, srgb, 8); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)encode(Image(), srgb, 8); }), ErrorKind::Usage);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
