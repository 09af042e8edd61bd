/// Conversion of materials and textures of glTF files.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/formats/gltf/scene/gltf_textures.h"
#include "support/image_texture.h"
#include "unit/formats/gltf/gltf_nodes_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

TEST(GltfMaterial, KeepsWhatTheFileSays) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_ior", "KHR_materials_emissive_strength",
          "KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_specular"],
        "materials": [{"name": "m", "alphaMode": "MASK", "alphaCutoff": 0.25,
          "emissiveFactor": [1, 0.5, 0],
          "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5,
            "roughnessFactor": 0.6},
          "extensions": {"KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_emissive_strength": {"emissiveStrength": 4},
            "KHR_materials_transmission": {"transmissionFactor": 0.7},
            "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 3,
              "attenuationColor": [0.5, 0.6, 0.7]},
            "KHR_materials_specular": {"specularFactor": 0.8, "specularColorFactor": [1, 0, 1]}}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    // Which renderers leave rough transmission sharp is said by the session.
    EXPECT_EQ(result.messages().find("rough"), std::string::npos) << result.messages();
    // One material, and the default one of the primitive without a material.
    ASSERT_EQ(result.scene.materials.size(), 2u);
    const Material& m = result.scene.materials[0].material;
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(m.alpha_cutoff, 0.25);
    EXPECT_EQ(m.alpha.value, 0.4);
    EXPECT_FALSE(m.double_sided);
    EXPECT_EQ(m.emission.color, (Rgb{4, 2, 0}));
    EXPECT_EQ(m.index.value, 1.4);
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(m.metallic_roughness->base_color.color, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(m.metallic_roughness->metallic.value, 0.5);
    EXPECT_EQ(m.metallic_roughness->roughness.value, 0.6);
    EXPECT_EQ(m.metallic_roughness->transmission.value, 0.7);
    EXPECT_EQ(m.metallic_roughness->thickness.value, 2);
    EXPECT_EQ(m.metallic_roughness->attenuation_distance, 3);
    EXPECT_EQ(m.metallic_roughness->attenuation_color, (Rgb{0.5, 0.6, 0.7}));
    EXPECT_EQ(m.metallic_roughness->specular.value, 0.8);
    EXPECT_EQ(m.metallic_roughness->specular_color.color, (Rgb{1, 0, 1}));
    const Material& plain = result.scene.materials[1].material;
    ASSERT_TRUE(plain.metallic_roughness);
    EXPECT_EQ(plain.metallic_roughness->metallic.value, 1);
    EXPECT_EQ(plain.index.value, 1.5);
}

/// A PNG of one white pixel.
constexpr const char* kPng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAA"
    "AACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg==";

/// A PNG of two pixels: (255, 128, 0) with an alpha of 51, (0, 0, 255) with one of 255.
constexpr const char* kGlossPng =
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAEUlEQVR4nGP4"
    "38BgzMDw/z8AD30Dsbg6hgUAAAAASUVORK5CYII=";

TEST(GltfMaterial, SpecularGlossinessIsADielectricThatReflectsItsSpecularColour) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", std::string(R"(,
        "extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],
        "extensionsRequired": ["KHR_materials_pbrSpecularGlossiness"],
        "images": [{"uri": ")") + kGlossPng + R"("}], "textures": [{"source": 0}],
        "materials": [
          {"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1], "roughnessFactor": 0.9},
           "extensions": {"KHR_materials_pbrSpecularGlossiness": {
             "diffuseFactor": [0.1, 0.2, 0.3, 0.4], "specularFactor": [0.5, 0.6, 0.7],
             "glossinessFactor": 0.75}}},
          {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
             "diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 0},
             "glossinessFactor": 0.5}}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_FALSE(result.says("not supported")) << result.messages();
    const Material& plain = result.scene.materials.at(0).material;
    ASSERT_TRUE(plain.metallic_roughness);
    EXPECT_EQ(plain.metallic_roughness->base_color.color, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(plain.metallic_roughness->metallic.value, 0.0);
    EXPECT_EQ(plain.metallic_roughness->roughness.value, 0.25);
    EXPECT_EQ(plain.metallic_roughness->specular_color.color, (Rgb{0.5, 0.6, 0.7}));
    EXPECT_EQ(plain.alpha.value, 0.4);
    // At normal incidence it reflects all light, times the specular colour.
    EXPECT_EQ(plain.index.value, 0.0);
    const MetallicRoughness& of_pictures =
        *result.scene.materials.at(1).material.metallic_roughness;
    const auto texture = [&](TextureId id) {
        return testing::image_texture(result.scene.textures.at(std::size_t(id)));
    };
    EXPECT_TRUE(texture(of_pictures.base_color.texture).decode_srgb);
    EXPECT_EQ(of_pictures.specular_color.texture, of_pictures.base_color.texture);
    EXPECT_EQ(of_pictures.roughness.value, 1.0);
    const StoredImage& roughness = *texture(of_pictures.roughness.texture).image;
    EXPECT_NEAR(roughness.pixel(0, false).g, 1.0 - 0.5 * 51.0 / 255.0, 0.5 / 255.0);
    EXPECT_NEAR(roughness.pixel(1, false).g, 0.5, 0.51 / 255.0);
}

