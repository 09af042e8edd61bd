#include "alhazen/imaging/codecs/image_io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "alhazen/base/file.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

namespace fs = std::filesystem;
using testing::as_string;
using testing::error_of;

Image round_trip(const std::string& suffix, const Image& image,
                 const ImageWriteOptions& options = {}) {
    return decode_image(as_string(encode_image(suffix, image, options)), "memory." + suffix);
}

class ImageFile : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alhazen-image-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(ImageFile, PngKeepsEveryCodeOfEveryKind) {
    for (const int bits : {8, 16}) {
        for (int channels = 1; channels <= 4; ++channels) {
            const EncodedImage codes = testing::random_codes(37, 11, channels, bits, 1);
            const fs::path path = folder_ / "a.png";
            write_png(path, codes);
            const Image read = read_image(path);
            ASSERT_EQ(read.width, 37);
            ASSERT_EQ(read.height, 11);
            ASSERT_EQ(read.channels, channels);
            EXPECT_FALSE(read.linear);
            EXPECT_EQ(encode(read, Encoding::LinearTruncated, bits).samples, codes.samples)
                << bits << " bits, " << channels << " channels";
        }
    }
}

TEST_F(ImageFile, AllSuffixesWriteAndReadBack) {
    const Image image = testing::smooth_image(40, 30, 3);
    for (const std::string& suffix : image_suffixes()) {
        const fs::path path = folder_ / ("a." + suffix);
        write_image(path, image);
        const Image read = read_image(path);
        EXPECT_EQ(read.width, 40) << suffix;
        EXPECT_EQ(read.height, 30) << suffix;
        EXPECT_EQ(read.channels, 3) << suffix;
        for (std::size_t i = 0; i < image.samples.size(); ++i) {
            const double value = double(read.samples[i]);
            const double linear = read.linear ? value : linear_from_srgb(value);
            ASSERT_NEAR(linear, double(image.samples[i]), 0.03) << suffix << " sample " << i;
        }
    }
}

TEST_F(ImageFile, UnknownSuffixesAreUsageErrorsThatListTheKnown) {
    for (const char* name : {"a.tiff", "a", "a.", ".png"}) {
        try {
            write_image(folder_ / name, Image(1, 1, 3));
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Usage);
            EXPECT_NE(std::string(error.what()).find("png, jpg, jpeg, exr, hdr, pfm"),
                      std::string::npos)
                << error.what();
        }
    }
    EXPECT_NO_THROW(write_image(folder_ / "A.PNG", Image(1, 1, 3)));
    EXPECT_TRUE(fs::is_empty(folder_) || fs::exists(folder_ / "A.PNG"));
}

