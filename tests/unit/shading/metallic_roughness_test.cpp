#include <gtest/gtest.h>

#include "alhazen/shading/materials/material.h"
#include "alhazen/shading/materials/turn_to_view.h"
#include "support/expect_near.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;

Material with(const MetallicRoughness& parameters, double index = 1.5) {
    Material m;
    m.index.value = index;
    m.metallic_roughness = parameters;
    return m;
}
MaterialSample sample_of(const Material& m, const SurfaceLookup& lookup = {}) {
    return evaluate(m, {}, lookup);
}
MetallicRoughness parameters(double metallic, double roughness) {
    MetallicRoughness p;
    p.base_color.color = {0.8, 0.4, 0.2};
    p.metallic.value = metallic;
    p.roughness.value = roughness;
    return p;
}
TEST(MetallicRoughness, ASmoothDielectricReflectsFourPercentAndIsItsBaseColour) {
    const MaterialSample s = sample_of(with(parameters(0, 0)));
    expect_near(s.reflective, {0.04, 0.04, 0.04});
    expect_near(s.diffuse, {0.8, 0.4, 0.2});
    expect_near(s.ambient, {0.8, 0.4, 0.2});
    EXPECT_TRUE(s.transmissive.is_black());
    EXPECT_EQ(s.coverage, 1.0);
}

TEST(MetallicRoughness, ASmoothMetalIsAMirrorOfItsColour) {
    const MaterialSample s = sample_of(with(parameters(1, 0)));
    expect_near(s.reflective, {0.8, 0.4, 0.2});
    EXPECT_TRUE(s.diffuse.is_black());
}

TEST(MetallicRoughness, ARoughMetalIsNotBlackAndNoMirror) {
    const MaterialSample s = sample_of(with(parameters(1, 1)));
    EXPECT_TRUE(s.reflective.is_black());
    expect_near(s.diffuse, {0.4, 0.2, 0.1});
    expect_near(s.ambient, {0.8, 0.4, 0.2});
}

TEST(MetallicRoughness, TheHighlightIsNormalised) {
    // alpha = 0.25: n = 2 / 0.0625 - 2 = 30, ks = F0 (n + 2) / 8.
    const MaterialSample s = sample_of(with(parameters(1, 0.5)));
    EXPECT_NEAR(s.shininess, 30, 1e-12);
    expect_near(s.specular, {0.8 * 4, 0.4 * 4, 0.2 * 4});
}

TEST(MetallicRoughness, ReflectionGrowsToAllAtGrazingAndTakesFromTheRest) {
    MaterialSample s = sample_of(with(parameters(0, 0)));
    turn_to_view(s, 0.0, false);
    expect_near(s.reflective, {1, 1, 1});
    EXPECT_TRUE(s.diffuse.is_black());
    s = sample_of(with(parameters(0, 0)));
    turn_to_view(s, 1.0, false);
    expect_near(s.reflective, {0.04, 0.04, 0.04});
    expect_near(s.diffuse, {0.8 * 0.96, 0.4 * 0.96, 0.2 * 0.96});
}

TEST(MetallicRoughness, SpecularZeroReflectsNothingAtAnyAngle) {
    MetallicRoughness p = parameters(0, 0);
    p.specular.value = 0;
    MaterialSample s = sample_of(with(p));
    turn_to_view(s, 0.1, false);
    EXPECT_TRUE(s.reflective.is_black());
    EXPECT_TRUE(s.specular.is_black());
}

