/// The native format as a whole: header, scenes of the repository, mistakes and limits.

#include <gtest/gtest.h>

#include <random>

#include "native_scene.h"
#include "support/test_data.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_native;
using testing::import_native_file;
using testing::Imported;

TEST(NativeImporter, RecognisesItsHeader) {
    const ImportOptions options;
    const NativeImporter importer;
    EXPECT_EQ(importer.recognise({"alhazen 1", "x", options}), 2);
    EXPECT_EQ(importer.recognise({"// a\nalhazen 7", "x", options}), 2);
    EXPECT_EQ(importer.recognise({"sphere", "x.alhazen", options}), 1);
    EXPECT_EQ(importer.recognise({"alhazen", "x", options}), 0);
    EXPECT_EQ(importer.recognise({"SBT-raytracer 1.0", "x.ray", options}), 0);
}

TEST(NativeImporter, RefusesOtherHeadersAndVersions) {
    for (const char* text : {"", "alhazen", "alhazen 2", "sphere { }", "alhazen { }"}) {
        const Imported i = testing::import_text<NativeImporter>(text, "a.alhazen");
        EXPECT_EQ(i.errors(), 1u) << text << i.messages();
        EXPECT_TRUE(i.says("alhazen 1")) << i.messages();
    }
}

TEST(NativeImporter, GlassesHaveTheirIndexByNameByFormulaOrByAbbe) {
    const auto material = [](const std::string& fields) {
        return import_native("material \"m\" { " + fields + " } sphere { material = \"m\" }");
    };
    const Imported bk7 = material("glass = \"bk7\"");
    EXPECT_EQ(bk7.messages(), "");
    const Material& m = bk7.scene.materials.at(0).material;
    EXPECT_NEAR(m.index.value, 1.5168, 1e-5);
    EXPECT_TRUE(m.dielectric && m.dispersion->name == "BK7");
    EXPECT_EQ(material("abbe = 30; index = 1.6; dielectric = { }").messages(), "");
    EXPECT_EQ(material("sellmeier = (1.1, 0.01)").messages(), "");
    // An index alone is that of a clear body.
    for (const char* alone : {"sellmeier = (1.1, 0.01)", "index = 1.6; abbe = 20",
                              "glass = \"BK7\"; emission = 0.1; roughness = 0.2"}) {
        EXPECT_TRUE(material(alone).scene.materials.at(0).material.dielectric) << alone;
    }
    for (const char* of : {"sellmeier = (1.1, 0.01); diffuse = 0.5", "abbe = 20; transmissive = 1",
                           "glass = \"BK7\"; reflective = 0", "abbe = 20; conductor = \"gold\"",
                           "abbe = 20; metallic_roughness = { }"}) {
        EXPECT_FALSE(material(of).scene.materials.at(0).material.dielectric) << of;
    }
    EXPECT_EQ(material("emission = blackbody(3200)").messages(), "");
    EXPECT_EQ(material("emission = illuminant(\"A\", 2.5)").messages(), "");
    EXPECT_TRUE(material("glass = \"crown\"").says("fused_quartz"));
    EXPECT_TRUE(material("glass = \"BK7\"; index = 1.5").says("expected no 'index'"));
    EXPECT_TRUE(material("glass = \"BK7\"; abbe = 30").says("expected one of them"));
    for (const char* bad :
         {"abbe = 0", "abbe = -3", "sellmeier = (1, 2, 3)", "sellmeier = (1, 0.25)",
          "sellmeier = 3", "emission = blackbody(3)", "emission = blackbody()",
          "emission = blackbody(3000, -1)", "emission = illuminant(\"A\", -0.5)",
          "emission = illuminant(\"F2\")", "emission = illuminant(A)"}) {
        EXPECT_EQ(material(bad).errors(), 1u) << bad << material(bad).messages();
    }
}

