/// OBJ files as scenes: parts, names, materials, textures.

#include <gtest/gtest.h>

#include <chrono>

#include "alhazen/formats/obj/mtl_reader.h"
#include "alhazen/imaging/codecs/image_io.h"
#include "support/random.h"
#include "support/test_data.h"
#include "unit/formats/import_text.h"
#include "unit/formats/obj/obj_texts.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::kObjSquare;
using testing::mentions;
using testing::obj_scene;
using testing::TemporaryFolder;
using testing::text_of;
using testing::WithPicture;

/// The material of `usemtl m` with this MTL text.
Material material_of(const std::string& mtl, Diagnostics& found) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\n" + mtl);
    const SceneDescription scene =
        obj_scene("mtllib a.mtl\n" + kObjSquare + "usemtl m\nf 1 2 3 4\n", found, folder.path());
    EXPECT_EQ(found.error_count(), 0u) << text_of(found);
    return scene.materials.at(0).material;
}

Material material_of(const std::string& mtl) {
    Diagnostics found;
    const Material m = material_of(mtl, found);
    EXPECT_EQ(text_of(found), "") << mtl;
    return m;
}

TEST(ObjScene, PartsAreNamedByObjectGroupAndMaterialAndEqualOnesMerge) {
    Diagnostics found;
    const SceneDescription scene =
        obj_scene(kObjSquare +
                      "f 1 2 3\no box one\nf 1 2 3\ng lid\nf 1 2 4\nusemtl red\nf 1 3 4\ng side\n"
                      "f 2 3 4\ng lid\nf 1 2 3\no box two\nf 1 2 3\n",
                  found);
    std::vector<std::string> names;
    for (const Part& part : scene.objects.at(0).parts) names.push_back(part.name);
    EXPECT_EQ(names, (std::vector<std::string>{"a", "box one", "box one/lid", "box one/lid",
                                               "box one/side", "box two"}));
    EXPECT_EQ(scene.meshes.at(3).mesh->triangles.size(), 2u);
    EXPECT_TRUE(mentions(found, "no material library has 'red'")) << text_of(found);
    EXPECT_EQ(scene.materials.size(), 1u);
}

