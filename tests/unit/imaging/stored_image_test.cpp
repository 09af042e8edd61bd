#include "alhazen/imaging/stored_image.h"

#include <gtest/gtest.h>

#include "alhazen/imaging/encoding.h"
#include "unit/imaging/test_images.h"

namespace alhazen {
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

}  // namespace
}  // namespace alhazen