TEST_F(ImageFile, FailedWritesLeaveTheOldFile) {
    const fs::path path = folder_ / "a.png";
    write_file_atomically(path, "old");
    EXPECT_EQ(error_of([&] { write_image(path, Image()); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { write_image(path, Image(2, 2, 3), {.bits = 12}); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { write_image(folder_ / "x" / "a.png", Image(2, 2, 3)); }),
              ErrorKind::File);
    EXPECT_EQ(read_file(path), "old");
}

TEST(ImageIo, PngMetadataIsInTheFile) {
    ImageWriteOptions options;
    options.metadata = {{"Software", "Alhazen"}, {"Title", "caf\xc3\xa9"}};
    const std::string bytes = as_string(encode_image("png", Image(1, 1, 3), options));
    EXPECT_NE(bytes.find(std::string("tEXtSoftware\0Alhazen", 20)), std::string::npos);
    EXPECT_NE(bytes.find("iTXtTitle"), std::string::npos);
    EXPECT_NE(bytes.find("caf\xc3\xa9"), std::string::npos);
    options.metadata = {{"", "text"}};
    EXPECT_EQ(error_of([&] { (void)encode_image("png", Image(1, 1, 3), options); }),
              ErrorKind::Usage);
}

TEST(ImageIo, PngRefusesCodesThatDoNotFit) {
    EncodedImage codes = testing::random_codes(2, 2, 3, 8, 1);
    codes.samples[5] = 256;
    EXPECT_EQ(error_of([&] { write_png("never.png", codes); }), ErrorKind::Usage);
    codes.samples.pop_back();
    codes.bits = 16;
    EXPECT_EQ(error_of([&] { write_png("never.png", codes); }), ErrorKind::Usage);
    EXPECT_FALSE(fs::exists("never.png"));
}

TEST(ImageIo, ExrFloatKeepsEveryBit) {
    Image image = testing::random_image(23, 300, 3, -1e30f, 1e30f, 2);
    image.samples[0] = std::numeric_limits<float>::infinity();
    image.samples[1] = -0.0f;
    image.samples[2] = std::numeric_limits<float>::denorm_min();
    ImageWriteOptions options;
    options.full_float = true;
    for (int channels = 1; channels <= 4; ++channels) {
        Image part = image;
        part.channels = channels;
        part.samples.resize(std::size_t(23 * 300 * channels));
        if (channels == 4) part = testing::random_image(23, 300, 4, 0, 1, 3);
        part.associated = channels % 2 == 0;
        const Image read = round_trip("exr", part, options);
        EXPECT_TRUE(read.linear);
        EXPECT_EQ(read.associated, channels % 2 == 0);
        ASSERT_EQ(read.channels, channels);
        ASSERT_EQ(read.samples.size(), part.samples.size());
        EXPECT_EQ(std::memcmp(read.samples.data(), part.samples.data(),
                              part.samples.size() * sizeof(float)),
                  0)
            << channels;
    }
}

TEST(ImageIo, ExrHalfIsWithinHalfAStepOfHalf) {
    const Image image = testing::random_image(50, 20, 3, 0.001f, 1000.0f, 4);
    const Image read = round_trip("exr", image);
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        ASSERT_NEAR(read.samples[i], image.samples[i], image.samples[i] / 2048.0f) << i;
    }
}

TEST(ImageIo, ExrHalfHoldsNumbersBeyondItsRangeAsItsLargest) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Image image = testing::random_image(2, 3, 1, 0, 1, 5);
    image.samples = {65504.0f, 65519.0f, 65520.0f, -1e30f, kInfinity, -kInfinity};
    const std::vector<float> largest{65504, 65504, 65504, -65504, kInfinity, -kInfinity};
    EXPECT_EQ(round_trip("exr", image).samples, largest);
    EXPECT_EQ(round_trip("exr", image, {.full_float = true}).samples, image.samples);
}

TEST(ImageIo, ExrCropsAndMetadataAreInTheHeader) {
    ImageWriteOptions options;
    options.metadata = {{"scene", "teapot"}};
    options.full_width = 100;
    options.full_height = 80;
    options.crop_x0 = 10;
    options.crop_y0 = 20;
    const Image image = testing::random_image(30, 40, 3, 0, 1, 5);
    const std::string bytes = as_string(encode_image("exr", image, options));
    const auto window_of = [&](const std::string& attribute) {
        const std::string key = attribute + std::string("\0box2i\0\x10\0\0\0", 11);
        const std::size_t at = bytes.find(key);
        std::array<std::int32_t, 4> window{};
        if (at != std::string::npos) std::memcpy(window.data(), bytes.data() + at + key.size(), 16);
        return window;
    };
    EXPECT_EQ(window_of("displayWindow"), (std::array<std::int32_t, 4>{0, 0, 99, 79}));
    EXPECT_EQ(window_of("dataWindow"), (std::array<std::int32_t, 4>{10, 20, 39, 59}));
    EXPECT_NE(bytes.find(std::string("scene\0string\0\x06\0\0\0teapot", 23)), std::string::npos);
    const Image read = decode_image(bytes, "crop.exr");
    EXPECT_EQ(read.width, 100);
    EXPECT_EQ(read.height, 80);

    options.crop_x0 = 71;
    EXPECT_EQ(error_of([&] { (void)encode_image("exr", image, options); }), ErrorKind::Usage);
}

/// The file of a picture with its windows, (x0, y0) to (x1, y1), replaced.
std::string with_windows(const Image& image, const std::array<std::int32_t, 4>& data,
                         const std::array<std::int32_t, 4>& display) {
    std::string bytes = as_string(encode_image("exr", image, {.full_float = true}));
    const auto replace = [&](const std::string& attribute, const auto& window) {
        const std::string key = attribute + std::string("\0box2i\0\x10\0\0\0", 11);
        const std::size_t at = bytes.find(key);
        ASSERT_NE(at, std::string::npos);
        std::memcpy(bytes.data() + at + key.size(), window.data(), 16);
    };
    replace("dataWindow", data);
    replace("displayWindow", display);
    return bytes;
}