TEST(NativeImporter, LoadsTheExampleOfItsDocumentation) {
    const std::string page =
        read_file(testing::source_folder() / "docs/reference/formats/native.md");
    const std::string fence = "```alhazen\n";
    const std::size_t begin = page.find(fence);
    ASSERT_NE(begin, std::string::npos);
    const std::string text =
        page.substr(begin + fence.size(), page.find("```", begin + 3) - begin - fence.size());
    const Imported i = testing::import_text<NativeImporter>(text, "example.alhazen");
    EXPECT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().size(), 5u);
    EXPECT_EQ(i.scene.objects.size(), 2u);
    EXPECT_EQ(i.scene.lights.size(), 2u);
    EXPECT_NEAR(i.scene.cameras.at(0).aspect, 320.0 / 240.0, 1e-15);
    EXPECT_EQ(*i.scene.picture.width, 320);
}

TEST(NativeImporter, LoadsTheScenesOfTheRepository) {
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(testing::source_folder() / "scenes")) {
        if (entry.path().extension() != ".alhazen") continue;
        ++count;
        const Imported i = import_native_file(entry.path());
        EXPECT_EQ(i.messages(), "");
        EXPECT_FALSE(i.parts().empty()) << entry.path();
        EXPECT_FALSE(i.scene.cameras.empty()) << entry.path();
    }
    EXPECT_GE(count, 3);
}

TEST(NativeImporter, ShowsEveryShapeInTheScenesOfTheRepository) {
    std::vector<bool> seen(AnalyticShapes::kCount);
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(testing::source_folder() / "scenes")) {
        if (entry.path().extension() != ".alhazen") continue;
        const Imported i = import_native_file(entry.path());
        for (const ObjectDescription& object : i.scene.objects) {
            for (const Part& part : object.parts) {
                if (const auto* s = std::get_if<AnyShape>(&part.what)) seen[s->index()] = true;
            }
        }
    }
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_TRUE(seen[k]) << "shape type " << k;
}

TEST(NativeImporter, ReadsConvexPolyhedraInTheirThreeForms) {
    const Imported i = import_native(
        "half_space { point = (0, 0, 1); normal = (0, 1, 1) }\n"
        "polyhedron { planes = [((1,0,0), (1,0,0)), ((0,0,0), (-1,0,0)), ((0,1,0), (0,1,0)),\n"
        "  ((0,0,0), (0,-1,0)), ((0,0,1), (0,0,1)), ((0,0,0), (0,0,-1))] }\n"
        "polyhedron { vertices = [(0,0,0), (1,0,0), (0,1,0), (0,0,1)]\n"
        "  faces = [(0,1,2), (0,1,3), (1,2,3), (0,3,2)] }\n"
        "polyhedron { vertices = [(0,0,0), (1,0,0), (1,1,0), (0,1,0), (0,0,1), (1,0,1), (1,1,1),\n"
        "  (0,1,1)] }\n");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(testing::shape_of<Polyhedron>(i, 1).planes.size(), 6u);
    EXPECT_EQ(testing::shape_of<Polyhedron>(i, 2).face_ends.size(), 4u);
    EXPECT_EQ(testing::shape_of<Polyhedron>(i, 3).face_ends.size(), 6u);
    EXPECT_TRUE(import_native("polyhedron { }").says("either 'planes"));
    EXPECT_TRUE(import_native("polyhedron { vertices = [(0,0,0)] }").says("'faces = ...'"));
    EXPECT_TRUE(import_native("polyhedron { planes = [(1, 2, 3)] }").says("outward normal"));
    EXPECT_TRUE(import_native("polyhedron { vertices = [(0,0,0)]; faces = [(0, -1, 2)] }")
                    .says("numbers of vertices"));
}

