#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/test_data.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_text;
using testing::mentions;
using testing::text_of;

const std::string kView =
    "v\nfrom 0 0 -8\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0\nresolution 200 100\n";
const std::string kFill = "f 1 0.5 0.25 0.8 0.3 20 0 0\n";

struct Counts {
    std::size_t spheres = 0, cylinders = 0, cones = 0, polygons = 0, flat = 0, smooth = 0;
    friend bool operator==(const Counts&, const Counts&) = default;
};

Counts count(const SceneDescription& scene) {
    Counts counts;
    for (const Part& part : scene.objects[0].parts) {
        if (const MeshIndex* index = std::get_if<MeshIndex>(&part.what)) {
            const TriangleMesh& mesh = *scene.meshes[std::size_t(*index)].mesh;
            (mesh.normals.empty() ? counts.flat : counts.smooth) += mesh.triangles.size();
            continue;
        }
        const AnyShape& shape = std::get<AnyShape>(part.what);
        counts.spheres += std::holds_alternative<Sphere>(shape);
        counts.cylinders += std::holds_alternative<Cylinder>(shape);
        counts.cones += std::holds_alternative<Cone>(shape);
        counts.polygons += std::holds_alternative<Polygon>(shape);
    }
    return counts;
}

TEST(Nff, EveryEntityIsReadWithItsComments) {
    Diagnostics found;
    const SceneDescription scene =
        import_text("# a comment\nb 0.1 0.2 0.3\n" + kView +
                        "l 1 2 3  # no colour\nl 4 5 6 0.5 1 0.25\n" + kFill +
                        "s 1 2 3 -4\nc\n0 0 0 1\n0 0 2 1\nc 0 0 0 -2\n0 0 1 -1\n"
                        "p 3\n0 0 0\n1 0 0\n0 1 0\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                        "pp 3\n0 0 0 0 0 1\n1 0 0 0 3 4\n0 1 0 0 0 1\n",
                    "a.nff", found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(scene.format, "nff");
    EXPECT_EQ(count(scene), (Counts{1, 1, 1, 1, 1, 1}));
    EXPECT_EQ(scene.picture.background, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(scene.picture.width, 200);
    EXPECT_EQ(scene.picture.height, 100);
    const auto& sphere = std::get<Sphere>(std::get<AnyShape>(scene.objects[0].parts[0].what));
    EXPECT_EQ(sphere.radius, 4.0);
    const auto& cone = std::get<Cone>(std::get<AnyShape>(scene.objects[0].parts[2].what));
    EXPECT_EQ(cone.base_radius, 2.0);
    EXPECT_EQ(cone.top_radius, 1.0);
    EXPECT_FALSE(cone.capped);
    EXPECT_EQ(scene.objects[0].parts[0].location.line, 13);
    EXPECT_NEAR(scene.meshes[1].mesh->normals[1].y, 0.6, 1e-15);
    Diagnostics invalid;
    validate(scene, invalid);
    EXPECT_EQ(text_of(invalid), "");
}

TEST(Nff, TheFillIsTakenApartAsTheFormatSays) {
    Diagnostics found;
    const SceneDescription scene =
        import_text(kView + "f 1 0.5 0.25 0.8 0.3 20 0.9 1.5\ns 0 0 0 1\n" + kFill + "s 0 0 0 1\n",
                    "a.nff", found);
    ASSERT_EQ(scene.materials.size(), 2u);
    const Material& glass = scene.materials[0].material;
    EXPECT_EQ(glass.diffuse.color, 0.8 * (Rgb{1, 0.5, 0.25}));
    EXPECT_EQ(glass.specular.color, (Rgb{0.3, 0.3, 0.3}));
    EXPECT_EQ(glass.reflective.color, (Rgb{0.3, 0.3, 0.3}));
    EXPECT_EQ(glass.transmissive.color, (Rgb{0.9, 0.9, 0.9}));
    EXPECT_EQ(glass.shininess.value, 20.0);
    EXPECT_EQ(glass.index.value, 1.5);
    EXPECT_EQ(scene.materials[1].material.index.value, 1.0);
    EXPECT_TRUE(scene.conventions.shading.transmitting_surfaces_reflect);
    EXPECT_EQ(scene.conventions.shading.air_index, 1.0);
}

TEST(Nff, LightsWithoutColourShareTheirIntensityWithTheAmbientLight) {
    Diagnostics found;
    const SceneDescription scene =
        import_text(kView + "l 0 0 0\nl 1 1 1\nl 2 2 2 0.1 0.2 0.3\nl 3 3 3\n", "a.nff", found);
    ASSERT_EQ(scene.lights.size(), 5u);
    EXPECT_EQ(std::get<PointLight>(scene.lights[0].light).color, (Rgb{0.25, 0.25, 0.25}));
    EXPECT_EQ(std::get<PointLight>(scene.lights[2].light).color, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(std::get<AmbientLight>(scene.lights[4].light).ambient, (Rgb{0.25, 0.25, 0.25}));
}

TEST(Nff, TheAngleRunsFromTheTopToTheBottomOfThePicture) {
    Diagnostics found;
    const SceneDescription scene =
        import_text("v\nfrom 1 2 3\nat 1 2 -7\nup 1 1 5\nangle 90\nhither 1\nresolution 200 100\n",
                    "a.nff", found);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_DOUBLE_EQ(scene.cameras[0].aspect, 2.0);
    const Ray top = eye_ray(scene.cameras[0].camera, 0.5, 1.0);
    const Ray right = eye_ray(scene.cameras[0].camera, 1.0, 0.5);
    EXPECT_EQ(top.origin, (Vec3{1, 2, 3}));
    // `up` is made perpendicular to the view direction: (1, 1, 0) / sqrt 2.
    EXPECT_NEAR(length(top.direction - normalize({1, 1, -std::sqrt(2.0)})), 0.0, 1e-15);
    EXPECT_NEAR(length(right.direction - normalize({std::sqrt(2.0), -std::sqrt(2.0), -1})), 0.0,
                1e-15);
}

TEST(Nff, TrianglesOfEqualMaterialsShareOneMesh) {
    std::string text = kView;
    for (int i = 0; i < 100; ++i) {
        text += kFill + "p 3\n0 0 0\n1 0 0\n0 1 0\n" +
                "f 1 1 1 1 0 0 0 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
    }
    Diagnostics found;
    const SceneDescription scene = import_text(text, "a.nff", found);
    EXPECT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(count(scene), (Counts{0, 0, 0, 0, 100, 100}));
}

TEST(Nff, PolygonsThatAreBentAreCutIntoTriangles) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        kView + kFill + "p 4\n0 0 0\n1 0 0.3\n1 1 0\n0 1 0.3\np 4\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n",
        "a.nff", found);
    EXPECT_EQ(count(scene), (Counts{0, 0, 0, 0, 2, 0}));
    EXPECT_TRUE(mentions(found, "1 primitive without extent is ignored"));
}

TEST(Nff, BowTiesArePolygonsWhoseHalvesDoNotCancel) {
    for (const char* off : {"0", "1e-9", "1e-5"}) {
        Diagnostics found;
        const SceneDescription scene = import_text(
            kView + kFill + "p 4\n0 0 0\n1 1 0\n1 0 " + off + "\n0 1 0\n", "a.nff", found);
        EXPECT_EQ(count(scene), (Counts{0, 0, 0, 1, 0, 0})) << off;
        EXPECT_EQ(text_of(found), "");
    }
    // A line there and back has no area.
    Diagnostics found;
    const SceneDescription scene =
        import_text(kView + kFill + "p 4\n0 0 0\n1 1 0\n1 0 0\n1 1 0\n", "a.nff", found);
    EXPECT_EQ(count(scene), Counts{});
}

TEST(Nff, BentPolygonsThatCrossThemselvesStayPolygons) {
    const auto read = [](const char* off, Diagnostics& found) {
        return import_text(
            kView + kFill + "p 5\n0 0 0\n1 1 " + off + "\n1 0 0\n0 1 0\n-0.3 0.5 0\n", "a.nff",
            found);
    };
    Diagnostics flat, bent;
    EXPECT_EQ(count(read("0", flat)), (Counts{0, 0, 0, 1, 0, 0}));
    EXPECT_EQ(text_of(flat), "");
    EXPECT_EQ(count(read("0.02", bent)), (Counts{0, 0, 0, 1, 0, 0}));
    EXPECT_TRUE(mentions(bent, "warning: polygon: its corners are not in a plane, but up to"));
    EXPECT_TRUE(mentions(bent, "off: it is met in their mean plane"));
    // A vertex written twice is no crossing.
    Diagnostics twice;
    const SceneDescription scene = import_text(
        kView + kFill + "p 5\n0 0 0\n1 0 0.3\n1 0 0.3\n1 1 0\n0 1 0.3\n", "a.nff", twice);
    EXPECT_EQ(count(scene).polygons, 0u);
    EXPECT_EQ(text_of(twice), "");
}

TEST(Nff, PolygonsAndPatchesWithoutAreaAreLeftOut) {
    Diagnostics found;
    const SceneDescription scene =
        import_text(kView + kFill +
                        "p 3\n0 0 0\n1 1 1\n3 3 3\np 3\n0 0 0\n1 0 0\n0 1 0\n"
                        "pp 4\n0 0 0 0 0 1\n1 0 0 0 0 1\n2 0 0 0 0 1\n1 0 0 0 0 1\n"
                        "pp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n",
                    "a.nff", found);
    EXPECT_EQ(count(scene), (Counts{0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(text_of(found), "a.nff: warning: 2 primitives without extent are ignored\n");
}

TEST(Nff, TheViewMustHaveADirectionForUpAndWholePixels) {
    const auto finding = [](std::string view, const char* from, const char* to) {
        view.replace(view.find(from), std::string(from).size(), to);
        Diagnostics found;
        import_text(view + kFill + "s 0 0 0 1\n", "a.nff", found);
        return text_of(found);
    };
    const std::string up =
        "a.nff:1:1: error: 'up' of the view must not be zero, nor along the view\n";
    EXPECT_EQ(finding(kView, "up 0 1 0", "up 0 0 0"), up);
    EXPECT_EQ(finding(kView, "up 0 1 0", "up 0 0 -3"), up);
    EXPECT_EQ(finding(kView, "resolution 200 100", "resolution 200 100.5"),
              "a.nff:1:1: error: the resolution must be two whole numbers\n");
    EXPECT_EQ(finding(kView, "resolution 200 100", "resolution 2e2 1e2"), "");
}

TEST(Nff, OfTwoViewsOrBackgroundsTheLastCountsWithAWarning) {
    const auto warnings = [](const std::string& text) {
        Diagnostics found;
        const SceneDescription scene = import_text(text, "a.nff", found);
        EXPECT_EQ(scene.picture.background, (Rgb{0, 1, 0}));
        EXPECT_EQ(scene.picture.width, 20);
        return text_of(found);
    };
    const std::string green = "b 0 1 0\n", small = "resolution 20 10\n", view = kView + small;
    EXPECT_EQ(warnings(green + view),
              "a.nff:9:1: warning: 'resolution' is given twice; the last counts\n");
    EXPECT_EQ(warnings("b 1 0 0\n" + kView + "v\n" + small + "b 0 0 0\n" + green),
              "a.nff:9:1: warning: another view: its lines replace those of the first\n"
              "a.nff:11:1: warning: 'b' is given twice; the last counts\n");
}

TEST(Nff, TheViewNeedsNoHither) {
    Diagnostics found;
    import_text("v\nfrom 0 0 -8\nat 0 0 0\nup 0 1 0\nangle 45\nresolution 2 2\n", "a.nff", found);
    EXPECT_EQ(text_of(found), "");
}

TEST(Nff, FindingsNameLineAndColumn) {
    const auto expect = [](const std::string& text, const char* part) {
        Diagnostics found;
        import_text(kView + kFill + text, "a.nff", found);
        EXPECT_GT(found.error_count(), 0u);
        EXPECT_TRUE(mentions(found, part)) << text << "\n" << text_of(found);
    };
    expect("s 0 0 x 1\n", "a.nff:9:7: error: 's' of line 9: expected a number, found 'x'");
    expect("s 0 0 0", "found the end of the file");
    expect("s 0 0 0\ns 1 1 1 1", "a.nff:10:1: error: 's' of line 9");
    expect("hello 1 2\n", "a.nff:9:1: error: expected a statement");
    expect("p 2\n0 0 0\n1 1 1\n", "a.nff:9:1: error: the number of vertices");
    expect("p 1000000000\n0 0 0\n1 1 1\n", "a.nff:9:1: error: the file is too short");
    expect("p 1e300\n", "a.nff:9:1: error");
    expect("p 3.5\n", "a.nff:9:1: error");
    expect("angle 180\n", "error: the angle");
    expect("resolution 0 5\n", "error: the resolution");
    expect("at 0 0 -8\n", "error: 'from' and 'at'");
    Diagnostics found;
    import_text("v\nfrom 0 0 0\nat 1 1 1\nangle 45\nresolution 8 8\n", "a.nff", found);
    EXPECT_TRUE(mentions(found, "a.nff:1:1: error: the view has no line 'up'")) << text_of(found);
}

TEST(Nff, AnErrorIsReportedOnceAndReadingGoesOn) {
    Diagnostics found;
    const SceneDescription scene =
        import_text(kView + kFill + "s 0 0 zero 1\nwhat is this\ns 1 1 1 1\n", "a.nff", found);
    EXPECT_EQ(found.error_count(), 1u) << text_of(found);
    EXPECT_EQ(count(scene).spheres, 1u);
}

TEST(Nff, ConstructsOfAffAreReadOrRefusedByName) {
    Diagnostics read;
    const SceneDescription scene =
        import_text(kView +
                        "% a comment\nam 0.1 0.2 0.3\nla lamp 1 2 3 1 1 1\na 0 1 30\n"
                        "fm 0.1 0.1 0.1 0.5 0.5 0.5 0.2 0.3 0.4 10 0 0\n"
                        "tt wood.ppm\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n"
                        "ttp wood.ppm\n0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n0 1 0 0 0 1 0 1\n",
                    "a.aff", read);
    EXPECT_EQ(read.error_count(), 0u) << text_of(read);
    EXPECT_EQ(read.warning_count(), 3u) << text_of(read);
    EXPECT_EQ(count(scene), (Counts{0, 0, 0, 0, 1, 1}));
    EXPECT_EQ(std::get<AmbientLight>(scene.lights[1].light).ambient, (Rgb{0.1, 0.2, 0.3}));
    EXPECT_EQ(scene.materials[0].material.ambient.color, (Rgb{0.1, 0.1, 0.1}));
    for (const std::string refused :
         {"m\nvertices 1\n0 0 0", "xs 1 1 1 0 0 1 90 0 0 0 {\ns 0 0 0 1\n}", "x car {\n}",
          "k camera {\n}", "tpa 2\n0\n", "i 1 more.aff", "d 3"}) {
        Diagnostics found;
        import_text(kView + kFill + refused + "\n", "a.aff", found);
        const std::string name = refused.substr(0, refused.find_first_of(" \n"));
        EXPECT_TRUE(mentions(found, "a.aff:9:1: error: '" + name + "'")) << text_of(found);
        EXPECT_EQ(found.error_count(), 1u) << text_of(found);
    }
}

TEST(Nff, RandomDamageNeverDoesMoreThanFindings) {
    const std::string good = kView + "l 1 1 1\n" + kFill +
                             "s 0 0 0 1\nc 0 0 0 1\n0 0 1 0\np 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                             "pp 3\n0 0 0 0 0 1\n1 0 0 0 3 4\n0 1 0 0 0 1\n";
    std::mt19937 random(11);
    for (int round = 0; round < 5000; ++round) {
        std::string bytes = good;
        for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = char(random() % 128);
        bytes.resize(bytes.size() - random() % 60);
        Diagnostics found;
        SCOPED_TRACE(round);
        const ImportOptions options;
        const ImportSource source{bytes, "a.nff", options};
        const SceneDescription scene = find_importer(source).import(source, found);
        validate(scene, found);
    }
}

TEST(Nff, ThePublishedScenesHaveTheirPublishedCounts) {
    ALHAZEN_NEEDS_DATA("nff/spd_default");
    struct Fact {
        const char* file;
        Counts counts;
        std::size_t lights, materials;
    };
    for (const Fact& fact : {Fact{"spd_default/balls_s4", {7381, 0, 0, 1, 0, 0}, 3, 2},
                             Fact{"spd_default/gears_s4", {0, 0, 0, 9345, 0, 0}, 5, 65},
                             Fact{"spd_default/teapot_s12", {0, 0, 0, 144, 0, 9120}, 2, 3},
                             Fact{"spd_default/tetra_s6", {0, 0, 0, 0, 4096, 0}, 1, 1},
                             Fact{"spd_small/jacks_s1", {6, 3, 0, 0, 0, 0}, 1, 1},
                             Fact{"spd_small/rings_s2", {150, 150, 0, 1, 0, 0}, 3, 7},
                             Fact{"spd_small/tree_s4", {31, 0, 31, 1, 0, 0}, 7, 2},
                             Fact{"spd_small/mount_s3", {4, 0, 0, 0, 128, 0}, 1, 2},
                             Fact{"spd_small/sombrero_s1", {0, 0, 0, 0, 1922, 0}, 1, 1}}) {
        SCOPED_TRACE(fact.file);
        Diagnostics found;
        const SceneDescription scene = import_scene(
            testing::test_data() / "nff" / (std::string(fact.file) + ".nff"), {}, found);
        EXPECT_EQ(text_of(found), "");
        const Counts counts = count(scene);
        EXPECT_EQ(counts.spheres, fact.counts.spheres);
        EXPECT_EQ(counts.cylinders, fact.counts.cylinders);
        EXPECT_EQ(counts.cones, fact.counts.cones);
        EXPECT_EQ(counts.polygons, fact.counts.polygons);
        EXPECT_EQ(counts.flat, fact.counts.flat);
        EXPECT_EQ(counts.smooth, fact.counts.smooth);
        EXPECT_EQ(scene.lights.size(), fact.lights + 1);
        EXPECT_LE(scene.materials.size(), fact.materials);
    }
}

TEST(Nff, EverySceneOfTheDataIsValid) {
    ALHAZEN_NEEDS_DATA("nff");
    int scenes = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(testing::test_data() / "nff")) {
        if (entry.path().extension() != ".nff") continue;
        Diagnostics found;
        EXPECT_EQ(import_scene(entry.path(), {}, found).cameras.size(), 1u) << entry.path();
        ++scenes;
    }
    EXPECT_GE(scenes, 14);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
