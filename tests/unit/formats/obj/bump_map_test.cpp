/// Conversion of height maps to normal maps.

#include "alhazen/formats/obj/bump_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "alhazen/formats/pictures/texture_table.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "support/image_texture.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// One float channel f(x, y), rows from the top.
template <class F>
StoredImage heights_of(int width, int height, F&& f) {
    std::vector<float> samples;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) samples.push_back(float(f(x, y)));
    }
    return {width, height, 1, true, std::move(samples)};
}

/// Direction stored in a texel.
Vec3 normal_at(const StoredImage& normals, int x, int y) {
    const Rgba c = normals.pixel(std::size_t(y * normals.width + x), false);
    return {2 * c.r - 1, 2 * c.g - 1, 2 * c.b - 1};
}

constexpr double kCode = 1.0 / 127.5;  ///< step of a code

TEST(BumpMap, FlatHeightsPointStraightUp) {
    for (const double level : {0.0, 0.3, 1.0}) {
        const StoredImage flat = heights_of(5, 3, [&](int, int) { return level; });
        const StoredImage normals = normals_from_heights(flat, {});
        ASSERT_EQ(normals.channels, 3);
        ASSERT_TRUE(std::holds_alternative<std::vector<std::uint8_t>>(normals.samples));
        EXPECT_FALSE(normals.linear);
        for (int i = 0; i < 15; ++i) {
            EXPECT_EQ(normal_at(normals, i % 5, i / 5).z, 1.0);
            EXPECT_NEAR(normal_at(normals, i % 5, i / 5).x, 0.0, kCode);
        }
    }
}

TEST(BumpMap, ARampLeansAgainstItsSlope) {
    // With a side of 100 texels, a height of 1 is one texel.
    const StoredImage to_right = heights_of(100, 100, [](int x, int) { return 0.5 * x; });
    const StoredImage up = heights_of(100, 100, [](int, int y) { return 0.5 * (99 - y); });
    const double sine = 0.5 / std::sqrt(1.25), cosine = 1 / std::sqrt(1.25);
    const Vec3 right = normal_at(normals_from_heights(to_right, {}), 50, 50);
    EXPECT_NEAR(right.x, -sine, kCode);
    EXPECT_NEAR(right.y, 0, kCode);
    EXPECT_NEAR(right.z, cosine, kCode);
    const Vec3 top = normal_at(normals_from_heights(up, {}), 50, 50);
    EXPECT_NEAR(top.x, 0, kCode);
    EXPECT_NEAR(top.y, -sine, kCode);
    EXPECT_NEAR(normal_at(normals_from_heights(to_right, {.strength = -1}), 9, 9).x, sine, kCode);
    EXPECT_NEAR(normal_at(normals_from_heights(to_right, {.strength = 4}), 9, 9).x,
                -2 / std::sqrt(5.0), kCode);
}

TEST(BumpMap, TheRimHasTheNeighboursThatTheTextureHas) {
    const StoredImage ramp = heights_of(100, 100, [](int x, int) { return 0.5 * x; });
    const StoredImage repeated = normals_from_heights(ramp, {});
    const StoredImage clamped = normals_from_heights(ramp, {.wrap = Wrap::Clamp});
    EXPECT_GT(normal_at(repeated, 99, 7).x, 0.9);  // slopes down to the first column
    EXPECT_GT(normal_at(repeated, 0, 7).x, 0.9);
    EXPECT_NEAR(normal_at(clamped, 99, 7).x, -0.25 / std::sqrt(1.0625), kCode);
    EXPECT_NEAR(normal_at(clamped, 0, 7).x, -0.25 / std::sqrt(1.0625), kCode);
    // A single texel is its own neighbour.
    const StoredImage one = heights_of(1, 1, [](int, int) { return 0.7; });
    EXPECT_EQ(normal_at(normals_from_heights(one, {}), 0, 0).z, 1.0);
}

TEST(BumpMap, SlopesDoNotDependOnTheResolution) {
    const auto waves = [](int size) {
        return heights_of(size, size, [=](int x, int) {
            return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * (x + 0.5) / size);
        });
    };
    const HeightMap strong{.strength = 10};
    const StoredImage small = normals_from_heights(waves(90), strong);
    const StoredImage large = normals_from_heights(waves(270), strong);
    for (int x = 0; x < 90; ++x) {
        const Vec3 a = normal_at(small, x, 4), b = normal_at(large, 3 * x + 1, 4);
        EXPECT_NEAR(a.x, b.x, 2 * kCode) << x;
    }
    EXPECT_LT(normal_at(small, 0, 0).x, -0.2);
}