TEST(MetallicRoughness, TransmissionReplacesTheDiffuseAndThicknessMakesAVolume) {
    MetallicRoughness p = parameters(0, 0);
    p.transmission.value = 1;
    p.attenuation_color = {0.5, 1, 0.25};
    p.attenuation_distance = 2;
    MaterialSample s = sample_of(with(p));
    EXPECT_TRUE(s.thin);
    EXPECT_TRUE(s.absorption.is_black());
    expect_near(s.transmissive, {0.8, 0.4, 0.2});
    EXPECT_TRUE(s.diffuse.is_black());
    p.thickness.value = 1;
    s = sample_of(with(p));
    EXPECT_FALSE(s.thin);
    EXPECT_EQ(s.index, 1.5);
    // After the attenuation distance the attenuation colour remains.
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(std::exp(-s.absorption[i] * 2), p.attenuation_color[i], 1e-12);
    }
}

TEST(MetallicRoughness, WhatTheBodyLetsThroughIsShownOnTheSideOfTheLight) {
    MetallicRoughness p = parameters(0, 1);
    p.diffuse_transmission.share.value = 0.25;
    p.diffuse_transmission.color.color = {0.4, 0.4, 1};
    const MaterialSample s = sample_of(with(p));
    expect_near(s.diffuse, {0.7, 0.4, 0.4});
    expect_near(s.ambient, {0.7, 0.4, 0.4});
    EXPECT_TRUE(s.transmissive.is_black());
}

TEST(MetallicRoughness, InsideAVolumeBeyondTheCriticalAngleAllIsReflected) {
    MetallicRoughness p = parameters(0, 0);
    p.transmission.value = 1;
    p.thickness.value = 1;
    const double critical = std::sqrt(1 - 1 / 2.25);
    MaterialSample beyond = sample_of(with(p));
    turn_to_view(beyond, critical - 0.01, true);
    expect_near(beyond.reflective, {1, 1, 1});
    EXPECT_TRUE(beyond.transmissive.is_black());
    MaterialSample above = sample_of(with(p));
    turn_to_view(above, 1.0, true);
    expect_near(above.reflective, {0.04, 0.04, 0.04});
}

TEST(MetallicRoughness, AWallBetweenTwoMediaReflectsByTheirRatio) {
    MetallicRoughness p = parameters(0, 0);
    p.transmission.value = 1;
    p.thickness.value = 1;
    const double ratio = 1.5 / 1.33, r = (ratio - 1) / (ratio + 1);
    MaterialSample across = sample_of(with(p));
    turn_to_view_between(across, 1.0, ratio, true);
    expect_near(across.reflective, {r * r, r * r, r * r});
    MaterialSample beyond = sample_of(with(p));
    turn_to_view_between(beyond, std::sqrt(1 - 1 / (ratio * ratio)) - 0.01, ratio, true);
    expect_near(beyond.reflective, {1, 1, 1});
    MaterialSample alike = sample_of(with(p));
    turn_to_view_between(alike, 1.0, 1.0, true);
    expect_near(alike.reflective, {0, 0, 0});
}

TEST(MetallicRoughness, UnlitShowsItsColourAndNothingElse) {
    MetallicRoughness p = parameters(0, 0);
    p.unlit = true;
    const MaterialSample s = sample_of(with(p), {{}, {}, {0.5, 1, 1, 1}});
    EXPECT_TRUE(s.unlit);
    expect_near(s.emission, {0.4, 0.4, 0.2});
    EXPECT_TRUE(s.diffuse.is_black() && s.ambient.is_black() && s.reflective.is_black());
}

TEST(MetallicRoughness, EmissionIsNotClamped) {
    Material m = with(parameters(0, 1));
    m.emission.color = {5, 6, 7};
    expect_near(sample_of(m).emission, {5, 6, 7});
}

TEST(AlphaModes, MaskCutsAndBlendCovers) {
    Material m;
    m.alpha.value = 0.4;
    EXPECT_EQ(sample_of(m).coverage, 1.0);
    m.alpha_mode = AlphaMode::Mask;
    EXPECT_EQ(sample_of(m).coverage, 0.0);
    m.alpha_cutoff = 0.4;
    EXPECT_EQ(sample_of(m).coverage, 1.0);
    m.alpha_mode = AlphaMode::Blend;
    EXPECT_EQ(sample_of(m).coverage, 0.4);
    EXPECT_EQ(sample_of(m, {{}, {}, {1, 1, 1, 0.5}}).coverage, 0.2);
}