TEST(NativeImporter, ReadsOutlinesAndClosesThoseOfPrisms) {
    const Imported i = import_native(
        "prism { profile = [(0,0), (2,0), curve((2,1), (1,2), (0,2))]; h0 = -1; h1 = 3;\n"
        "  top_scale = 0.5 }\n"
        "prism { loops = [[(0,0), (1,0), (0,1), (0,0)], [(3,3), (4,3), (4,4)]] }\n"
        "lathe { profile = [(0,0), (1,0), curve((1,1), (0.5,1), (0,2))] }\n");
    ASSERT_EQ(i.messages(), "");
    const Prism& prism = testing::shape_of<Prism>(i, 0);
    ASSERT_EQ(prism.profile.curves.size(), 3u);
    EXPECT_FALSE(prism.profile.curves[1].line);
    EXPECT_EQ(prism.profile.curves[2].p[3], (Vec2{0, 0}));
    EXPECT_EQ(prism.h1, 3);
    EXPECT_EQ(prism.top_scale, 0.5);
    EXPECT_EQ(testing::shape_of<Prism>(i, 1).profile.loop_ends, (std::vector<std::uint32_t>{3, 6}));
    EXPECT_TRUE(testing::shape_of<Lathe>(i, 2).closed());
    EXPECT_EQ(testing::shape_of<Lathe>(i, 2).profile.curves.size(), 2u);
    EXPECT_TRUE(import_native("prism { }").says("either 'profile"));
    EXPECT_TRUE(import_native("prism { profile = [(0,0), curve((1,1), (2,2))] }").says("curve("));
    EXPECT_TRUE(import_native("lathe { profile = [(0,0,0), (1,1)] }").says("profile"));
}

TEST(NativeImporter, ReadsBlobsAndHeights) {
    const Imported i = import_native(
        "blob { threshold = 0.25; components = [sphere((0,0,0), 1, 2),\n"
        "  cylinder((0,0,0), (1,0,0), 0.5, -1)] }\n"
        "height_field { columns = 3; heights = [0, 1, 2, 3, 4, 5]; lo = (0, 0); hi = (2, 1) }\n");
    ASSERT_EQ(i.messages(), "");
    const Blob& blob = testing::shape_of<Blob>(i, 0);
    ASSERT_EQ(blob.components.size(), 2u);
    EXPECT_TRUE(blob.components[1].rod);
    EXPECT_EQ(blob.components[1].strength, -1);
    EXPECT_EQ(testing::shape_of<HeightField>(i, 1).rows, 2u);
    EXPECT_TRUE(import_native("blob { components = [box((0,0,0), 1, 2)] }").says("sphere(center"));
    EXPECT_TRUE(import_native("blob { }").says("components"));
    EXPECT_TRUE(import_native("height_field { }").says("either 'heights"));
    EXPECT_TRUE(import_native("height_field { columns = 4; heights = [1, 2, 3] }").says("divide"));
}

TEST(NativeImporter, HeightsMayComeFromAPicture) {
    const Imported i = testing::import_text<NativeImporter>(
        "alhazen 1\nheight_field { file = \"checker.png\"; low = 1; high = 3; base = 0 }\n",
        testing::source_folder() / "scenes/heights.alhazen");
    ASSERT_EQ(i.messages(), "");
    const HeightField& field = testing::shape_of<HeightField>(i, 0);
    EXPECT_GE(field.columns, 2u);
    EXPECT_EQ(field.heights->size(), std::size_t{field.columns} * field.rows);
    for (const float h : *field.heights) {
        ASSERT_GE(h, 1.f);
        ASSERT_LE(h, 3.f);
    }
    EXPECT_TRUE(import_native("height_field { file = \"no_such.png\" }").says("no_such.png"));
}

TEST(NativeImporter, StringsMayEscapeQuotesAndBytes) {
    const Imported i = import_native("sphere \"a \\\"b\\\" \\\\ \\x41\\n\" { }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().at(0).name, "a \"b\" \\ A\n");
    EXPECT_TRUE(import_native("sphere \"a\\q\" { }").says("a string may escape"));
    EXPECT_TRUE(import_native("sphere \"a\\x4\" { }").says("a string may escape"));
    EXPECT_TRUE(import_native("sphere \"a\\").says("unterminated string"));
    EXPECT_TRUE(import_native("sphere \"a\\\" { }").says("unterminated string"));
}