TEST(BumpMap, TheChosenChannelIsTheHeight) {
    std::vector<std::uint8_t> codes;
    for (int i = 0; i < 64; ++i) codes.insert(codes.end(), {9, std::uint8_t(4 * (i % 8)), 9, 255});
    const StoredImage picture{8, 8, 4, false, codes};
    EXPECT_NEAR(normal_at(normals_from_heights(picture, {100, Channel::Red}), 4, 4).x, 0, kCode);
    EXPECT_LT(normal_at(normals_from_heights(picture, {100, Channel::Green}), 4, 4).x, -0.1);
    EXPECT_NEAR(normal_at(normals_from_heights(picture, {100, Channel::Alpha}), 4, 4).x, 0, kCode);
}

TEST(BumpMap, NumbersThatAreNoHeightsGiveDirectionsStill) {
    constexpr double kInf = std::numeric_limits<double>::infinity();
    testing::Random random(5);
    const StoredImage wild = heights_of(16, 16, [&](int, int) {
        const double values[] = {kInf, -kInf, std::nan(""), 1e38, -1e38, 0, 1, 1e-38};
        return values[random.below(8)];
    });
    for (const double strength : {1.0, 1e308, -1e308, 1e-308}) {
        const StoredImage normals = normals_from_heights(wild, {.strength = strength});
        for (int i = 0; i < 256; ++i) {
            EXPECT_NEAR(length(normal_at(normals, i % 16, i / 16)), 1.0, 2 * kCode);
        }
    }
}

TEST(BumpMap, PicturesOfDirectionsAreToldFromHeights) {
    testing::Random random(6);
    const auto coloured = [&](auto&& texel) {
        std::vector<std::uint8_t> codes;
        for (int i = 0; i < 32 * 32; ++i) {
            for (const double c : texel(i)) {
                codes.push_back(std::uint8_t(std::lround(255 * std::fmin(std::fmax(c, 0), 1))));
            }
        }
        return StoredImage{32, 32, 3, false, std::move(codes)};
    };
    using Texel = std::array<double, 3>;
    const StoredImage bumps = heights_of(32, 32, [&](int, int) { return random.uniform(); });
    EXPECT_TRUE(looks_like_normal_map(normals_from_heights(bumps, {.strength = 2})));
    EXPECT_FALSE(looks_like_normal_map(bumps));
    // With the noise of a lossy format.
    EXPECT_TRUE(looks_like_normal_map(coloured([&](int) {
        return Texel{0.5 + random.uniform(-.1, .1), 0.5 + random.uniform(-.1, .1),
                     0.98 + random.uniform(-.03, .02)};
    })));
    for (const double grey : {0.0, 0.2113, 0.5, 0.7887, 1.0}) {
        EXPECT_FALSE(looks_like_normal_map(coloured([&](int) { return Texel{grey, grey, grey}; })));
    }
    EXPECT_FALSE(looks_like_normal_map(coloured([&](int) {
        return Texel{random.uniform(), random.uniform(), random.uniform()};
    })));
    // Brick red, and a dull blue.
    EXPECT_FALSE(looks_like_normal_map(coloured([&](int) { return Texel{.6, .3, .2}; })));
    EXPECT_FALSE(looks_like_normal_map(coloured([&](int) { return Texel{.3, .3, .5}; })));
    // Half of the texels are no normals.
    EXPECT_FALSE(looks_like_normal_map(coloured([&](int i) {
        return i % 2 == 0 ? Texel{.5, .5, 1} : Texel{.5, .5, .5};
    })));
}

TEST(BumpMap, ConversionsAreSharedAndCountAsPictures) {
    Image grey(16, 16, 1);
    grey.linear = false;
    std::string bytes;
    for (const std::byte b : encode_image("png", grey)) bytes += char(b);
    int made = 0;
    const auto make = [&](const StoredImage& picture) {
        ++made;
        return normals_from_heights(picture, {});
    };
    const auto fill = [&](std::uint64_t max_bytes) {
        SceneDescription scene;
        Diagnostics found;
        ImageLimits limits;
        limits.max_bytes = max_bytes;
        TextureTable table(scene, found, {"."}, limits);
        const auto a = table.add(bytes, {}, "a", {}), b = table.add(bytes, {}, "b", {});
        table.derive(a.value(), "1", make);
        table.derive(b.value(), "1", make);
        EXPECT_EQ(testing::image_texture(scene.textures[0]).image,
                  testing::image_texture(scene.textures[1]).image);
        EXPECT_EQ(testing::image_texture(scene.textures[0]).image->channels, 3);
        table.derive(table.add(bytes, {}, "c", {}).value(), "2", make);
        EXPECT_NE(testing::image_texture(scene.textures[2]).image,
                  testing::image_texture(scene.textures[1]).image);
    };
    fill(100'000);
    EXPECT_EQ(made, 2);
    made = 0;
    // Memory for the image and one conversion, not for two.
    const std::uint64_t codes = 3 * 256;
    const StoredImage normals{16, 16, 3, false, std::vector<std::uint8_t>(codes)};
    const std::uint64_t one = codes + MipPyramid::memory_bytes_for(normals);
    EXPECT_THROW(fill(bytes.size() + 256 + one + codes - 1), Error);
    EXPECT_EQ(made, 1);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
