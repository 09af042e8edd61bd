#include "alhazen/imaging/image/image_difference.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "unit/imaging/test_images.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::error_of;

TEST(ImageDifference, EqualPicturesHaveNone) {
    Image image = testing::random_image(6, 5, 3, 0, 1, 1);
    image.samples[4] = std::nanf("");
    image.samples[5] = std::numeric_limits<float>::infinity();
    const ImageDifference result = difference(image, image);
    EXPECT_EQ(result.pixels, 30u);
    EXPECT_EQ(result.identical, 30u);
    EXPECT_EQ(result.within_one_step, 30u);
    EXPECT_EQ(result.max_absolute, 0);
    EXPECT_EQ(result.rmse, 0);
    EXPECT_TRUE(std::isinf(result.psnr_db) && result.psnr_db > 0);
}

TEST(ImageDifference, NumbersAreThoseOfAHandCountedCase) {
    Image a(2, 2, 3), b(2, 2, 3);
    a.linear = b.linear = false;
    b.pixel(1, 0)[0] = 1.0f / 255.0f;
    b.pixel(0, 1)[2] = 0.5f;
    const ImageDifference result = difference(a, b);
    EXPECT_EQ(result.identical, 2u);
    EXPECT_EQ(result.within_one_step, 3u);
    EXPECT_EQ(result.max_absolute, 0.5);
    EXPECT_NEAR(result.mean_absolute, (0.5 + 1 / 255.0) / 12, 1e-9);
    const double mean_square = (0.25 + 1 / 255.0 / 255.0) / 12;
    EXPECT_NEAR(result.rmse, std::sqrt(mean_square), 1e-9);
    EXPECT_NEAR(result.psnr_db, 10 * std::log10(1 / mean_square), 1e-6);
}

TEST(ImageDifference, OneStepHoldsForEveryCode) {
    for (int code = 0; code < 254; ++code) {
        Image a(1, 1, 1), b(1, 1, 1), c(1, 1, 1);
        a.samples = {float(code) / 255.0f};
        b.samples = {float(code + 1) / 255.0f};
        c.samples = {float(code + 2) / 255.0f};
        EXPECT_EQ(difference(a, b).within_one_step, 1u) << code;
        EXPECT_EQ(difference(a, c).within_one_step, 0u) << code;
    }
}

TEST(ImageDifference, AlphaIsNotComparedAndGreyIsThreeEqualChannels) {
    Image grey(1, 1, 2), colour(1, 1, 4);
    grey.samples = {0.5f, 1.0f};
    colour.samples = {0.5f, 0.5f, 0.5f, 0.0f};
    EXPECT_EQ(difference(grey, colour).identical, 1u);
    colour.samples[2] = 0.75f;
    EXPECT_EQ(difference(grey, colour).max_absolute, 0.25);
    EXPECT_EQ(difference(colour, grey).identical, 0u);
}

TEST(ImageDifference, NanAgainstANumberIsInfinitelyFar) {
    Image a(1, 1, 1), b(1, 1, 1);
    a.samples = {std::nanf("")};
    EXPECT_TRUE(std::isinf(difference(a, b).max_absolute));
    EXPECT_TRUE(std::isinf(difference(b, a).rmse));
    EXPECT_EQ(difference(a, b).identical, 0u);
    EXPECT_EQ(difference_image(a, b).samples[0], 1.0f);
}

TEST(ImageDifference, TheDifferenceImageIsScaledToOne) {
    Image a(2, 1, 3), b(2, 1, 3);
    b.pixel(0, 0)[1] = -0.25f;
    b.pixel(1, 0)[2] = 0.5f;
    const Image result = difference_image(a, b);
    EXPECT_EQ(result.samples, (std::vector<float>{0, 0.5f, 0, 0, 0, 1}));
    EXPECT_EQ(difference_image(a, a).samples, std::vector<float>(6));
}

TEST(ImageDifference, PicturesThatCannotBeComparedAreUsageErrors) {
    Image a(2, 1, 3), other_size(1, 2, 3), encoded(2, 1, 3);
    encoded.linear = false;
    EXPECT_EQ(error_of([&] { (void)difference(a, other_size); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)difference(a, encoded); }), ErrorKind::Usage);
    EXPECT_EQ(error_of([&] { (void)difference_image(a, other_size); }), ErrorKind::Usage);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