Texture one_texel(std::vector<float> samples) {
    Image image(1, 1, int(samples.size()));
    image.samples = std::move(samples);
    ImageTexture t;
    t.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    return t;
}

TEST(MetallicRoughness, ChannelsOfTexturesGoWhereTheyBelong) {
    const std::vector<Texture> textures{one_texel({0.25f, 0.5f, 0.75f}),
                                        one_texel({0.5f, 0.5f, 0.5f, 0.125f})};
    MetallicRoughness p = parameters(1, 1);
    p.metallic.texture = p.roughness.texture = p.occlusion.texture = TextureId{0};
    p.occlusion.value = 0.5;
    Material m = with(p);
    m.alpha_mode = AlphaMode::Blend;
    m.alpha.texture = TextureId{1};
    const MaterialSample s = evaluate(m, textures, SurfaceLookup{});
    EXPECT_NEAR(s.shininess, 2 / 0.0625 - 2, 1e-9);         // roughness 0.5 from green
    EXPECT_NEAR(s.grazing.r, std::pow(0.5, 4), 1e-12);      // no texture of specular: 1
    EXPECT_NEAR(s.occlusion, 1 + 0.5 * (0.25 - 1), 1e-12);  // red
    EXPECT_EQ(s.coverage, 0.125);
}

TEST(MetallicRoughness, AVolumeStaysOneWhereTheTextureOfItsThicknessIsBlack) {
    const Texture black = one_texel({0, 0, 0});
    MetallicRoughness p = parameters(0, 0);
    p.transmission.value = 1;
    p.thickness = {1, TextureId{0}, Channel::Green};
    EXPECT_FALSE(evaluate(with(p), std::span(&black, 1), SurfaceLookup{}).thin);
}

TEST(MetallicRoughness, ATextureOfTheIndexIsItsNumber) {
    const Texture half = one_texel({0.5f, 0.5f, 0.5f});
    MetallicRoughness clear = parameters(0, 0.1);
    clear.transmission.value = clear.thickness.value = 1;
    Material body, gold;
    body.dielectric.emplace();
    gold.conductor = Conductor{{0.2, 0.4, 1.3}, {3.4, 2.4, 1.8}, ""};
    for (Material m : {with(parameters(0.25, 0.1)), with(clear), body, gold}) {
        m.index = {1.5, kNoTexture};
        const MaterialSample number = sample_of(m);
        m.index = {3.0, TextureId{0}};
        const MaterialSample texture = evaluate(m, std::span(&half, 1), SurfaceLookup{});
        EXPECT_EQ(texture.index, 1.5);
        EXPECT_EQ(texture.reflective, number.reflective);
        EXPECT_EQ(texture.specular, number.specular);
        EXPECT_EQ(texture.thin, number.thin);
    }
}

TEST(MetallicRoughness, TheSecondSetAndTheTransformOfCoordinatesAreUsed) {
    Image image(2, 1, 1);
    image.samples = {0.25f, 0.75f};
    ImageTexture t;
    t.image = std::make_shared<const StoredImage>(stored(std::move(image)));
    t.filter = TextureFilter::Nearest;
    t.uv_set = 1;
    Material m;
    m.diffuse = {{1, 1, 1}, TextureId{0}};
    const auto red = [&](Vec2 first, Vec2 second) {
        const Texture texture = t;
        return evaluate(m, std::span(&texture, 1), SurfaceLookup{{first, second}, {}, {1, 1, 1, 1}})
            .diffuse.r;
    };
    EXPECT_EQ(red({0.25, 0}, {0.75, 0}), 0.75);
    t.uv_transform.offset = {0.5, 0};
    EXPECT_EQ(red({0.25, 0}, {0.75, 0}), 0.25);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
