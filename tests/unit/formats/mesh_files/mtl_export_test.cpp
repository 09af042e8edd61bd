/// Materials written as MTL and read back.

#include <gtest/gtest.h>

#include <algorithm>

#include "alhazen/formats/mesh_files/mesh_export.h"
#include "alhazen/formats/obj/mtl_reader.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::text_of;

TEST(MeshExport, MaterialsReadBackAsTheyWere) {
    Material matt;
    matt.name = "matt";
    matt.diffuse.color = {.1, .2, .3};
    matt.ambient.color = {.3, .2, .1};
    matt.specular.color = {.5, .5, .5};
    matt.shininess.value = 20;
    Material glass;
    glass.name = "glass";
    glass.reflective.color = {.2, .2, .2};
    glass.transmissive.color = {.8, .9, 1};
    glass.index.value = 1.5;
    Material leaf;
    leaf.name = "leaf";
    leaf.diffuse = {{1, 1, 1}, TextureId{1}};
    leaf.alpha_mode = AlphaMode::Blend;
    leaf.alpha.value = 0.5;
    const std::vector<Material> all{matt, glass, leaf};
    ImageTexture settings;
    settings.filter = TextureFilter::Mipmapped;
    const std::vector<MtlTexture> textures{{"", settings}, {"leaf picture.png", settings}};
    Diagnostics found;
    std::vector<std::string> lost;
    const std::vector<MtlMaterial> back = read_mtl(mtl_text(all, textures, lost), "a.mtl", found);
    EXPECT_TRUE(lost.empty()) << lost[0];
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(back.size(), 3u);
    EXPECT_EQ(back[0].kd, matt.diffuse.color);
    EXPECT_EQ(back[0].ka, matt.ambient.color);
    EXPECT_EQ(back[0].ns, 20.0);
    EXPECT_EQ(back[0].illum, 2);
    EXPECT_EQ(back[1].tf, glass.transmissive.color);
    EXPECT_EQ(back[1].ks, glass.reflective.color);
    EXPECT_EQ(back[1].illum, 7);
    EXPECT_EQ(back[1].ni, 1.5);
    EXPECT_EQ(back[2].map_kd.file, "leaf picture.png");
    EXPECT_EQ(back[2].d, 0.5);
}

/// MTL statements of a material with one texture, the material read back, and the reported losses.
struct MtlTrip {
    std::vector<std::string> lost;
    std::vector<MtlMaterial> back;

    explicit MtlTrip(const ImageTexture& settings, Material m = {}) {
        m.name = "m";
        m.diffuse = {{.5, .5, .5}, TextureId{0}};
        if (m.metallic_roughness) m.metallic_roughness->base_color = m.diffuse;
        const std::vector<MtlTexture> textures{{"p.png", settings}};
        Diagnostics found;
        back = read_mtl(mtl_text({&m, 1}, textures, lost), "a.mtl", found);
        EXPECT_EQ(text_of(found), "");
        EXPECT_EQ(back.at(0).map_kd.file, "p.png");
    }
    [[nodiscard]] const MtlMap& map() const { return back[0].map_kd; }
    [[nodiscard]] bool loses(const std::string& part) const {
        return std::any_of(lost.begin(), lost.end(), [&](const std::string& line) {
            return line.find(part) != std::string::npos;
        });
    }
};

TEST(MeshExport, MtlKeepsTheScaleOffsetAndClampOfPictures) {
    ImageTexture settings;
    settings.filter = TextureFilter::Mipmapped;
    settings.wrap_u = settings.wrap_v = Wrap::Clamp;
    settings.uv_transform = {-2.5, 0, 0, 0.1, {0.25, -1e-3}};
    const MtlTrip trip(settings);
    EXPECT_EQ(trip.map().scale, (Vec2{-2.5, 0.1}));
    EXPECT_EQ(trip.map().offset, (Vec2{0.25, -1e-3}));
    EXPECT_TRUE(trip.map().clamp);
    EXPECT_TRUE(trip.lost.empty()) << trip.lost[0];
    settings.wrap_u = settings.wrap_v = Wrap::Repeat;
    EXPECT_FALSE(MtlTrip(settings).map().clamp);
}