TEST(GltfMaterial, AScatteringVolumeSharesItsAttenuation) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_volume", "KHR_materials_volume_scatter",
          "KHR_materials_diffuse_transmission"],
        "materials": [{"extensions": {
          "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
          "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
            "attenuationColor": [0.5, 0.25, 0]},
          "KHR_materials_volume_scatter": {"multiscatterColor": [0, 0.5, 1],
            "scatterAnisotropy": 0.3}}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    const Material& m = result.scene.materials.at(0).material;
    EXPECT_EQ(m.scattering.anisotropy, 0.3);
    // Scattering and absorption together give the attenuation of the file.
    const Rgb attenuation{-std::log(0.5) / 2, -std::log(0.25) / 2, -std::log(1e-12) / 2};
    for (int i = 0; i < 3; ++i) {
        const double absorbed = -std::log(m.metallic_roughness->attenuation_color[i]) / 2;
        EXPECT_NEAR(absorbed + m.scattering.coefficient[i], attenuation[i], 1e-9) << i;
    }
    EXPECT_NEAR(m.scattering.coefficient.r, 0.0, 1e-5);
    // An albedo of 1/2 of a deep volume is one of about 0.91 of each scattering.
    const double single =
        1 - std::pow(4.09712 + 4.20863 / 2 - std::sqrt(9.59217 + 41.6808 / 2 + 17.7126 / 4), 2);
    EXPECT_NEAR(m.scattering.coefficient.g / attenuation.g, single, 1e-12);
    EXPECT_NEAR(m.scattering.coefficient.b / attenuation.b, 1.0, 1e-4);
}

TEST(GltfMaterial, VolumesWithoutEffectAreNamed) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_volume", "KHR_materials_volume_scatter",
          "KHR_materials_pbrSpecularGlossiness"],
        "materials": [
          {"extensions": {
            "KHR_materials_volume": {"thicknessFactor": 1},
            "KHR_materials_volume_scatter": {"multiscatterColor": [0, 0.5, 1]}}},
          {"extensions": {
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1},
            "KHR_materials_pbrSpecularGlossiness": {}}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_TRUE(result.says("has no effect without an attenuationDistance")) << result.messages();
    EXPECT_TRUE(result.says("has no effect beside it")) << result.messages();
}

TEST(GltfMaterial, AnisotropyOfScatteringIsBelowOne) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_volume_scatter"],
        "materials": [{"extensions": {"KHR_materials_volume_scatter": {"scatterAnisotropy": 1}}}])"));
    EXPECT_TRUE(result.says("above -1 and below 1")) << result.messages();
}

std::string with_picture(const std::string& uri) {
    return with_nodes(R"({"mesh": 0})", "0",
                      R"(, "images": [{"name": "pic", "uri": ")" + uri +
                          R"("}], "samplers": [{"wrapS": 33071, "wrapT": 33648, "minFilter": 9728,
          "magFilter": 9728}],
        "textures": [{"source": 0, "sampler": 0}], "materials": [{
          "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1},
            "metallicRoughnessTexture": {"index": 0}},
          "normalTexture": {"index": 0, "scale": 2},
          "occlusionTexture": {"index": 0, "strength": 0.5}}])");
}

TEST(GltfMaterial, TexturesShareTheirPictureAndKeepTheirUse) {
    const Imported result = import_gltf(with_picture(kPng));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    const Material& m = result.scene.materials.at(0).material;
    const auto texture = [&](TextureId id) {
        return testing::image_texture(result.scene.textures.at(std::size_t(id)));
    };
    ASSERT_TRUE(m.metallic_roughness);
    const ImageTexture base = texture(m.metallic_roughness->base_color.texture);
    EXPECT_TRUE(base.decode_srgb);
    EXPECT_EQ(base.uv_set, 1);
    EXPECT_EQ(base.wrap_u, Wrap::Clamp);
    EXPECT_EQ(base.wrap_v, Wrap::Mirror);
    EXPECT_EQ(base.filter, TextureFilter::Nearest);
    EXPECT_EQ(m.alpha.texture, m.metallic_roughness->base_color.texture);
    const ImageTexture normal = texture(m.normal_map.texture);
    EXPECT_FALSE(normal.decode_srgb);
    EXPECT_EQ(normal.image, base.image);
    EXPECT_EQ(m.normal_map.scale, 2);
    EXPECT_EQ(m.metallic_roughness->occlusion.value, 0.5);
    EXPECT_EQ(m.metallic_roughness->metallic.channel, Channel::Blue);
    EXPECT_EQ(m.metallic_roughness->roughness.channel, Channel::Green);
    EXPECT_EQ(m.metallic_roughness->metallic.texture, m.metallic_roughness->roughness.texture);
    // The base colour, and the linear texture that three inputs share.
    EXPECT_EQ(result.scene.textures.size(), 2u);
}