TEST(ImageIo, AnExrHasTheSizeOfItsDisplayWindow) {
    // Chunks of rows begin at the first row of the data window, which stays 0.
    Image image = testing::random_image(20, 100, 4, 0.1f, 1, 5);
    image.associated = true;
    const auto expect_at = [&](const std::array<std::int32_t, 4>& data,
                               const std::array<std::int32_t, 4>& display) {
        const Image read = decode_image(with_windows(image, data, display), "a.exr");
        ASSERT_EQ(read.width, display[2] - display[0] + 1);
        ASSERT_EQ(read.height, display[3] - display[1] + 1);
        for (int y = 0; y < read.height; ++y) {
            for (int x = 0; x < read.width; ++x) {
                const int i = x + display[0] - data[0], j = y + display[1] - data[1];
                const bool inside = i >= 0 && i < 20 && j >= 0 && j < 100;
                for (int k = 0; k < 4; ++k) {
                    ASSERT_EQ(read.pixel(x, y)[k], inside ? image.pixel(i, j)[k] : 0.0f)
                        << x << ' ' << y << ' ' << k;
                }
            }
        }
        const Image part = held_part(read);
        EXPECT_EQ(part.width, read.held.width > 0 ? read.held.width : read.width);
    };
    expect_at({0, 0, 19, 99}, {0, 0, 19, 99});
    expect_at({0, 0, 19, 99}, {-7, -3, 40, 130});
    expect_at({0, 0, 19, 99}, {3, 5, 12, 80});    // data beyond all sides
    expect_at({0, 0, 19, 99}, {-4, 70, 9, 120});  // beyond some
    expect_at({0, 0, 19, 99}, {30, 0, 40, 10});   // apart
    expect_at({-5, 0, 14, 99}, {-5, 0, 14, 99});  // both shifted
    EXPECT_EQ(decode_image(with_windows(image, {0, 0, 19, 99}, {-1, 0, 19, 99}), "a.exr").held.x0,
              1);
    // The limits apply to the display window.
    const ImageLimits limits{.max_side = 200, .max_pixels = 200 * 200};
    const auto kind_of = [&](const std::array<std::int32_t, 4>& display) {
        return error_of([&] {
            (void)decode_image(with_windows(image, {0, 0, 19, 99}, display), "a.exr", limits);
        });
    };
    EXPECT_EQ(kind_of({0, 0, 199, 199}), std::nullopt);
    EXPECT_EQ(kind_of({0, 0, 200, 199}), ErrorKind::Resource);
    EXPECT_EQ(kind_of({0, 0, 0x7FFFFFF, 0x7FFFFFF}), ErrorKind::Resource);
    EXPECT_EQ(kind_of({5, 0, 4, 199}), ErrorKind::Scene);
    EXPECT_EQ(kind_of({std::numeric_limits<std::int32_t>::min(), 0, 2147483647, 199}),
              ErrorKind::Scene);
}

TEST(ImageIo, AnExrTellsThatNoneOfItsPixelsAreInThePicture) {
    const Image image = testing::random_image(20, 100, 4, 0.1f, 1, 5);
    const auto held = [&](const std::array<std::int32_t, 4>& display) {
        return decode_image(with_windows(image, {0, 0, 19, 99}, display), "a.exr").held;
    };
    EXPECT_TRUE(held({30, 0, 40, 10}).are_none());
    EXPECT_TRUE(held({0, 100, 19, 120}).are_none());
    EXPECT_FALSE(held({19, 99, 40, 120}).are_none());
    EXPECT_FALSE(held({0, 0, 19, 99}).are_none());
    EXPECT_TRUE(stored(decode_image(with_windows(image, {0, 0, 19, 99}, {30, 0, 40, 10}), "a.exr"))
                    .held.are_none());
}

