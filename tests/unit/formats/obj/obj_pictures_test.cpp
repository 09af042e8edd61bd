/// Pictures of the materials of an OBJ file: textures, bumps, normals.

#include <gtest/gtest.h>

#include "alhazen/imaging/codecs/image_io.h"
#include "support/image_texture.h"
#include "unit/formats/import_text.h"
#include "unit/formats/obj/obj_texts.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::kObjSquare;
using testing::mentions;
using testing::obj_scene;
using testing::TemporaryFolder;
using testing::text_of;
using testing::WithPicture;

TEST(ObjScene, PicturesAreFoundWithBlanksOptionsAndOtherCapitals) {
    for (const char* name :
         {"my pic.png", "MY PIC.PNG", "-o 0.25 .5 -s 2 3 1 my pic.png", "my pic.png -bm 1.5",
          "-blendu on -blendv off -mm 0 1 -imfchan r -texres 64 -cc on my pic.png",
          "..\\lib\\my pic.png", "C:\\art\\textures\\my pic.png", "\"my pic.png\"",
          "/home/me/my pic.png"}) {
        const WithPicture s("map_Kd " + std::string(name) + "\nKd 0 0 0\n");
        ASSERT_EQ(s.scene.textures.size(), 1u) << name << text_of(s.found);
        EXPECT_EQ(s.material().diffuse.color, (Rgb{1, 1, 1})) << name;
        EXPECT_EQ(s.texture(s.material().diffuse.texture).decode_srgb, true);
        EXPECT_EQ(s.material().ambient.texture, s.material().diffuse.texture);
        if (std::string(name).starts_with("-o")) {
            const UvTransform& t = s.texture(s.material().diffuse.texture).uv_transform;
            EXPECT_EQ(t.apply({1, 1}), (Vec2{2.25, 3.5}));
        }
    }
}

TEST(ObjScene, AnAmbientPictureCountsAloneBesideABlackOrMissingColour) {
    for (const char* black : {"", "Ka 0 0 0\n"}) {
        const WithPicture s(black + std::string("Kd .5 .5 .5\nmap_Ka my pic.png\n"));
        EXPECT_EQ(text_of(s.found), "");
        EXPECT_EQ(s.material().ambient.color, (Rgb{1, 1, 1}));
        ASSERT_NE(s.material().ambient.texture, kNoTexture);
        EXPECT_EQ(s.material().diffuse.texture, kNoTexture);
        // Without the picture the ambient colour is the diffuse one.
        const WithPicture gone(black + std::string("Kd .5 .5 .5\nmap_Ka gone.png\n"));
        EXPECT_TRUE(mentions(gone.found, "'gone.png'")) << text_of(gone.found);
        EXPECT_EQ(gone.material().ambient.color, (Rgb{.5, .5, .5}));
    }
    const WithPicture both("Ka .25 .5 1\nmap_Ka my pic.png\nKd 1 1 1\n");
    EXPECT_EQ(both.material().ambient.color, (Rgb{.25, .5, 1}));
    EXPECT_NE(both.material().ambient.texture, kNoTexture);
}

TEST(ObjScene, FacesWithoutCoordinatesHaveThePicturesAtTheOrigin) {
    const TemporaryFolder folder;
    Image image(2, 2, 3);
    write_image(folder.path() / "p.png", image, {});
    folder.write("a.mtl", "newmtl m\nKd 1 1 1\nmap_Kd p.png\nnewmtl plain\nKd 1 1 1\n");
    const std::string start = "mtllib a.mtl\n" + kObjSquare + "vt .75 .25\n";
    const auto uvs_of = [&](const std::string& faces, bool told) {
        Diagnostics found;
        const SceneDescription scene = obj_scene(start + faces, found, folder.path());
        EXPECT_EQ(found.warning_count(), told ? 1u : 0u) << faces << text_of(found);
        EXPECT_EQ(mentions(found, "a.obj:8: warning: the mesh 'm' has faces without texture"), told)
            << text_of(found);
        Diagnostics none;
        validate(scene, none);
        EXPECT_EQ(text_of(none), "");
        return scene.meshes.at(0).mesh->uvs;
    };
    EXPECT_EQ(uvs_of("usemtl m\nf 1 2 3 4\n", true), std::vector<Vec2>(4));
    EXPECT_EQ(uvs_of("usemtl m\nf 1 2 3 4\nf 1/1 2/1 3/1\n", true),
              (std::vector<Vec2>{{}, {}, {}, {}, {.75, .25}, {.75, .25}, {.75, .25}}));
    EXPECT_EQ(uvs_of("usemtl m\nf 1/1 2/1 3/1\n", false), std::vector<Vec2>(3, {.75, .25}));
    EXPECT_TRUE(uvs_of("usemtl plain\nf 1 2 3 4\n", false).empty());
}