TEST(NativeImporter, ReadsTheDeepestNestingItAllows) {
    std::string text;
    for (int k = 0; k < 498; ++k) text += "group {";
    const Imported i =
        import_native(text + "sphere { }" + std::string(498, '}'), {.max_nesting = 1'000'000});
    EXPECT_EQ(i.messages(), "");
    EXPECT_EQ(i.parts().size(), 1u);
}

TEST(NativeImporter, ReportsEachMistakeOnceAndGoesOn) {
    const Imported i = import_native(
        "sphere { radius = \"x\" }\n"
        "box { lo = (1,2); hi = nan }\n"
        "disc { radius = 1e999 }\n"
        "plane { normal = (0,inf,1) }\n"
        "radius = 3\n"
        "picture { width = 0; height = 1.5 }\n"
        "group { camera { } }\n"
        "sphere { center = (1,2,3 }\n"
        "point_light { }\n"
        "sphere\n"
        "spot_light { position = (0,0,0); look_at = (0,0,0) }\n"
        "perspective_camera { eye = (0,0,0); direction = (0,1,0) }\n"
        "cylinder { }\n");
    EXPECT_EQ(i.errors(), 14u) << i.messages();
    for (int line = 2; line <= 13; ++line) {
        EXPECT_TRUE(i.says("scene.alhazen:" + std::to_string(line) + ":")) << line << i.messages();
    }
}

TEST(NativeImporter, RefusesWhatBelongsAtTheTop) {
    EXPECT_TRUE(import_native("object \"a\" { point_light { position = (0,0,0) } }")
                    .says("point_light belongs at the top level"));
    EXPECT_TRUE(import_native("group { picture { } }").says("picture belongs at the top level"));
    EXPECT_TRUE(import_native("group { colour = 1 }").says("group: unknown key 'colour'"));
}

TEST(NativeImporter, SurvivesEveryTruncationAndManyMutationsOfAScene) {
    const std::string scene =
        "alhazen 1 picture { width = 2 } material \"m\" { diffuse = (1,0,0) } "
        "perspective_camera { eye = (0,0,5); look_at = (0,0,0) } object \"o\" { sphere { material "
        "= "
        "\"m\" } } instance \"o\" { transform = [translate(1,2,3), rotate((0,0,1), 3)] } polygon { "
        "loops = [[(0,0,0),(1,0,0),(0,1,0)]] } mesh { points = [(0,0,0),(1,0,0),(0,1,0)]; faces = "
        "[(0,1,2)] } group { defaults { material = \"m\" } box { } } include \"x\"";
    for (std::size_t n = 0; n < scene.size(); ++n) {
        (void)testing::import_text<NativeImporter>(scene.substr(0, n), "a.alhazen");
    }
    std::mt19937 random(1021);
    const std::string bytes = "(){}[],;=\"x1-./*\n\xff";
    for (int round = 0; round < 2000; ++round) {
        std::string mutant = scene;
        for (int k = 0; k < 4; ++k) {
            mutant[random() % mutant.size()] = bytes[random() % bytes.size()];
        }
        SCOPED_TRACE(mutant);
        (void)testing::import_text<NativeImporter>(mutant, "a.alhazen");
    }
}

TEST(NativeImporter, MakesAValidSceneOfNothing) {
    Imported i = import_native("perspective_camera { eye = (0,0,0); direction = (1,0,0) }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 0u) << i.messages();
}

TEST(NativeImporter, StopsAtTheLimitOfElements) {
    std::string text;
    for (int k = 0; k < 200; ++k) text += "sphere { }";
    EXPECT_THROW((void)import_native(text, {.max_elements = 100}), Error);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
