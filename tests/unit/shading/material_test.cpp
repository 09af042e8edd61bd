#include "alhazen/shading/materials/material.h"

#include <gtest/gtest.h>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Material, ATextureMultipliesTheConstant) {
    auto image = std::make_shared<Image>(1, 1, 3);
    image->samples = {0.5f, 0.25f, 1.0f};
    ImageTexture texture;
    texture.image = std::make_shared<const StoredImage>(stored(*image));
    Material m;
    m.diffuse = {{2, 2, 2}, TextureId{0}};
    m.shininess = {128, TextureId{0}};
    const std::vector<Texture> textures{texture};
    const MaterialSample s = evaluate(m, textures, Vec2{0.5, 0.5});
    EXPECT_EQ(s.diffuse, (Rgb{1.0, 0.5, 2.0}));
    EXPECT_NEAR(s.shininess, 128 * (1.75 / 3), 1e-12);
}

TEST(Material, IsOpaqueOnlyWithoutTransmission) {
    Material m;
    EXPECT_TRUE(m.is_opaque());
    m.transmissive.texture = TextureId{0};
    EXPECT_FALSE(m.is_opaque());
    m.transmissive = {{0, 0, 0.1}, kNoTexture};
    EXPECT_FALSE(m.is_opaque());
}

TEST(Material, VertexMaterialsAreInterpolatedFieldByField) {
    MaterialSample a, b, c;
    a.diffuse = {1, 0, 0};
    b.diffuse = {0, 1, 0};
    c.diffuse = {0, 0, 1};
    a.index = 1;
    b.index = 2;
    c.index = 3;
    const MaterialSample s = weighted_sum(0.5, a, 0.25, b, 0.25, c);
    EXPECT_EQ(s.diffuse, (Rgb{0.5, 0.25, 0.25}));
    EXPECT_EQ(s.index, 1.75);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
