#include "alhazen/shading/textures/texture.h"

#include <gtest/gtest.h>

#include <limits>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// 2 x 2 grey image: top row 0, 1; bottom row 2, 3.
ImageTexture small_texture() {
    auto image = std::make_shared<Image>(2, 2, 1);
    for (int i = 0; i < 4; ++i) image->samples[static_cast<std::size_t>(i)] = static_cast<float>(i);
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(*image));
    return texture;
}

TEST(Texture, VRunsFromTheBottomRowUpward) {
    ImageTexture t = small_texture();
    t.filter = TextureFilter::Nearest;
    EXPECT_EQ(evaluate(t, {0.25, 0.25}).r, 2.0);
    EXPECT_EQ(evaluate(t, {0.75, 0.25}).r, 3.0);
    EXPECT_EQ(evaluate(t, {0.25, 0.75}).r, 0.0);
    EXPECT_EQ(evaluate(t, {0.75, 0.75}).r, 1.0);
}

TEST(Texture, BilinearIsExactAtTexelCentresAndMeansBetween) {
    const ImageTexture t = small_texture();
    EXPECT_EQ(evaluate(t, {0.25, 0.75}).r, 0.0);
    EXPECT_EQ(evaluate(t, {0.5, 0.5}).r, 1.5);
    EXPECT_EQ(evaluate(t, {0.5, 0.75}).r, 0.5);
}

TEST(Texture, WrapModesDifferBeyondTheEdge) {
    ImageTexture t = small_texture();
    t.filter = TextureFilter::Nearest;
    t.wrap_u = Wrap::Repeat;
    EXPECT_EQ(evaluate(t, {1.25, 0.25}).r, 2.0);
    EXPECT_EQ(evaluate(t, {-0.25, 0.25}).r, 3.0);
    t.wrap_u = Wrap::Clamp;
    EXPECT_EQ(evaluate(t, {1.25, 0.25}).r, 3.0);
    EXPECT_EQ(evaluate(t, {-0.25, 0.25}).r, 2.0);
    t.wrap_u = Wrap::Mirror;
    EXPECT_EQ(evaluate(t, {1.25, 0.25}).r, 3.0);
    EXPECT_EQ(evaluate(t, {1.75, 0.25}).r, 2.0);
}

TEST(Texture, CornerTexelsStandAtIOverWidthFromTheTopLeftAndRepeat) {
    ImageTexture t = small_texture();
    t.corner_texels = true;
    EXPECT_EQ(evaluate(t, {0.0, 1.0}).r, 0.0);
    EXPECT_EQ(evaluate(t, {0.5, 1.0}).r, 1.0);
    EXPECT_EQ(evaluate(t, {0.0, 0.5}).r, 2.0);
    EXPECT_EQ(evaluate(t, {0.25, 1.0}).r, 0.5);
    EXPECT_EQ(evaluate(t, {0.75, 1.0}).r, 0.5);  // between the last texel and the first
    EXPECT_EQ(evaluate(t, {0.5, 0.25}).r, 2.0);
}

TEST(Texture, SrgbIsMadeLinearBeforeItIsInterpolated) {
    ImageTexture t = small_texture();
    t.decode_srgb = true;
    EXPECT_NEAR(evaluate(t, {0.5, 0.75}).r, 0.5, 1e-12);  // between codes 0 and 1
}

TEST(Texture, CoordinatesThatAreNoNumbersAreHarmless) {
    const ImageTexture t = small_texture();
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), 1e300}) {
        EXPECT_TRUE(evaluate(t, {bad, -bad}).is_finite());
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
