/// .ray files as a whole: header, dialects, errors and limits.

#include <gtest/gtest.h>

#include <random>

#include "alhazen/imaging/codecs/image_io.h"
#include "ray_scene.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::import_ray;
using testing::import_ray_file;
using testing::Imported;
using testing::kSquareMesh;
using testing::material_of;
using testing::TemporaryFolder;

TEST(RayImporter, RecognisesTheHeaderEvenAfterAComment) {
    const ImportOptions options;
    const RayImporter importer;
    EXPECT_EQ(importer.recognise({"SBT-raytracer 1.0", "a.txt", options}), 2);
    EXPECT_EQ(importer.recognise({"/* old */ // x\n SBT-raytracer 1.0", "a", options}), 2);
    EXPECT_EQ(importer.recognise({"eyep 1 2 3", "a.ray", options}), 1);
    EXPECT_EQ(importer.recognise({"alhazen 1", "a.txt", options}), 0);
    EXPECT_EQ(importer.recognise({"", "", options}), 0);
}

TEST(RayImporter, SaysThatOtherLanguagesUseTheSuffixToo) {
    const Imported i = testing::import_text<RayImporter>("eyep 1 2 3\n", "a.ray");
    EXPECT_EQ(i.errors(), 1u);
    EXPECT_TRUE(i.says("Rayshade")) << i.messages();
}

TEST(RayImporter, RefusesLaterVersions) {
    EXPECT_EQ(testing::import_text<RayImporter>("SBT-raytracer 1.1", "a.ray").errors(), 0u);
    EXPECT_EQ(testing::import_text<RayImporter>("SBT-raytracer 1.2", "a.ray").errors(), 1u);
    EXPECT_EQ(testing::import_text<RayImporter>("SBT-raytracer", "a.ray").errors(), 1u);
}