TEST(ObjScene, AMillionSwitchesOfMaterialAreTwoParts) {
    std::string text = kObjSquare;
    for (int i = 0; i < 500'000; ++i) text += "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n";
    Diagnostics found;
    const auto start = std::chrono::steady_clock::now();
    const SceneDescription scene = obj_scene(text, found);
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes.at(1).mesh->triangles.size(), 500'000u);
    EXPECT_LT(seconds, 30.0);
}

TEST(ObjScene, TooManyGroupsAreMergedByMaterial) {
    std::string text = kObjSquare;
    for (int i = 0; i < 150'000; ++i) text += "g " + std::to_string(i) + "\nf 1 2 3\n";
    Diagnostics found;
    const SceneDescription scene = obj_scene(text, found);
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes.at(0).mesh->triangles.size(), 150'000u);
    EXPECT_TRUE(mentions(found, "merged by material")) << text_of(found);
}

TEST(ObjScene, FilesWithoutFacesAreErrorsThatSaySo) {
    const auto finding = [](std::string_view text) {
        Diagnostics found;
        (void)import_text(text, "a.obj", found);
        EXPECT_GT(found.error_count(), 0u) << text;
        return text_of(found);
    };
    EXPECT_NE(finding(kObjSquare).find("4 points but no faces"), std::string::npos);
    EXPECT_NE(finding("").find("is empty"), std::string::npos);
    EXPECT_NE(finding(std::string_view("\x7f"
                                       "ELF\0\0",
                                       6))
                  .find("not text"),
              std::string::npos);
    EXPECT_NE(finding("dear reader\n").find("the file has no OBJ statement"), std::string::npos);
    EXPECT_NE(finding(std::string_view("\xFE\xFF\0v", 4)).find("UTF-16"), std::string::npos);
}

TEST(ObjScene, OtherTextsAreNotTakenForObj) {
    const auto importer = [](const std::string& text, const char* name) {
        const ImportOptions options;
        return std::string(find_importer({text, name, options}).name());
    };
    EXPECT_EQ(importer("v\nfrom 0 0 1\nat 0 0 0\nup 0 1 0\nangle 40\n", "a.txt"), "nff");
    EXPECT_EQ(importer("SBT-raytracer 1.0\n", "a.obj"), "ray");
    EXPECT_EQ(importer("# comment\ng\ng a b\ns off\nv 1 2 3\n", "a.txt"), "obj");
    EXPECT_EQ(importer("mtllib a.mtl\n", "a.txt"), "obj");
    EXPECT_EQ(importer("whatever", "A.OBJ"), "obj");
    EXPECT_THROW((void)importer("s o g", "a.txt"), Error);
}

TEST(ObjScene, CoefficientsFollowTheIlluminationModel) {
    const Material plain = material_of("Kd .1 .2 .3\nKa 0 0 0\nKs .4 .5 .6\nNs 20\nillum 2\n");
    EXPECT_EQ(plain.diffuse.color, (Rgb{.1, .2, .3}));
    EXPECT_EQ(plain.ambient.color, (Rgb{.1, .2, .3}));
    EXPECT_EQ(plain.specular.color, (Rgb{.4, .5, .6}));
    EXPECT_EQ(plain.shininess.value, 20.0);
    EXPECT_TRUE(plain.reflective.color.is_black());
    EXPECT_TRUE(plain.is_opaque());

    EXPECT_TRUE(material_of("Kd 1 1 1\nKs 1 1 1\nNs 9\nillum 1\n").specular.color.is_black());
    EXPECT_TRUE(material_of("Kd 1 1 1\nKs 1 1 1\nNs 0\n").specular.color.is_black());
    EXPECT_EQ(material_of("Ks .9 .9 .9\nillum 3\n").reflective.color, (Rgb{.9, .9, .9}));
    EXPECT_EQ(material_of("Ka .2 .2 .2\nKd 1 0 0\n").ambient.color, (Rgb{.2, .2, .2}));
    EXPECT_EQ(material_of("Ke 10 10 10\n").emission.color, (Rgb{10, 10, 10}));
    EXPECT_EQ(material_of("").diffuse.color, (Rgb{.7, .7, .7}));
    EXPECT_EQ(material_of("Kd .5\n").diffuse.color, (Rgb{.5, .5, .5}));
    Diagnostics found;
    EXPECT_EQ(material_of("Kd .5 .2\n", found).diffuse.color, (Rgb{.5, .2, .2}));
    EXPECT_TRUE(mentions(found, "a.mtl:2:1: warning: a colour of two numbers")) << text_of(found);

    const Material glass = material_of("Kd 0 0 0\nKs .3 .3 .3\nTf .9 .8 .7\nNi 1.5\nillum 7\n");
    EXPECT_EQ(glass.transmissive.color, (Rgb{.9, .8, .7}));
    EXPECT_EQ(glass.reflective.color, (Rgb{.3, .3, .3}));
    EXPECT_EQ(glass.index.value, 1.5);
    EXPECT_EQ(material_of("d .25\nillum 6\n").transmissive.color, (Rgb{.75, .75, .75}));
    EXPECT_TRUE(material_of("Tf 1 1 1\nd 1\nillum 2\n").transmissive.color.is_black());
    for (const char* illum : {"4", "6", "7", "9"}) {
        const std::string model = std::string("illum ") + illum + "\n";
        EXPECT_EQ(material_of("Tr 1\n" + model).transmissive.color, (Rgb{1, 1, 1})) << illum;
        EXPECT_EQ(material_of("Tr .5\n" + model).transmissive.color, (Rgb{.5, .5, .5}));
        EXPECT_EQ(material_of("Tf 1 0 0\nTr 1\n" + model).transmissive.color, (Rgb{1, 0, 0}));
        EXPECT_TRUE(material_of("Tr 0\n" + model).transmissive.color.is_black());
    }
}

TEST(ObjScene, DissolvedMaterialsAreBlended) {
    const Material d = material_of("Kd 1 1 1\nd .25\n");
    EXPECT_EQ(d.alpha_mode, AlphaMode::Blend);
    EXPECT_EQ(d.alpha.value, .25);
    EXPECT_EQ(material_of("Tr .25\n").alpha.value, .75);
    EXPECT_EQ(material_of("Tr 0\n").alpha_mode, AlphaMode::Opaque);
    EXPECT_EQ(material_of("d 1\nTr 1\n").alpha_mode, AlphaMode::Opaque);
    Diagnostics found;
    EXPECT_EQ(material_of("Tr 1\n", found).alpha_mode, AlphaMode::Opaque);
    EXPECT_TRUE(mentions(found, "invisible")) << text_of(found);
}

TEST(ObjScene, MetallicRoughnessStatementsAreKept) {
    const Material m = material_of("Kd .8 .1 .1\nPr .3\nPm 1\nKe .5 0 0\n");
    ASSERT_TRUE(m.metallic_roughness);
    EXPECT_EQ(m.metallic_roughness->base_color.color, (Rgb{.8, .1, .1}));
    EXPECT_EQ(m.metallic_roughness->roughness.value, .3);
    EXPECT_EQ(m.metallic_roughness->metallic.value, 1.0);
    EXPECT_EQ(m.emission.color, (Rgb{.5, 0, 0}));
    EXPECT_FALSE(material_of("Kd 1 1 1\n").metallic_roughness);
}

TEST(ObjScene, WhatIsMissingIsAWarningAndLeftOut) {
    const WithPicture picture("map_Kd gone.png\nbump lost.png\nKd .5 .5 .5\n");
    EXPECT_EQ(picture.material().diffuse.texture, kNoTexture);
    EXPECT_EQ(picture.material().diffuse.color, (Rgb{.5, .5, .5}));
    EXPECT_TRUE(mentions(picture.found, "a b.mtl:2:1: warning: the picture 'gone.png'"))
        << text_of(picture.found);
    EXPECT_TRUE(mentions(picture.found, "'lost.png'"));
    EXPECT_EQ(picture.material().normal_map.texture, kNoTexture);
    EXPECT_EQ(picture.found.error_count(), 0u);

    Diagnostics found;
    const TemporaryFolder folder;
    folder.write("one.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("two words.mtl", "newmtl b\nKd 0 1 0\n");
    folder.write("bad.png", "not a picture");
    folder.write("three.mtl", "newmtl c\nmap_Kd bad.png\n");
    const SceneDescription scene =
        obj_scene("mtllib one.mtl gone.mtl two\\ words.mtl three.mtl\n" + kObjSquare +
                      "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n",
                  found, folder.path());
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[1].material.diffuse.color, (Rgb{0, 1, 0}));
    EXPECT_TRUE(mentions(found, "the material file 'gone.mtl' does not exist")) << text_of(found);
    EXPECT_TRUE(mentions(found, "three.mtl:2:1: warning: texture:")) << text_of(found);
    EXPECT_EQ(found.error_count(), 0u);
}

TEST(ObjScene, ABackslashContinuesTheNumbersOfAMaterial) {
    EXPECT_EQ(material_of("Kd .5\\\n .25\\\r\n.125\n").diffuse.color, (Rgb{0.5, 0.25, 0.125}));
}

TEST(ObjScene, ACommentBehindTheNameOfAMaterialIsNoPartOfItUnlessItsNameHasIt) {
    Diagnostics found;
    const TemporaryFolder folder;
    folder.write("a.mtl",
                 "newmtl a # one\nKd 1 0 0\nnewmtl b\nKd 0 1 0\nnewmtl b #2\nKd 0 0 1\n"
                 "newmtl c\t#3\nKd 1 1 0\nnewmtl d#\nKd 1 0 1\n");
    const auto color = [&](const std::string& name) {
        const SceneDescription scene = obj_scene(
            "mtllib a.mtl\n" + kObjSquare + "usemtl " + name + "\nf 1 2 3\n", found, folder.path());
        return scene.materials.at(0).material.diffuse.color;
    };
    EXPECT_EQ(color("a"), (Rgb{1, 0, 0}));
    EXPECT_EQ(color("a # one"), (Rgb{1, 0, 0}));
    EXPECT_EQ(color("a  # another"), (Rgb{1, 0, 0}));
    EXPECT_EQ(color("b"), (Rgb{0, 1, 0}));
    EXPECT_EQ(color("b # note"), (Rgb{0, 1, 0}));
    EXPECT_EQ(color("b #2"), (Rgb{0, 0, 1}));
    EXPECT_EQ(color("c # note"), (Rgb{1, 1, 0}));
    EXPECT_EQ(color("d#"), (Rgb{1, 0, 1}));
    EXPECT_EQ(text_of(found), "");
}

TEST(ObjScene, NamesThatDifferByACommentAreOnePartOfOneMaterial) {
    const auto parts = [](const std::string& names, const std::string& mtl) {
        const TemporaryFolder folder;
        folder.write("a.mtl", mtl);
        Diagnostics found;
        const SceneDescription scene =
            obj_scene("mtllib a.mtl\n" + kObjSquare + names, found, folder.path());
        std::string text = std::to_string(scene.materials.size()) + ":";
        for (const MeshDescription& mesh : scene.meshes) {
            text += " '" + mesh.name + "' " + std::to_string(mesh.mesh->triangles.size());
        }
        return text;
    };
    const std::string face = "f 1 2 3\n", red = "newmtl m\nKd 1 0 0\n";
    const std::string two = "usemtl m # a\n" + face + "usemtl m\t# b\n" + face;
    EXPECT_EQ(parts(two, red), "1: 'm' 2");
    EXPECT_EQ(parts(two, "newmtl m # c\nKd 1 0 0\n"), "1: 'm' 2");
    EXPECT_EQ(parts(two, "newmtl m\nnewmtl m # a\n"), "2: 'm # a' 1 'm' 1");
    EXPECT_EQ(parts(two, "newmtl n\n"), "1: 'm' 2");
    EXPECT_EQ(parts("usemtl # m\n" + face, red), "1: 'a' 1");
    for (const std::string s : {"g", "o"}) {
        EXPECT_EQ(parts(s + " wheel # left\n" + face + s + " wheel  #\n" + face, red),
                  "1: 'wheel' 2");
        EXPECT_EQ(parts(s + " wheel #1\n" + face + s + " wheel #2\n" + face + s + " a#\n" + face +
                            s + " # c\n" + face,
                        red),
                  "1: 'wheel #1' 1 'wheel #2' 1 'a#' 1 'a' 1");
    }
    EXPECT_EQ(parts("o car # x\ng wheel # y\n" + face, red), "1: 'car/wheel' 1");
}

TEST(ObjScene, WhatALibraryHasThatIsUnknownOrOutOfRangeIsListedOnce) {
    const auto finding = [](const std::string& mtl) {
        Diagnostics found;
        (void)material_of(mtl, found);
        return text_of(found).substr(text_of(found).find("a.mtl"));
    };
    EXPECT_EQ(finding("Kd 1 0 0\nKdd 1 0 0\nmap_Kd\nNs -5\nillum 11\nKdd 2\nd 1.5\nPs .5\n"),
              "a.mtl:3:1: warning: unknown or out of range: 'Kdd', 'map_Kd (no file)', 'Ns -5', "
              "'illum 11', 'd 1.5', 'Ps'\n");
    std::string many;
    for (int i = 0; i < 1000; ++i) many += "X" + std::to_string(i) + " 1\n";
    EXPECT_NE(finding(many).find("'X18', 'X19' and others\n"), std::string::npos);
    EXPECT_EQ(material_of("Kd 1 0 0\nPs 0\naniso 0\nanisor 0.0\nPc 0\n").metallic_roughness,
              std::nullopt);
    const Material coated = material_of("Kd 1 0 0\nPc .5\nPcr .25\n");
    ASSERT_TRUE(coated.metallic_roughness);
    EXPECT_EQ(coated.metallic_roughness->coat.strength.value, 0.5);
    EXPECT_EQ(coated.metallic_roughness->coat.roughness.value, 0.25);
}

TEST(ObjScene, NegativeColoursHalosAndSecondMaterialsAreToldOf) {
    Diagnostics found;
    Material m = material_of("Kd 1.5 -0.2 0.5\n", found);
    EXPECT_TRUE(mentions(found, "unknown or out of range: 'Kd 1.5 -0.2 0.5'")) << text_of(found);
    EXPECT_EQ(m.diffuse.color, material_of("").diffuse.color);
    Diagnostics halo;
    m = material_of("d -halo 0.6\n", halo);
    EXPECT_EQ(m.alpha.value, 0.6);
    EXPECT_TRUE(mentions(halo, "-halo is ignored")) << text_of(halo);
    Diagnostics twice;
    m = material_of("Kd 1 0 0\nnewmtl m\nKd 0 1 0\n", twice);
    EXPECT_EQ(m.diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_TRUE(mentions(twice, "a.mtl:3:1: warning: a second material 'm'")) << text_of(twice);
}

TEST(ObjScene, ACommentMayFollowAFaceOrThePictureOfALibrary) {
    const TemporaryFolder folder;
    write_image(folder.path() / "t.png", Image(2, 2, 3));
    write_image(folder.path() / "t #2.png", Image(2, 2, 3));
    folder.write("a.mtl", "newmtl a\nmap_Kd t.png  # note\nnewmtl b\nmap_Kd t #2.png\n");
    Diagnostics found;
    const SceneDescription scene =
        obj_scene("mtllib a.mtl\n" + kObjSquare +
                      "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1#c\nusemtl b\nf 1/1 2/1 3/1 # c\n"
                      "f 1 2 3# c\n",
                  found, folder.path());
    EXPECT_EQ(found.all().size(), 1u) << text_of(found);
    EXPECT_TRUE(mentions(found, "the mesh 'b' has faces without texture coordinates"));
    EXPECT_EQ(scene.textures.size(), 2u);
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].mesh->triangles.size(), 2u);
    EXPECT_EQ(scene.meshes[1].mesh->triangles.size(), 2u);
}

TEST(ObjScene, MissingMaterialsAndIncludedFilesAreToldOfAtTheirLines) {
    Diagnostics found;
    (void)obj_scene(
        kObjSquare + "usemtl a\nf 1 2 3\ncall more.obj\nusemtl b\nf 1 3 4\ncall x.obj\n", found);
    EXPECT_EQ(text_of(found),
              "nowhere/a.obj:7:1: warning: the file of 'call more.obj' is not read, nor are those "
              "of other 'call' statements\n"
              "nowhere/a.obj:5: warning: no material library has 'a'; it is grey\n"
              "nowhere/a.obj:8: warning: no material library has 'b'; it is grey\n");
}

TEST(ObjScene, FilesOutsideOfTheScenesFolderAreNotRead) {
    const TemporaryFolder folder;
    folder.write("secret.mtl", "newmtl a\nKd 1 0 0\n");
    folder.write("scene/here.txt", "");
    Diagnostics found;
    const SceneDescription scene =
        obj_scene("mtllib ../secret.mtl\n" + kObjSquare + "usemtl a\nf 1 2 3\n", found,
                  folder.path() / "scene");
    EXPECT_TRUE(mentions(found, "outside the scene's folder")) << text_of(found);
    EXPECT_EQ(scene.materials.at(0).material.diffuse.color, (Rgb{.7, .7, .7}));
}

TEST(ObjScene, ManyNamesThatAreNotThereTakeNoTime) {
    std::string names = "mtllib";
    for (int i = 0; i < 300'000; ++i) names += " gone" + std::to_string(i) + ".mtl";
    Diagnostics found;
    const auto start = std::chrono::steady_clock::now();
    const TemporaryFolder folder;
    (void)obj_scene(names + "\n" + kObjSquare + "f 1 2 3\n", found, folder.path());
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 10.0);
    EXPECT_TRUE(mentions(found, "gone7.mtl"));
}

TEST(ObjScene, RandomDamageToALibraryNeverDoesMoreThanWarnings) {
    testing::Random random(11);
    const std::string good =
        "newmtl a\nKd 1 1 1\nd .5\nillum 7\nTf 1 1 1\nmap_Kd -o 1 2 -s 1 x y.png -bm 1\nnorm -mm 0 "
        "1 q\nPr 1\n";
    for (int round = 0; round < 3000; ++round) {
        std::string bytes = good;
        for (int k = 0; k < 4; ++k) {
            bytes[std::size_t(random.below(int(bytes.size())))] = char(random.below(256));
        }
        Diagnostics found;
        (void)read_mtl(bytes, "a.mtl", found);
        EXPECT_EQ(found.error_count(), 0u) << "round " << round;
    }
}

TEST(ObjScene, TheHostileLibrariesAreRead) {
    ALHAZEN_NEEDS_DATA("hostile/tinyobj/models");
    for (const char* folder : {"hostile/tinyobj/models", "hostile/assimp/OBJ"}) {
        for (const auto& entry :
             std::filesystem::directory_iterator(testing::test_data() / folder)) {
            if (entry.path().extension() != ".obj") continue;
            Diagnostics found;
            try {
                const SceneDescription scene = import_scene(entry.path(), {}, found);
                EXPECT_FALSE(scene.meshes.empty()) << entry.path();
            } catch (const Error& error) {
                EXPECT_NE(std::string(error.what()), "") << entry.path();
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
