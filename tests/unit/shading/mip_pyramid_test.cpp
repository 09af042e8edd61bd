#include "alhazen/shading/textures/mip_pyramid.h"

#include <gtest/gtest.h>

#include "alhazen/imaging/image/encoding.h"
#include "alhazen/shading/textures/texture.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::shared_ptr<const StoredImage> store(Image image) {
    return std::make_shared<const StoredImage>(stored(std::move(image)));
}

Image ramp(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.samples.size(); ++i) {
        image.samples[i] = float((i * 37) % 101) / 16.0f;
    }
    return image;
}

double mean_of(const MipPyramid& p, int level, int channel) {
    double sum = 0;
    for (int y = 0; y < p.height(level); ++y) {
        for (int x = 0; x < p.width(level); ++x) {
            const Rgba c = p.texel(level, x, y);
            sum += channel == 0 ? c.r : channel == 1 ? c.g : channel == 2 ? c.b : c.a;
        }
    }
    return sum / (p.width(level) * p.height(level));
}

TEST(MipPyramid, EveryLevelOfAnySizeKeepsTheMean) {
    for (const auto& [width, height] : {std::pair{8, 8}, {7, 5}, {1, 9}, {100, 3}, {33, 64}}) {
        const MipPyramid p(store(ramp(width, height, 4)), false);
        EXPECT_EQ(p.width(p.levels() - 1), 1);
        EXPECT_EQ(p.height(p.levels() - 1), 1);
        for (int level = 1; level < p.levels(); ++level) {
            for (int c = 0; c < 4; ++c) {
                EXPECT_NEAR(mean_of(p, level, c), mean_of(p, 0, c), 1e-5)
                    << width << " x " << height << " level " << level;
            }
        }
    }
}

TEST(MipPyramid, BordersOfATexelCountInPart) {
    Image image(3, 1, 1);
    image.samples = {1, 2, 6};
    const MipPyramid p(store(image), false);
    ASSERT_EQ(p.levels(), 2);
    EXPECT_NEAR(p.texel(1, 0, 0).r, 3, 1e-6);
    Image five(5, 1, 1);
    five.samples = {1, 2, 3, 4,
                    5};  // each half covers 2.5 texels: (1 + 2 + 1.5) / 2.5, (1.5 + 4 + 5) / 2.5
    const MipPyramid q(store(five), false);
    EXPECT_NEAR(q.texel(1, 0, 0).r, 1.8, 1e-6);
    EXPECT_NEAR(q.texel(1, 1, 0).r, 4.2, 1e-6);
}

TEST(MipPyramid, MeansAreOfLightNotOfCodes) {
    Image image(2, 1, 1);
    image.linear = false;
    image.samples = {0, 1};
    const MipPyramid p(store(image), true);
    EXPECT_NEAR(p.texel(1, 0, 0).r, 0.5, 1e-4);
    EXPECT_NEAR(srgb_from_linear(p.texel(1, 0, 0).r), 188.0 / 255, 1e-2);
}

ImageTexture mipmapped(Image image) {
    ImageTexture t;
    t.image = store(std::move(image));
    t.filter = TextureFilter::Mipmapped;
    t.pyramid = std::make_shared<const MipPyramid>(t.image, false);
    return t;
}

Image checker(int size) {
    Image image(size, size, 1);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) image.pixel(x, y)[0] = float((x + y) % 2);
    }
    return image;
}

TEST(MipmappedTexture, WithoutAFootprintIsTheBilinearOne) {
    const ImageTexture t = mipmapped(ramp(6, 5, 3));
    ImageTexture plain = t;
    plain.filter = TextureFilter::Bilinear;
    for (const Vec2 uv : {Vec2{0.1, 0.7}, {0.5, 0.5}, {-3.2, 0.9}}) {
        EXPECT_EQ(evaluate(t, uv), evaluate(plain, uv));
    }
}

TEST(MipmappedTexture, TheNearestTexelIsShownWhereTexelsAreLarge) {
    ImageTexture t = mipmapped(checker(64));
    t.filter = TextureFilter::NearestMipmapped;
    ImageTexture squares = t;
    squares.filter = TextureFilter::Nearest;
    const ImageTexture smooth = mipmapped(checker(64));
    for (const Vec2 uv : {Vec2{0.103, 0.707}, {0.5, 0.501}, {-3.203, 0.911}}) {
        EXPECT_EQ(evaluate(t, uv), evaluate(squares, uv));
        EXPECT_EQ(evaluate(t, uv, {{0.01, 0}, {0, 0.01}}), evaluate(squares, uv));
        const UvFootprint large{{0.1, 0}, {0, 0.05}};
        EXPECT_EQ(evaluate(t, uv, large), evaluate(smooth, uv, large));
    }
}

TEST(MipmappedTexture, ALargeFootprintIsTheMeanWhateverItsShape) {
    const ImageTexture t = mipmapped(checker(64));
    const Vec2 uv{0.31, 0.77};
    EXPECT_NEAR(evaluate(t, uv, {{1, 0}, {0, 1}}).r, 0.5, 1e-6);
    EXPECT_NEAR(evaluate(t, uv, {{50, 0}, {0, 3}}).r, 0.5, 1e-6);
    EXPECT_NEAR(evaluate(t, uv, {{1e12, 1e12}, {0, 1}}).r, 0.5, 1e-6);
}

TEST(MipmappedTexture, AThinFootprintFiltersAlongItselfOnly) {
    // Stripes along u: black and white rows of 8 texels.
    Image image(64, 64, 1);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) image.pixel(x, y)[0] = float(y / 8 % 2);
    }
    const ImageTexture t = mipmapped(std::move(image));
    // Centre of a white stripe; footprint 12 texels long and 1 wide.
    const Vec2 uv{0.5, 1 - 12.0 / 64};
    const double twelve = 12.0 / 64, one = 1.0 / 64;
    EXPECT_NEAR(evaluate(t, uv, {{twelve, 0}, {0, one}}).r, 1.0, 1e-6);
    EXPECT_NEAR(evaluate(t, uv, {{0, one}, {twelve, 0}}).r, 1.0, 1e-6);
    const double across = evaluate(t, uv, {{one, 0}, {0, twelve}}).r;
    EXPECT_NEAR(across, 8.0 / 12, 0.05);
}

TEST(MipmappedTexture, ConjugateDiametersOfOneEllipseAreOneFootprint) {
    const ImageTexture t = mipmapped(ramp(64, 64, 1));
    const double a = 0.2, b = 0.05, c = std::sqrt(0.5);
    const Rgba straight = evaluate(t, {0.4, 0.4}, {{a, 0}, {0, b}});
    const Rgba turned = evaluate(t, {0.4, 0.4}, {{c * a, c * b}, {-c * a, c * b}});
    EXPECT_NEAR(straight.r, turned.r, 1e-9);
}

TEST(MipmappedTexture, AlphaIsFilteredToo) {
    Image image(2, 2, 4);
    image.samples = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1};
    const ImageTexture t = mipmapped(std::move(image));
    EXPECT_NEAR(evaluate(t, {0.5, 0.5}, {{1, 0}, {0, 1}}).a, 0.5, 1e-6);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