TEST(RayImporter, TellsTheFamiliesApart) {
    const auto shininess = [](const std::string& value, const std::string& more = "") {
        const Imported i = import_ray(
            "sphere { material = { specular = (.5,.5,.5); shininess = " + value + " } } " + more);
        return material_of(i, 0).shininess.value;
    };
    EXPECT_EQ(shininess("25.6"), 25.6);
    EXPECT_EQ(shininess("0.5"), 64);
    EXPECT_EQ(shininess("2"), 256);
    EXPECT_EQ(shininess("0.5", "sphere { material = { shininess = 76.8 } }"), 0.5);
    EXPECT_EQ(shininess("25.6", "material { name = \"x\" }"), 25.6);

    const Imported b =
        import_ray("sphere { material = { specular = (.5,.5,.5); shininess = 25.6 } }");
    EXPECT_EQ(material_of(b, 0).reflective.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(b.scene.conventions.shading.shadow_tint, ShadingConventions::ShadowTint::PerDistance);
    EXPECT_EQ(b.scene.conventions.shading.refraction_tint,
              ShadingConventions::RefractionTint::PerDistance);
    const Imported a =
        import_ray("sphere { material = { specular = (.5,.5,.5); shininess = .2 } }");
    EXPECT_EQ(material_of(a, 0).reflective.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(a.scene.conventions.shading.shadow_tint, ShadingConventions::ShadowTint::PerCrossing);
    EXPECT_EQ(a.scene.conventions.shading.refraction_tint,
              ShadingConventions::RefractionTint::PerEvent);
    for (const Imported* i : {&a, &b}) {
        EXPECT_EQ(i->scene.conventions.sampling.pixel_sample,
                  SamplingConventions::PixelSample::LowerLeftCorner);
        EXPECT_EQ(i->scene.conventions.shading.highlight, ShadingConventions::Highlight::Phong);
        EXPECT_TRUE(i->scene.conventions.film.linear_output);
        EXPECT_FALSE(i->scene.conventions.shading.correct_interpolated_normals);
    }
}

TEST(RayImporter, WarnsOfUnknownKeysWithTheirPlace) {
    const Imported i = import_ray("sphere {\n  colour = (1,1,1) }");
    EXPECT_EQ(i.errors(), 0u);
    EXPECT_TRUE(i.says("scene.ray:3:3: warning: sphere: unknown key 'colour'; known are material"))
        << i.messages();
    EXPECT_TRUE(import_ray("sphere { material = { roughnes = 1 } }").says("warning"));
    EXPECT_TRUE(
        import_ray("camera { position = (0,0,0); position = (1,1,1) }").says("given twice"));
}

TEST(RayImporter, NamesTheExtensionItRefuses) {
    const struct {
        const char *text, *message;
    } cases[] = {
        {"metaball { ball = ((0,0,0,1)); }", "object 'metaball' belongs to an extension"},
        {"csg { operator = (0,\"minus\",1); }", "constructive solid geometry"},
        {"rotate(1,1,1,1, hyperbolic { })", "hyperbolic paraboloids"},
        {"shape_light { position = (1,2,1); }", "light 'shape_light'"},
        {"torus { a = 1; b = 2; }", "tori"},
        {"sphere { material = { roughness = 0.5; } }", "microfacet"},
        {"sphere { material = { marble { a = 1; } } }", "solid textures"},
        {"camera { aperture = 0.5; }", "depth of field"},
        {"warp { }",
         "unknown object 'warp'; known are camera, ambient_light, directional_light, point_light, "
         "area_light, spot_light, material, sphere"},
        {"{ warp { } }", "unknown object 'warp'; known are material, sphere"},
        {"{ warp { } }", "scale, transform and groups { }"},
        {"ball foo { }", "scene.ray:2:1: error: unknown object 'ball'; known are"},
        {"{ ball foo { } }", "unknown object 'ball'; known are material"},
        {"sphere foo { }", "sphere: expected a block { } right after the name"},
    };
    for (const auto& c : cases) {
        const Imported i = import_ray(c.text);
        EXPECT_EQ(i.errors(), 1u) << c.text << "\n" << i.messages();
        EXPECT_TRUE(i.says(c.message)) << i.messages();
    }
}

TEST(RayImporter, SaysThatCamerasAndLightsStandAtTheTopLevel) {
    for (const std::string item :
         {"camera { }", "point_light { }", "directional_light { }", "spot_light { }"}) {
        for (const std::string& text :
             {"{ " + item + " sphere { } }", "translate(0,0,1, " + item + ")"}) {
            const Imported i = import_ray(text);
            EXPECT_EQ(i.errors(), 1u) << i.messages();
            EXPECT_TRUE(
                i.says("cameras and lights stand at the top level of the file, outside "
                       "groups and transforms"))
                << i.messages();
        }
    }
    for (const char* text : {"camera = { }", "sphere = { }", "polymesh = { }", "sphere;"}) {
        const Imported i = import_ray(text);
        EXPECT_EQ(i.errors(), 1u) << i.messages();
        EXPECT_TRUE(i.says(": expected a block { } right after the name")) << i.messages();
    }
}

TEST(RayImporter, BlamesEveryUnknownObjectThatIsNotTheNameOfOne) {
    for (const char* text : {"ball sphere { } foo { }", "{ ball } foo { }"}) {
        const Imported i = import_ray(text);
        EXPECT_TRUE(i.says("unknown object 'ball'")) << i.messages();
        EXPECT_TRUE(i.says("unknown object 'foo'")) << i.messages();
    }
}

TEST(RayImporter, GoesOnAfterAnErrorAndReportsAll) {
    const Imported i = import_ray(
        "camera { position = (1,2); fov = x }\n"
        "sphere { material = { diffuse = 3 } }\n"
        "translate(1,2, box{})\n"
        "rotate(0,0,0,1, scale(1,2, sphere{}))\n"
        "wobble { }\n"
        "3\n"
        "cylinder { }");
    EXPECT_EQ(i.errors(), 8u) << i.messages();
    EXPECT_TRUE(i.says("scene.ray:2:21: error: position: expected a list of 3 numbers"))
        << i.messages();
    EXPECT_TRUE(i.says("scene.ray:2:34: error: fov: expected a number, found 'x'")) << i.messages();
    EXPECT_GE(i.parts().size(), 2u);
}

TEST(RayImporter, ReportsAMissingTextureWhereItIsNamed) {
    const Imported i = import_ray("box { material = {\n diffuse = map(\"no_such.bmp\") } }");
    EXPECT_EQ(i.errors(), 1u) << i.messages();
    EXPECT_TRUE(i.says("scene.ray:3:16: error: texture: ")) << i.messages();
    EXPECT_EQ(import_ray("box { material = { diffuse = map(\"/etc/passwd\") } }").errors(), 1u);
    EXPECT_EQ(import_ray("box { material = { diffuse = map(\"../../../x.png\") } }").errors(), 1u);
    EXPECT_EQ(import_ray("box { material = { diffuse = map(\"\") } }").errors(), 1u);
    EXPECT_EQ(import_ray("box { material = { diffuse = map(3) } }").errors(), 1u);
}

TEST(RayImporter, FindsTexturesWithNamesOfAnotherMachine) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "scenes/art");
    write_image(folder.path() / "scenes/art/Stone.png", Image(2, 2, 3));
    const auto import = [&](const std::string& name) {
        return import_ray_file(folder.write(
            "scenes/a.ray",
            "SBT-raytracer 1.0\nbox { material = { diffuse = map(\"" + name + "\"); } }"));
    };
    for (const char* name : {"art/Stone.png", "art\\Stone.png", "art/stone.PNG",
                             "../scenes/art/STONE.png", "..\\scenes\\art\\stone.png"}) {
        const Imported i = import(name);
        EXPECT_EQ(i.messages(), "") << name;
        EXPECT_EQ(i.scene.textures.size(), 1u) << name;
    }
    // Nothing outside the parent folder of the scene's.
    write_image(folder.path() / "out.png", Image(2, 2, 3));
    std::filesystem::create_directories(folder.path() / "scenes/deep");
    const Imported i = import_ray_file(folder.write(
        "scenes/deep/a.ray",
        "SBT-raytracer 1.0\nbox { material = { diffuse = map(\"..\\..\\OUT.png\"); } }"));
    EXPECT_EQ(i.errors(), 1u) << i.messages();
}