TEST(ObjScene, PicturesOfNumbersAreNotDecoded) {
    const WithPicture s(
        "Kd .5 .5 .5\nKs 1 1 1\nNs 10\nmap_Ns my pic.png\nmap_d -imfchan g my pic.png\n"
        "norm -bm 2 my pic.png\nmap_Pr -clamp on my pic.png\n");
    const Material& m = s.material();
    EXPECT_EQ(text_of(s.found), "");
    EXPECT_EQ(m.alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(m.alpha.channel, Channel::Green);
    EXPECT_EQ(m.normal_map.scale, 2.0);
    EXPECT_FALSE(s.texture(m.normal_map.texture).decode_srgb);
    EXPECT_FALSE(s.texture(m.shininess.texture).decode_srgb);
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(s.texture(m.metallic_roughness->roughness.texture).wrap_u, Wrap::Clamp);
}

/// An OBJ with materials "m0", "m1" ... of these statements, a height map h.png (a ramp), and a
/// normal map n.png.
struct WithBumps {
    TemporaryFolder folder;
    Diagnostics found;
    SceneDescription scene;
    explicit WithBumps(const std::vector<std::string>& materials) {
        Image heights(8, 4, 1), directions(8, 4, 3);
        heights.linear = directions.linear = false;
        for (int x = 0; x < 8; ++x) {
            for (int y = 0; y < 4; ++y) {
                *heights.pixel(x, y) = float(x) / 8;
                for (int k = 0; k < 3; ++k) directions.pixel(x, y)[k] = k == 2 ? 1.0f : 0.5f;
            }
        }
        write_image(folder.path() / "h.png", heights, {});
        write_image(folder.path() / "n.png", directions, {});
        std::string mtl, obj = "mtllib a.mtl\n" + kObjSquare + "vt 0 0\n";
        for (std::size_t i = 0; i < materials.size(); ++i) {
            const std::string name = "m" + std::to_string(i) + "\n";
            mtl += "newmtl " + name + "Kd 1 1 1\n" + materials[i];
            obj += "usemtl " + name + "f 1/1 2/1 3/1\n";
        }
        folder.write("a.mtl", mtl);
        scene = obj_scene(obj, found, folder.path());
        EXPECT_EQ(text_of(found), "");
    }
    [[nodiscard]] const NormalMap& map(std::size_t i) const {
        return scene.materials.at(i).material.normal_map;
    }
    [[nodiscard]] const ImageTexture& texture(std::size_t i) const {
        return testing::image_texture(scene.textures.at(std::size_t(map(i).texture)));
    }
};

TEST(ObjScene, HeightsBecomeNormalsOnceForEachStrength) {
    const WithBumps s({"bump h.png\n", "map_Bump -s 2 2 2 h.png\n", "map_bump h.png -bm 3\n",
                       "map_bump -clamp on h.png\n", "map_bump -imfchan m h.png\n",
                       "map_bump h.png -bm 0\n"});
    EXPECT_EQ(s.texture(0).image, s.texture(1).image);
    EXPECT_EQ(s.texture(1).uv_transform.uu, 2.0);
    EXPECT_NE(s.texture(2).image, s.texture(0).image);
    EXPECT_NE(s.texture(3).image, s.texture(0).image);
    EXPECT_EQ(s.texture(3).wrap_u, Wrap::Clamp);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(s.map(i).scale, 1.0);
        EXPECT_FALSE(s.texture(i).decode_srgb);
        EXPECT_EQ(s.texture(i).image->channels, 3);
        EXPECT_EQ(s.texture(i).image->width, 8);
    }
    // The heights rise to the right, so the normals lean to the left; alpha is 1 everywhere.
    EXPECT_LT(s.texture(0).image->pixel(9, false).r, 0.5);
    EXPECT_LT(s.texture(2).image->pixel(9, false).r, s.texture(0).image->pixel(9, false).r);
    EXPECT_NEAR(s.texture(4).image->pixel(9, false).r, 0.5, 0.003);
    EXPECT_EQ(s.map(5).texture, kNoTexture);
}

TEST(ObjScene, BumpMapsOfDirectionsAreNormalMaps) {
    const WithBumps s({"map_bump -bm 0.5 n.png\n", "norm -bm 2 h.png\n", "norm n.png\nbump h.png\n",
                       "bump h.png\nnorm gone/../n.png\n", "map_bump -imfchan b n.png\n"});
    EXPECT_EQ(s.map(0).scale, 0.5);
    EXPECT_EQ(s.texture(0).image->pixel(0, false).b, 1.0);
    EXPECT_EQ(s.map(1).scale, 2.0);  // declared as a normal map
    EXPECT_EQ(s.texture(1).image->channels, 1);
    EXPECT_EQ(s.texture(2).image, s.texture(0).image);
    EXPECT_EQ(s.texture(3).image, s.texture(0).image);
    EXPECT_NE(s.texture(4).image, s.texture(0).image);  // a selected channel implies heights
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