TEST(ImageIo, ExrColoursAreMultipliedByAlpha) {
    Image image(2, 1, 4);
    image.samples = {0.5f, 0.25f, 1.0f, 0.25f, 0.5f, 2.0f, 3.0f, 0.0f};
    const std::vector<float> multiplied{0.125f, 0.0625f, 0.25f, 0.25f, 0.5f, 2.0f, 3.0f, 0.0f};
    const Image read = round_trip("exr", image);
    EXPECT_EQ(read.samples, multiplied);
    EXPECT_TRUE(read.associated);
    EXPECT_EQ(round_trip("exr", read).samples, multiplied);  // once only
    // Pixels are straight; colours without cover stay.
    const StoredImage texture = stored(read);
    EXPECT_EQ(texture.pixel(0, false), (Rgba{0.5, 0.25, 1.0, 0.25}));
    EXPECT_EQ(texture.pixel(1, false), (Rgba{0.5, 2.0, 3.0, 0.0}));
    std::vector<double> run(8);
    texture.read_pixels(0, 2, false, run.data());
    EXPECT_EQ(run, (std::vector<double>{0.5, 0.25, 1.0, 0.25, 0.5, 2.0, 3.0, 0.0}));
    // Grey with alpha, and a cover too small for the quotient.
    Image grey(2, 1, 2);
    grey.associated = true;
    grey.samples = {0.25f, 0.5f, 1e10f, 1e-35f};
    EXPECT_EQ(stored(grey).pixel(0, false), (Rgba{0.5, 0.5, 0.5, 0.5}));
    EXPECT_EQ(stored(grey).pixel(1, false).r, double(1e10f));
    const Image png = round_trip("png", image);
    EXPECT_FALSE(png.associated);
}

TEST(ImageIo, JpegsMayLackTheMarkerOfTheEndAlone) {
    const std::string bytes =
        as_string(encode_image("jpg", testing::random_image(50, 40, 3, 0, 1, 6)));
    ASSERT_EQ(bytes.substr(bytes.size() - 2), "\xff\xd9");
    const std::string without = bytes.substr(0, bytes.size() - 2);
    EXPECT_EQ(decode_image(without, "a.jpg").samples, decode_image(bytes, "a.jpg").samples);
    EXPECT_EQ(decode_image(without + '\xff', "a.jpg").samples,
              decode_image(bytes, "a.jpg").samples);
    for (std::size_t cut = 4; cut < 40; ++cut) {
        const std::string part = bytes.substr(0, bytes.size() - cut);
        EXPECT_EQ(error_of([&] { (void)decode_image(part, "a.jpg"); }), ErrorKind::Scene) << cut;
    }
}

TEST(ImageIo, HdrIsWithinItsStepAndReadsBackTheSame) {
    for (const int width : {1, 7, 8, 300}) {
        Image image = testing::random_image(width, 9, 3, 0, 1, 6);
        for (std::size_t i = 0; i < image.samples.size(); ++i) {
            image.samples[i] *= std::ldexp(1.0f, int(i % 40) - 20);
            if (i % 50 < 30) image.samples[i] = 0.25f;  // runs
        }
        const Image once = round_trip("hdr", image);
        for (int y = 0; y < 9; ++y) {
            for (int x = 0; x < width; ++x) {
                const double step = image.rgb(x, y).max() / 255;
                for (int i = 0; i < 3; ++i) {
                    ASSERT_NEAR(once.rgb(x, y)[i], image.rgb(x, y)[i], step) << x << " " << y;
                }
            }
        }
        EXPECT_EQ(round_trip("hdr", once).samples, once.samples) << width;
    }
}

/// Mantissas that are cut off would darken the mean by 1/512 of the largest channel or more.
TEST(ImageIo, HdrIsNotDarkerOnAverage) {
    const Image image = testing::random_image(300, 100, 3, 0, 1, 6);
    const Image read = round_trip("hdr", image);
    double sum = 0, change = 0;
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        sum += image.samples[i];
        change += read.samples[i] - image.samples[i];
    }
    EXPECT_NEAR(change / sum, 0, 1e-4);
}

/// 255.6 / 256 is nearer to 1 than to 255 / 256.
TEST(ImageIo, HdrRoundsUpToTheNextExponent) {
    Image image(2, 1, 3);
    image.samples = {255.6f / 256, 0.5f, 0.25f, 255.4f / 256, 0.5f, 0.25f};
    const Image read = round_trip("hdr", image);
    EXPECT_EQ(read.rgb(0, 0), (Rgb{1, 0.5, 0.25}));
    EXPECT_EQ(read.rgb(1, 0), (Rgb{255.0 / 256, 0.5, 0.25}));
}