TEST(RayImporter, RefusesDeepNestingWithOneError) {
    for (const char* open : {"translate(0,0,0,", "{", "sphere { material = {", "x = ("}) {
        std::string text;
        for (int k = 0; k < 100'000; ++k) text += open;
        const Imported i = import_ray(text);
        EXPECT_EQ(i.errors(), 1u) << open << "\n" << i.messages().substr(0, 300);
    }
}

TEST(RayImporter, ReadsTheDeepestNestingItAllows) {
    for (const bool groups : {false, true}) {
        const int levels = groups ? 245 : 490;
        std::string text;
        for (int k = 0; k < levels; ++k) text += groups ? "translate(1,0,0,{" : "translate(1,0,0,";
        text += "sphere{}";
        for (int k = 0; k < levels; ++k) text += groups ? "})" : ")";
        const Imported i = import_ray(text, {.max_nesting = 1'000'000});
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        expect_near(i.parts().at(0).object_from_part.point({0, 0, 0}), {1.0 * levels, 0, 0});
    }
}

TEST(RayImporter, MakesAValidSceneOfNothing) {
    Imported i = import_ray("camera { }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 0u) << i.messages();
}

TEST(RayImporter, StopsAtTheLimitOfElements) {
    std::string text;
    for (int k = 0; k < 200; ++k) text += "sphere{}";
    EXPECT_THROW((void)import_ray(text, {.max_elements = 100}), Error);
}

TEST(RayImporter, SurvivesEveryTruncationAndManyMutationsOfAScene) {
    const std::string scene =
        std::string(
            "SBT-raytracer 1.0 camera { position = (1,2,3); fov = 30 }"
            "point_light { position = (1,1,1); color = (1,1,1) } material = { name red; diffuse = "
            "(1,0,0) }"
            "translate(1,2,3, { material = red; rotate(0,0,1,.5, sphere { name = \"s\" }) })"
            "trimesh { ") +
        kSquareMesh + "material = { specular = (0,0,0) }; gennormals; }";
    for (std::size_t n = 0; n < scene.size(); ++n) {
        (void)testing::import_text<RayImporter>(scene.substr(0, n), "a.ray");
    }
    std::mt19937 random(1980);
    const std::string bytes = "(){},;=\"x1-./*\n\xff";
    for (int round = 0; round < 2000; ++round) {
        std::string mutant = scene;
        for (int k = 0; k < 4; ++k) {
            mutant[random() % mutant.size()] = bytes[random() % bytes.size()];
        }
        SCOPED_TRACE(mutant);
        (void)testing::import_text<RayImporter>(mutant, "a.ray");
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