TEST(GltfMaterial, AMissingPictureIsAnErrorThatNamesIt) {
    const Imported result = import_gltf(with_picture("gone.png"));
    EXPECT_GT(result.errors(), 0u);
    EXPECT_TRUE(result.says("gone.png")) << result.messages();
}

TEST(GltfMaterial, APictureOutsideOfTheFolderIsAnError) {
    const Imported result = import_gltf(with_picture("../../../gone.png"));
    EXPECT_GT(result.errors(), 0u);
    EXPECT_TRUE(result.says("--allow-path")) << result.messages();
}

TEST(GltfTextures, TransformsAreRestatedForUpwardV) {
    gltf::TextureInfo info;
    EXPECT_EQ(gltf::uv_transform(info), UvTransform{});
    info.offset = {-0.2, 0.1};
    info.scale = {1.5, 3};
    info.rotation = 0.3;
    const UvTransform transform = gltf::uv_transform(info);
    for (const Vec2 st : {Vec2{0, 0}, {1, 0}, {0, 1}, {0.25, 0.75}}) {
        const double x = 1.5 * st.x, y = 3 * st.y;
        const double s = -0.2 + std::cos(0.3) * x + std::sin(0.3) * y;
        const double t = 0.1 - std::sin(0.3) * x + std::cos(0.3) * y;
        const Vec2 uv = transform.apply({st.x, 1 - st.y});
        EXPECT_NEAR(uv.x, s, 1e-12);
        EXPECT_NEAR(uv.y, 1 - t, 1e-12);
    }
}

TEST(GltfTextures, FiltersFollowTheSampler) {
    using gltf::Filter;
    EXPECT_EQ(gltf::filter_of({}), TextureFilter::Mipmapped);
    EXPECT_EQ(gltf::filter_of({Filter::Linear, Filter::LinearMipmap}), TextureFilter::Mipmapped);
    for (const Filter minify :
         {Filter::Unset, Filter::Linear, Filter::NearestMipmap, Filter::LinearMipmap}) {
        EXPECT_EQ(gltf::filter_of({Filter::Nearest, minify}), TextureFilter::NearestMipmapped);
    }
    EXPECT_EQ(gltf::filter_of({Filter::Unset, Filter::Linear}), TextureFilter::Bilinear);
    EXPECT_EQ(gltf::filter_of({Filter::Nearest, Filter::Nearest}), TextureFilter::Nearest);
    EXPECT_EQ(gltf::filter_of({Filter::Linear, Filter::Nearest}), TextureFilter::Bilinear);
}

TEST(GltfMaterial, LayersOfTheExtensionsAreKept) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0})", "0", R"(,
        "extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_sheen",
          "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_dispersion",
          "KHR_materials_diffuse_transmission"],
        "materials": [{"extensions": {
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.7, "clearcoatRoughnessFactor": 0.2},
            "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3],
                                    "sheenRoughnessFactor": 0.4},
            "KHR_materials_iridescence": {"iridescenceFactor": 0.9, "iridescenceIor": 1.4,
                "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 600},
            "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 0.25},
            "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.6,
                "diffuseTransmissionColorFactor": [0.4, 0.5, 0.6]},
            "KHR_materials_dispersion": {"dispersion": 0.1}}}])"));
    EXPECT_EQ(result.messages().find("left out"), std::string::npos) << result.messages();
    const MetallicRoughness& p = *result.scene.materials.at(0).material.metallic_roughness;
    EXPECT_EQ(p.coat.strength.value, 0.7);
    EXPECT_EQ(p.coat.roughness.value, 0.2);
    EXPECT_EQ(p.sheen.color.color, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(p.sheen.roughness.value, 0.4);
    EXPECT_EQ(p.film.strength.value, 0.9);
    EXPECT_EQ(p.film.index, 1.4);
    EXPECT_EQ(p.film.thinnest_nm, 50);
    EXPECT_EQ(p.film.thickest_nm, 600);
    EXPECT_EQ(p.anisotropy.strength, 0.5);
    EXPECT_EQ(p.anisotropy.rotation, 0.25);
    EXPECT_EQ(p.diffuse_transmission.share.value, 0.6);
    EXPECT_EQ(p.diffuse_transmission.color.color, (Rgb{0.4, 0.5, 0.6}));
    EXPECT_EQ(p.dispersion, 0.1);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