TEST(MeshExport, WhatMtlCannotSayIsTold) {
    ImageTexture usual;
    usual.filter = TextureFilter::Mipmapped;
    EXPECT_TRUE(MtlTrip(usual).lost.empty());
    ImageTexture t = usual;
    t.uv_transform.uv = 0.5;
    EXPECT_TRUE(MtlTrip(t).loses("rotation"));
    t = usual;
    t.wrap_v = Wrap::Mirror;
    EXPECT_TRUE(MtlTrip(t).loses("mirrored"));
    t = usual;
    t.wrap_v = Wrap::Clamp;
    EXPECT_TRUE(MtlTrip(t).loses("one axis only"));
    t = usual;
    t.uv_set = 1;
    EXPECT_TRUE(MtlTrip(t).loses("second set"));
    t = usual;
    t.filter = TextureFilter::Nearest;
    EXPECT_TRUE(MtlTrip(t).loses("filter"));
    t = usual;
    t.image =
        std::make_shared<StoredImage>(StoredImage{1, 1, 1, false, std::vector<std::uint8_t>{7}});
    EXPECT_TRUE(MtlTrip(t).loses("linear"));
    t.decode_srgb = true;
    EXPECT_TRUE(MtlTrip(t).lost.empty());

    Material m;
    m.transmissive = {{1, 1, 1}, TextureId{0}};
    EXPECT_TRUE(MtlTrip(usual, m).loses("the texture of Tf"));
    m = {};
    m.double_sided = false;
    EXPECT_EQ(MtlTrip(usual, m).lost.size(), 1u);
    m = {};
    m.metallic_roughness.emplace();
    m.metallic_roughness->occlusion.texture = TextureId{0};
    EXPECT_TRUE(MtlTrip(usual, m).loses("occlusion"));
}

TEST(MeshExport, EveryPropertyThatMtlLacksIsTold) {
    ImageTexture usual;
    usual.filter = TextureFilter::Mipmapped;
    const auto told = [&](const char* part, auto change) {
        Material m;
        change(m);
        const MtlTrip trip(usual, m);
        EXPECT_EQ(trip.lost.size(), 1u) << part;
        EXPECT_TRUE(trip.loses(part)) << part;
    };
    const auto layered = [&](const char* part, auto change) {
        told(part, [&](Material& m) {
            m.metallic_roughness.emplace();
            change(*m.metallic_roughness);
        });
    };
    told("dispersion", [](Material& m) { m.dispersion = Dispersion{.abbe = 30}; });
    told("density", [](Material& m) { m.density = 3; });
    told("scattering", [](Material& m) { m.scattering.coefficient = {.5, .5, .5}; });
    told("spectrum", [](Material& m) { m.illuminant.emplace(); });
    told("the roughness of reflection", [](Material& m) {
        m.reflective.color = {.5, .5, .5};
        m.roughness.value = 0.4;
    });
    told("a highlight of exponent 0", [](Material& m) { m.specular.color = {.5, .5, .5}; });
    told("ambient colour without the texture", [](Material& m) { m.ambient.color = {.5, .5, .5}; });
    told("the alpha of a transparent body", [](Material& m) {
        m.transmissive.color = {.5, .5, .5};
        m.alpha_mode = AlphaMode::Blend;
        m.alpha.value = 0.5;
    });
    layered("sheen", [](MetallicRoughness& p) { p.sheen.color.color = {1, 0, 0}; });
    layered("film", [](MetallicRoughness& p) { p.film.strength.value = 1; });
    layered("anisotropy", [](MetallicRoughness& p) { p.anisotropy.strength = 0.8; });
    layered("diffuse transmission",
            [](MetallicRoughness& p) { p.diffuse_transmission.share.value = 0.7; });
    layered("dispersion", [](MetallicRoughness& p) { p.dispersion = 0.5; });
    layered("textures of the clear coat", [](MetallicRoughness& p) {
        p.coat.strength = {0.5, TextureId{0}};
    });
    layered("normal map of the clear coat", [](MetallicRoughness& p) {
        p.coat.strength.value = 0.5;
        p.coat.normal_map.texture = TextureId{0};
    });
    told("index of refraction below 1", [](Material& m) {
        m.metallic_roughness.emplace().metallic.value = 0;
        m.index.value = 0.5;
    });
    told("index of refraction below 1", [](Material& m) {
        m.metallic_roughness.emplace().metallic.texture = TextureId{0};
        m.index.value = 0.5;
    });
}

TEST(MeshExport, LossesAreToldOnceWithTheirNumber) {
    std::vector<Material> many(3);
    for (Material& m : many) m.double_sided = false;
    many[0].name = "first";
    std::vector<std::string> lost;
    (void)mtl_text(many, {}, lost);
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_EQ(lost[0], "single-sided visibility (material 'first', 3 times in all)");
}

TEST(MeshExport, BlackTimesAPictureStaysBlack) {
    ImageTexture settings;
    settings.filter = TextureFilter::Mipmapped;
    Material m;
    m.name = "m";
    m.diffuse = {{0, 0, 0}, TextureId{0}};
    const std::vector<MtlTexture> textures{{"p.png", settings}};
    std::vector<std::string> lost;
    Diagnostics found;
    const auto back = read_mtl(mtl_text({&m, 1}, textures, lost), "a.mtl", found);
    EXPECT_EQ(back.at(0).map_kd.file, "");
    EXPECT_EQ(back.at(0).kd, (Rgb{}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
