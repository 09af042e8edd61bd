#include "alhazen/imaging/figures/false_color.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "alhazen/imaging/figures/heat_map.h"
#include "alhazen/imaging/figures/tiny_font.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

double luminance(const Rgb& display) {
    return 0.2126 * linear_from_srgb(display.r) + 0.7152 * linear_from_srgb(display.g) +
           0.0722 * linear_from_srgb(display.b);
}

TEST(HeatMap, MoreIsLighterAllTheWay) {
    double before = -1;
    for (int i = 0; i <= 255; ++i) {
        const double now = luminance(heat_color(i / 255.0));
        EXPECT_GT(now, before) << i;
        before = now;
    }
}

TEST(HeatMap, IsClampedAtItsEnds) {
    EXPECT_EQ(heat_color(-3), heat_color(0));
    EXPECT_EQ(heat_color(7), heat_color(1));
    EXPECT_EQ(heat_color(std::numeric_limits<double>::quiet_NaN()), heat_color(0));
}

TEST(FalseColor, PixelsTakeTheColourOfTheirPlaceOnTheScale) {
    const std::vector<float> values{0, 5, 10, 20, std::numeric_limits<float>::infinity(), -1};
    const EncodedImage image = false_color(values, 3, 2, {.low = 0, .high = 10, .title = "rays"});
    EXPECT_GE(image.width, 3);
    EXPECT_GT(image.height, 2);
    const auto red = [&](int x, int y) {
        return image.samples[3 * static_cast<std::size_t>(y * image.width + x)];
    };
    const auto code = [](double t) {
        return static_cast<std::uint16_t>(std::lround(255 * heat_color(t).r));
    };
    EXPECT_EQ(red(0, 0), code(0));
    EXPECT_EQ(red(1, 0), code(0.5));
    EXPECT_EQ(red(2, 0), code(1));
    EXPECT_EQ(red(0, 1), code(1));
    EXPECT_EQ(red(1, 1), 0);
    EXPECT_EQ(red(2, 1), code(0));
}

TEST(FalseColor, AScaleWithoutARangeIsDrawn) {
    const std::vector<float> values{4};
    const EncodedImage image = false_color(values, 1, 1, {.low = 4, .high = 4});
    EXPECT_EQ(image.samples.size(), 3u * static_cast<std::size_t>(image.width * image.height));
}

TEST(FalseColor, NeighbouringIdsDiffer) {
    std::set<std::array<std::uint16_t, 3>> seen;
    for (std::uint32_t id = 0; id < 200; ++id) seen.insert(id_color(id));
    EXPECT_GT(seen.size(), 195u);
    EXPECT_EQ(id_color(0), (std::array<std::uint16_t, 3>{0, 0, 0}));
}

TEST(TinyFont, EveryLetterOfTheScalesIsDrawnAndUnlikeTheOthers) {
    std::set<std::string> shapes;
    const std::string letters = "0123456789.-+_abcdefghijklmnopqrstuvwxyz";
    for (const char letter : letters) {
        std::string shape;
        for (int y = 0; y < kGlyphHeight; ++y) {
            for (int x = 0; x < kGlyphWidth; ++x) shape += glyph_pixel(letter, x, y) ? '#' : '.';
        }
        EXPECT_NE(shape.find('#'), std::string::npos) << letter;
        shapes.insert(shape);
    }
    EXPECT_EQ(shapes.size(), letters.size());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
