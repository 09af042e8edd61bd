#include "alhazen/imaging/codecs/stored_image.h"

#include <gtest/gtest.h>

#include "alhazen/imaging/image/encoding.h"
#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

Image from_codes(const EncodedImage& codes) {
    Image image(codes.width, codes.height, codes.channels);
    image.linear = false;
    const float max = codes.bits == 8 ? 255.0f : 65535.0f;
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        image.samples[i] = float(codes.samples[i]) / max;
    }
    return image;
}

TEST(StoredImage, CodesAreKeptAsCodesAndComeBackBitForBit) {
    const Image bytes = from_codes(testing::random_codes(16, 16, 3, 8, 1));
    EXPECT_EQ(stored(bytes).memory_bytes(), 16u * 16 * 3);
    EXPECT_EQ(expanded(stored(bytes)).samples, bytes.samples);
    const Image shorts = from_codes(testing::random_codes(16, 16, 4, 16, 2));
    EXPECT_EQ(stored(shorts).memory_bytes(), 16u * 16 * 4 * 2);
    EXPECT_EQ(expanded(stored(shorts)).samples, shorts.samples);
    Image floats = testing::random_image(16, 16, 1, -5, 5, 3);
    floats.linear = false;
    EXPECT_EQ(stored(floats).memory_bytes(), 16u * 16 * 4);
    EXPECT_EQ(expanded(stored(floats)).samples, floats.samples);
}

TEST(StoredImage, PixelsAreTheSamplesWithGreyRepeatedAndAlphaLinear) {
    Image image(2, 1, 2);
    image.linear = false;
    image.samples = {0, 1, 128 / 255.0f, 64 / 255.0f};
    const StoredImage s = stored(image);
    const double grey = double(128 / 255.0f), alpha = double(64 / 255.0f);
    EXPECT_EQ(s.pixel(1, false), (Rgba{grey, grey, grey, alpha}));
    const double linear = linear_from_srgb(grey);
    EXPECT_EQ(s.pixel(1, true), (Rgba{linear, linear, linear, alpha}));
    EXPECT_FALSE(s.is_opaque());
    image.samples[3] = 1;
    EXPECT_TRUE(stored(image).is_opaque());
}

TEST(StoredImage, RunsOfPixelsAreThePixelsOneByOne) {
    for (int channels = 1; channels <= 4; ++channels) {
        for (const int bits : {8, 16, 32}) {
            Image image = bits == 32 ? testing::random_image(5, 3, channels, -1, 2, 9)
                                     : from_codes(testing::random_codes(5, 3, channels, bits, 9));
            image.linear = false;
            const StoredImage s = stored(image);
            for (const bool decode : {false, true}) {
                std::vector<double> run(7 * std::size_t(channels));
                s.read_pixels(4, 7, decode, run.data());
                for (std::size_t i = 0; i < 7; ++i) {
                    const Rgba p = s.pixel(4 + i, decode);
                    const double color[] = {p.r, p.g, p.b};
                    for (int k = 0; k < channels; ++k) {
                        const bool alpha = channels % 2 == 0 && k == channels - 1;
                        EXPECT_EQ(run[i * std::size_t(channels) + std::size_t(k)],
                                  alpha ? p.a : color[k])
                            << channels << " channels, " << bits << " bits, " << decode;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