TEST(ImageIo, HdrWritesWhatIsNoColourAsBlackOrItsLargest) {
    const float infinity = std::numeric_limits<float>::infinity();
    Image image(3, 1, 3);
    image.samples = {-1, std::nanf(""), 0.5f, infinity, 0, 1e-42f, 1e-42f, 0, 0};
    const Image read = round_trip("hdr", image);
    EXPECT_EQ(read.rgb(0, 0), (Rgb{0, 0, 0.5}));
    EXPECT_EQ(read.rgb(1, 0), (Rgb{0x1.fep126, 0, 0}));
    EXPECT_EQ(read.rgb(2, 0), (Rgb{0, 0, 0}));
}

TEST(ImageIo, HdrReadsOldRunLengths) {
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 300\n";
    // One pixel, then 299 = 43 + 256 repeats of it.
    const std::string data("\x80\x40\x20\x81\x01\x01\x01\x2b\x01\x01\x01\x01", 12);
    const Image image = decode_image(header + data, "old.hdr");
    EXPECT_EQ(image.rgb(0, 0), (Rgb{1.0, 0.5, 0.25}));
    EXPECT_EQ(image.rgb(299, 0), (Rgb{1.0, 0.5, 0.25}));
    const std::string too_long("\x80\x40\x20\x81\x01\x01\x01\x2c\x01\x01\x01\x01", 12);
    EXPECT_EQ(error_of([&] { (void)decode_image(header + too_long, "old.hdr"); }),
              ErrorKind::Scene);
}

TEST(ImageIo, PfmKeepsEveryBit) {
    Image image = testing::random_image(5, 7, 3, -1e30f, 1e30f, 8);
    image.samples[3] = std::nanf("");
    for (const int channels : {1, 3}) {
        image.channels = channels;
        image.samples.resize(std::size_t(5 * 7 * channels), 0.5f);
        const Image read = round_trip("pfm", image);
        ASSERT_EQ(read.channels, channels);
        EXPECT_EQ(std::memcmp(read.samples.data(), image.samples.data(), image.samples.size() * 4),
                  0);
        image = testing::random_image(5, 7, 3, 0, 1, 9);
    }
}

TEST(ImageIo, PfmReadsBothByteOrdersAndTheBottomRowFirst) {
    const std::string big("Pf 1 2 1.0\n\x3f\x80\0\0\x40\0\0\0", 19);
    const std::string little("Pf\n1 2\n-1\n\0\0\x80\x3f\0\0\0\x40", 18);
    for (const std::string& bytes : {big, little}) {
        const Image image = decode_image(bytes, "a.pfm");
        EXPECT_EQ(image.pixel(0, 0)[0], 2.0f);
        EXPECT_EQ(image.pixel(0, 1)[0], 1.0f);
    }
    const std::string scaled("Pf\n1 1\n-2.5\n\0\0\x80\x3f", 16);
    EXPECT_EQ(decode_image(scaled, "a.pfm").pixel(0, 0)[0], 2.5f);
}

TEST(ImageIo, JpegIsCloseAndGreyStaysGrey) {
    for (const int channels : {1, 2, 3, 4}) {
        const Image image = testing::smooth_image(64, 48, channels);
        const Image read = round_trip("jpg", image);
        ASSERT_EQ(read.channels, channels < 3 ? 1 : 3);
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                for (int i = 0; i < 3; ++i) {
                    ASSERT_NEAR(read.rgb(x, y)[i], srgb_from_linear(image.rgb(x, y)[i]), 0.03);
                }
            }
        }
    }
    for (const int quality : {0, 101}) {
        EXPECT_EQ(
            error_of([&] { (void)encode_image("jpg", Image(1, 1, 3), {.jpeg_quality = quality}); }),
            ErrorKind::Usage);
    }
}

TEST(ImageIo, TheSamePictureGivesTheSameBytes) {
    const Image image = testing::random_image(33, 21, 3, 0, 1, 10);
    for (const std::string& suffix : image_suffixes()) {
        EXPECT_EQ(encode_image(suffix, image), encode_image(suffix, image)) << suffix;
    }
}

TEST(ImageIo, TextAndNothingAreNoPictures) {
    for (const std::string bytes : {"", "P6 1 1 255 abc", "<svg></svg>", "BM", "PF", "#?"}) {
        EXPECT_EQ(error_of([&] { (void)decode_image(bytes, "a.png"); }), ErrorKind::Scene) << bytes;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
