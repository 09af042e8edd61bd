#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "alhazen/imaging/codecs/image_io.h"
#include "support/test_data.h"
#include "unit/formats/import_text.h"
#include "unit/formats/uw_yaml/uw_yaml_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::course_scene;
using testing::expect_point;
using testing::import_text;
using testing::mentions;
using testing::shape_of;
using testing::text_of;

const std::string kCamera = R"(        Camera:
            FOV: 60
            Render Width (px): 400
            Render Height (px): 200
            Perspective Camera?: true
            Trace: {Maximum Recursion Depth: 3, Shadows: 2, Monte Carlo: 0, Samples Per Pixel: 0}
)";

TEST(UwYaml, BracketsInTextDoNotNest) {
    std::string lines;
    for (int i = 0; i < 300; ++i) {
        lines += "        Note " + std::to_string(i) +
                 ": {a: \"[x\\\"{\", b: 'it''s [', c: [1, {d: 2}]}" +
                 "  # of [0, 1)\n        Plain " + std::to_string(i) + ": gap [i, 1\n" +
                 "        Long " + std::to_string(i) + ": \"[\n          [ {\"\n";
    }
    Diagnostics found;
    (void)import_text(course_scene(kCamera + lines), "yaml", found);
    EXPECT_FALSE(mentions(found, "nested")) << text_of(found);
    std::string deep;
    for (int i = 0; i < 300; ++i) deep += "[\"]\", ";
    Diagnostics nested;
    EXPECT_THROW(
        (void)import_text(course_scene(kCamera + "        X: " + deep + "\n"), "yaml", nested),
        Error);
}

TEST(UwYaml, MaterialsAreTakenAsWrittenAndMirrorsFollowTheHighlight) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene("        Sphere: {Material: Red One, Quality: 4}\n"), "a.yaml", found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& m = scene.materials[0].material;
    EXPECT_EQ(m.name, "Red One");
    EXPECT_EQ(m.diffuse.color, (Rgb{0.75, 0, 5e-05}));
    EXPECT_EQ(m.specular.color, (Rgb{0.5, 0.25, 0.125}));
    EXPECT_EQ(m.reflective.color, m.specular.color);
    EXPECT_EQ(m.transmissive.color, (Rgb{0, 0.9, 0}));
    EXPECT_EQ(m.emission.color, (Rgb{0.01, 0, 0}));
    EXPECT_EQ(m.shininess.value, 25.6);
    EXPECT_EQ(m.index.value, 1.5);
    EXPECT_TRUE(scene.conventions.importing.truncate_material_colors);
    EXPECT_EQ(scene.conventions.shading.air_index, 1.0003);
    EXPECT_EQ(scene.conventions.shading.min_distance, 1e-3);
    EXPECT_EQ(shape_of<Sphere>(scene, 0).radius, 0.5);
}

TEST(UwYaml, TransformsTurnAboutZThenYThenXAndChildrenMultiplyOnTheRight) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene(
            "        Transform: {Translation: {X: 1, Y: 2, Z: 3}, Rotation: {X: 90, Y: 0, Z: 90}, "
            "Scale: {X: 2, Y: 1, Z: 1}}\n",
            "    -   Name: a child\n        Enabled: true\n        Components:\n"
            "            Transform: {Translation: {X: 1, Y: 0, Z: 0}}\n"
            "            TriangleMesh: {Mesh: Cube, Material: Red One, LoopSubdivision: 0}\n"),
        "a.yaml", found);
    ASSERT_EQ(scene.objects[0].parts.size(), 1u) << text_of(found);
    const Part& part = scene.objects[0].parts[0];
    EXPECT_EQ(part.name, "a child");
    // x: + 1, * 2; about z to y; about x to z; + (1, 2, 3).
    expect_point(part.object_from_part.point({0, 0, 0}), {1, 2, 5});
    expect_point(part.object_from_part.point({0.5, 0, 0}), {1, 2, 6});
    expect_point(part.object_from_part.point({0, 1, 0}), {0, 2, 5});
    expect_point(part.object_from_part.point({0, 0, 1}), {1, 1, 5});
}

TEST(UwYaml, EveryShapeHasTheCoursesSizeAndPlace) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene("        Sphere: {Material: Red One}\n        Cylinder: {Material: Red One}\n"
                     "        Cone: {Material: Red One}\n        Plane: {Material: Red One}\n"
                     "        Ring: {Material: Red One, Width: 0.2}\n"
                     "        TriangleMesh: {Material: Red One, Mesh: Cube}\n"),
        "a.yaml", found);
    EXPECT_EQ(found.error_count(), 0u) << text_of(found);
    ASSERT_EQ(scene.objects[0].parts.size(), 7u);
    const Affine& sphere = scene.objects[0].parts[0].object_from_part;
    expect_point(sphere.point({0, 0, 1}), {0, -1, 0});
    EXPECT_EQ(shape_of<Cylinder>(scene, 1).base, (Vec3{0, -0.5, 0}));
    EXPECT_EQ(shape_of<Cylinder>(scene, 1).top, (Vec3{0, 0.5, 0}));
    EXPECT_TRUE(shape_of<Cylinder>(scene, 1).capped);
    EXPECT_EQ(shape_of<Cone>(scene, 2).top_radius, 0.0);
    EXPECT_EQ(shape_of<Rectangle>(scene, 3).corner.z, 1e-5);
    EXPECT_EQ(shape_of<Rectangle>(scene, 4).corner.z, -1e-5);
    EXPECT_NEAR(shape_of<Disc>(scene, 5).inner_radius, 0.3, 1e-15);
    EXPECT_EQ(shape_of<BoxShape>(scene, 6).hi, (Vec3{0.5, 0.5, 0.5}));
}

TEST(UwYaml, LightsAndCameraFollowTheirNodes) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene(
            "        Transform: {Translation: {X: 0, Y: 0, Z: 5}, Rotation: {X: 90, Y: 0, Z: "
            "0}}\n" +
            kCamera +
            "        PointLight: {Color: {R: 1, G: 0.5, B: 0}, Ambient: {R: 0.09, G: 0, B: 0}, "
            "Quad Atten: 5e-05, Linear Atten: 0.00337, Const Atten: 0.25, Radius (Trace): 0}\n"
            "        DirectionalLight: {Color: {R: 1, G: 1, B: 0.5}, Intensity Multiplier: 2}\n"),
        "a.yaml", found);
    EXPECT_EQ(text_of(found), "");
    ASSERT_EQ(scene.lights.size(), 2u);
    const auto& point = std::get<PointLight>(scene.lights[0].light);
    EXPECT_EQ(point.position, (Vec3{0, 0, 5}));
    EXPECT_EQ(point.ambient, (Rgb{0.09, 0, 0}));
    EXPECT_EQ(point.attenuation.quadratic, 5e-05);
    const auto& sun = std::get<DirectionalLight>(scene.lights[1].light);
    expect_point(sun.to_light, {0, 0, 1});
    EXPECT_EQ(sun.color, (Rgb{2, 2, 1}));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.picture.width, 400);
    EXPECT_EQ(scene.picture.height, 200);
    EXPECT_EQ(scene.conventions.shading.max_depth, 3);
    const Ray ray = eye_ray(scene.cameras[0].camera, 0.5, 1.0);
    expect_point(ray.origin, {0, 0, 5});
    // Looks along +y with +z up; half the angle (30 degrees) to the top.
    expect_point(ray.direction, {0, std::cos(std::acos(-1.0) / 6), 0.5});
}

TEST(UwYaml, TheCameraDecidesWhetherMirrorsAndGlassAreTraced) {
    for (const bool on : {true, false}) {
        std::string camera = kCamera;
        const std::string flag = on ? "true" : "false";
        camera.replace(camera.find("Shadows: 2"), 10,
                       "Reflections: " + flag + ", Refractions: " + flag);
        Diagnostics found;
        const SceneDescription scene = import_text(
            course_scene("        Sphere: {Material: Red One}\n" + camera), "a.yaml", found);
        EXPECT_EQ(scene.conventions.shading.trace_reflections, on);
        EXPECT_EQ(scene.conventions.shading.trace_refractions, on);
        // Transmitting surfaces still tint shadows.
        EXPECT_FALSE(scene.materials.at(0).material.transmissive.color.is_black());
        EXPECT_EQ(found.warning_count(), 0u) << text_of(found);
    }
}

TEST(UwYaml, ShadowsAreNoneOpaqueOrColouredAndOlderFilesSwitchThem) {
    using ShadowTint = ShadingConventions::ShadowTint;
    const std::vector<std::pair<std::string, ShadowTint>> cases{
        {"Shadows: 0", ShadowTint::None},
        {"Shadows: 1", ShadowTint::Opaque},
        {"Shadows: 2", ShadowTint::PerCrossing},
        {"Shadows: false", ShadowTint::None},
        {"Shadows: No", ShadowTint::None},
        {"Shadows: 1.0", ShadowTint::Opaque},
        {"Shadows: 2.0", ShadowTint::PerCrossing},
        {"Shadows: True", ShadowTint::PerCrossing},
        {"Enable Shadows: Off", ShadowTint::None},
        {"Enable Shadows: false", ShadowTint::None},
        {"Enable Shadows: true", ShadowTint::PerCrossing}};
    for (const auto& [text, tint] : cases) {
        std::string camera = kCamera;
        camera.replace(camera.find("Shadows: 2"), 10, text);
        Diagnostics found;
        const SceneDescription scene = import_text(
            course_scene("        Sphere: {Material: Red One}\n" + camera), "a.yaml", found);
        EXPECT_EQ(scene.conventions.shading.shadow_tint, tint) << text;
        EXPECT_EQ(text_of(found), "") << text;
    }
}

TEST(UwYaml, TruthValuesHaveTheWordsAndCapitalsOfYaml) {
    const auto nodes = [](const std::string& value) {
        Diagnostics found;
        const SceneDescription scene =
            import_text(course_scene(kCamera, "    -   Enabled: " + value +
                                                  "\n        Components:\n"
                                                  "            Sphere: {Material: Red One}\n"),
                        "a.yaml", found);
        EXPECT_EQ(text_of(found), "") << value;
        return scene.objects.at(0).parts.size();
    };
    for (const char* on : {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"}) {
        EXPECT_EQ(nodes(on), 1U) << on;
    }
    for (const char* off : {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"}) {
        EXPECT_EQ(nodes(off), 0U) << off;
    }
    Diagnostics found;
    import_text(course_scene(kCamera, "    -   Enabled: tRUE\n"), "a.yaml", found);
    EXPECT_TRUE(mentions(found, "'Enabled' must be true or false")) << text_of(found);
}

TEST(UwYaml, AnotherDocumentInTheFileIsAWarning) {
    const std::string scene = course_scene("        Sphere: {Material: Red One}\n" + kCamera);
    Diagnostics found;
    EXPECT_EQ(import_text("---\n" + scene + "---\nRoot: {}\n", "a.yaml", found)
                  .objects.at(0)
                  .parts.size(),
              1U);
    EXPECT_TRUE(mentions(found, "warning: another YAML document in the file is not read"));
    EXPECT_EQ(found.all().size(), 1U) << text_of(found);
    Diagnostics none;
    import_text("---\n" + scene + "...\n---\n# nothing\n", "a.yaml", none);
    EXPECT_EQ(text_of(none), "");
}

TEST(UwYaml, WhatIsNotEnabledIsNotThere) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene("        Sphere: {Material: Red One}\n",
                     "    -   Name: off\n        Enabled: false\n        Components:\n"
                     "            Sphere: {Material: Nothing}\n        Children:\n"
                     "        -   Components:\n                Sphere: {Material: Nothing}\n"),
        "a.yaml", found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(scene.objects[0].parts.size(), 1u);
}

TEST(UwYaml, WhatCannotBeDrawnIsAWarningThatNamesIt) {
    Diagnostics found;
    const SceneDescription scene = import_text(
        course_scene(
            "        SurfaceOfRevolution: {Material: Red One}\n        RobotArmProp: {Angle: 0}\n"
            "        ParticleSystem: {Material: Red One}\n        AreaLight: {Color: {R: 1}}\n"
            "        EnvironmentMap: {Far Plane: 100}\n",
            "    -   Components:\n            Transform: {Scale: {X: 0, Y: 1, Z: 1}}\n"
            "            Sphere: {Material: Red One}\n"),
        "a.yaml", found);
    EXPECT_EQ(found.error_count(), 0u);
    EXPECT_EQ(found.warning_count(), 5u) << text_of(found);
    for (const char* name :
         {"SurfaceOfRevolution", "RobotArmProp", "ParticleSystem", "AreaLight"}) {
        EXPECT_TRUE(mentions(found, name)) << name;
    }
    EXPECT_TRUE(scene.objects[0].parts.empty());
    EXPECT_EQ(scene.lights.size(), 1u);
}

TEST(UwYaml, UnknownAndRepeatedKeysAreWarningsAndMergeKeysAreErrors) {
    const auto finding = [](const std::string& text) {
        Diagnostics found;
        import_text(text, "a.yaml", found);
        return text_of(found);
    };
    const auto of_components = [&](const std::string& components) {
        return finding(course_scene(components));
    };
    // The first component is in line 16.
    EXPECT_EQ(of_components("        Sphere: {Material: Red One, Radius: 2}\n"),
              "a.yaml:16:37: warning: the key 'Radius' of 'Sphere' is not known; ignored\n");
    EXPECT_EQ(of_components("        Transform: {Translate: {X: 2}, Scale: {x: 2}}\n"),
              "a.yaml:16:21: warning: the key 'Translate' of 'Transform' is not known; ignored\n"
              "a.yaml:16:48: warning: the key 'x' of 'Scale' is not known; ignored\n");
    EXPECT_EQ(of_components("        PointLight: {Colour: {R: 1}}\n        Camera: {Fov: 40, "
                            "Trace: {Depth: 1}, Trace Debugger: {Show: 1}}\n"),
              "a.yaml:16:22: warning: the key 'Colour' of 'light' is not known; ignored\n"
              "a.yaml:17:18: warning: the key 'Fov' of 'Camera' is not known; ignored\n"
              "a.yaml:17:63: warning: the key 'Show' of 'Trace Debugger' is not known; ignored\n"
              "a.yaml:17:35: warning: the key 'Depth' of 'Trace' is not known; ignored\n");
    EXPECT_EQ(of_components("        Sphere: {Material: Red One, Material: Blue}\n"),
              "a.yaml:16:37: warning: 'Material' is given twice in 'Sphere'; the first counts\n");
    EXPECT_EQ(of_components("        PointLight: {Color: {R: 1}, <<: {Ambient: {R: 1}}}\n"),
              "a.yaml:16:37: error: merge keys (<<) are not supported; repeat what they merge\n");
    // Once for each name, whatever its number of places.
    const std::string sphere = "        Sphere: {Material: Red One}\n";
    EXPECT_EQ(
        finding(course_scene(sphere, "    -   {Nam: a}\n    -   {Nam: b}\n") + "Lights: {}\n"),
        "a.yaml:20:1: warning: the key 'Lights' of 'the scene' is not known; ignored\n"
        "a.yaml:18:10: warning: the key 'Nam' of 'a node' is not known; ignored\n");
    std::string text = course_scene(sphere);
    text.replace(text.find("Shininess"), 9, "Shinines");
    EXPECT_EQ(finding(text),
              "a.yaml:10:13: warning: the key 'Shinines' of 'Uniforms' is not known; ignored\n");
    text = course_scene(sphere);
    text.replace(text.find("Color: {R: 0.75"), 5, "Colour");
    EXPECT_EQ(finding(text),
              "a.yaml:6:23: warning: the key 'Colour' of 'Diffuse' is not known; ignored\n");
    EXPECT_NE(finding(course_scene(sphere, "        5\n")).find("'Children' must be a list"),
              std::string::npos);
    EXPECT_NE(of_components("            [1]\n").find("'Components' must be a map"),
              std::string::npos);
}

TEST(UwYaml, TransmittanceMayBeSpeltBothWays) {
    std::string text = course_scene("        Sphere: {Material: Red One}\n");
    text.replace(text.find("Transmittence"), 13, "Transmittance");
    Diagnostics found;
    const SceneDescription scene = import_text(text, "a.yaml", found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(scene.materials.at(0).material.transmissive.color, (Rgb{0, 0.9, 0}));
}

TEST(UwYaml, FindingsNameLineAndColumn) {
    const auto expect = [](const std::string& components, const char* part) {
        Diagnostics found;
        import_text(course_scene(components), "a.yaml", found);
        EXPECT_GT(found.error_count(), 0u);
        EXPECT_TRUE(mentions(found, part)) << components << "\n" << text_of(found);
    };
    // The first component is in line 16.
    expect("        Sphere: {Material: Blue}\n",
           "a.yaml:16:17: error: unknown material 'Blue'; expected one of Red One");
    expect("        TriangleMesh: {Material: Red One, Mesh: cow}\n",
           "a.yaml:16:23: error: unknown mesh 'cow'");
    expect("        Transform: {Scale: {X: much}}\n",
           "a.yaml:16:32: error: 'X' must be a finite number");
    expect("        Transform: {Scale: {X: .inf}}\n", "a.yaml:16:32: error");
    expect("        Transform: {Scale: [1, 2]}\n",
           "a.yaml:16:28: error: 'Scale' must have X, Y and Z");
    expect("        Camera: {FOV: 180}\n", "a.yaml:16:17: error: the FOV");
    expect("        Camera: {FOV: 50, Render Width (px): 1e9}\n",
           "a.yaml:16:17: error: the picture");
    expect("        Sphere: {Material: [\n", "not valid YAML");
    expect("\tSphere:\n", "a.yaml:");
    Diagnostics found;
    import_text("Materials:\nRoot:\n", "a.yaml", found);
    EXPECT_TRUE(mentions(found, "no map 'Root'"));
}

TEST(UwYaml, DeepTextsAreBadScenesAndLargeOnesErrorsOfResources) {
    std::string brackets = "Materials: 1\nRoot: ";
    std::string dashes = brackets;
    std::string lines = "Materials: 1\nRoot:\n";
    for (int i = 0; i < 1000; ++i) {
        brackets += '[';
        dashes += "\n" + std::string(std::size_t(i), ' ') + "-";
        lines += std::string(std::size_t(i % 1000) + 1, ' ') + "a:\n";
    }
    const std::string large(std::size_t{9} << 20, ' ');
    for (const std::string& text : {brackets, dashes, lines, "Materials: 1\nRoot: 1\n" + large}) {
        Diagnostics found;
        try {
            import_text(text, "a.yaml", found);
            ADD_FAILURE() << "accepted";
        } catch (const Error& e) {
            const bool is_large = text.size() > large.size();
            EXPECT_EQ(e.kind(), is_large ? ErrorKind::Resource : ErrorKind::Scene) << e.what();
        }
    }
}

TEST(UwYaml, AliasesCannotMakeAShortTextEndless) {
    std::string laughs = "Materials: {}\nA0: &a0 {Components: {}}\n";
    for (int i = 1; i < 60; ++i) {
        const std::string before = std::to_string(i - 1);
        laughs += "A" + std::to_string(i) + ": &a" + std::to_string(i) + " {Children: [*a" +
                  before + ", *a" + before + "]}\n";
    }
    for (const std::string& text :
         {laughs + "Root: *a59\n", std::string("Materials: {}\nRoot: &r {Children: [*r, *r]}\n")}) {
        Diagnostics found;
        EXPECT_THROW(import_text(text, "a.yaml", found), Error);
    }
}

TEST(UwYaml, FilesAreLookedForFromTheFolderThatHoldsAssets) {
    const testing::TemporaryFolder folder;
    folder.write("assets/meshes/one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("secret.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto import_mesh = [&](const std::string& path, Diagnostics& found) {
        const std::string text =
            "Meshes: {one: {Path: " + path + "}}\n" +
            course_scene("        TriangleMesh: {Material: Red One, Mesh: one}\n");
        const auto file = folder.write("assets/scenes/deep/a.yaml", text);
        return import_text(text, file, found).meshes.size();
    };
    Diagnostics found;
    EXPECT_EQ(import_mesh("assets/meshes/one.obj", found), 1u) << text_of(found);
    EXPECT_EQ(import_mesh("assets\\meshes\\One.OBJ", found), 1u) << text_of(found);
    EXPECT_EQ(found.error_count(), 0u);
    for (const char* path :
         {"../secret.obj", "/etc/passwd", "assets/../../x.obj", "assets/none.obj", "\"\""}) {
        Diagnostics refused;
        EXPECT_EQ(import_mesh(path, refused), 0u);
        EXPECT_TRUE(mentions(refused, "a.yaml:1:15: error: the mesh 'one'")) << text_of(refused);
    }
}

TEST(UwYaml, RandomDamageNeverDoesMoreThanFindings) {
    const std::string good = course_scene(
        "        Sphere: {Material: Red One}\n" + kCamera,
        "    -   Name: child\n        Components:\n            PointLight: {Color: {R: 1}}\n");
    std::mt19937 random(13);
    for (int round = 0; round < 2000; ++round) {
        std::string bytes = good;
        for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = char(random() % 256);
        SCOPED_TRACE(round);
        const ImportOptions options;
        const ImportSource source{bytes, "a.yaml", options};
        Diagnostics found;
        try {
            validate(find_importer(source).import(source, found), found);
        } catch (const Error& e) {
            EXPECT_TRUE(e.kind() == ErrorKind::Resource || e.kind() == ErrorKind::Scene)
                << e.what();
        }
    }
}

TEST(UwYaml, EverySceneOfTheCourseIsImportedAndValid) {
    ALHAZEN_NEEDS_DATA("ray/uw2020_yaml/assets");
    struct Fact {
        const char* file;
        std::size_t parts, lights;
        int depth, width;
    };
    for (const Fact& fact :
         {Fact{"trace/simple/box", 1, 1, 3, 512},
          Fact{"trace/simple/box_cyl_reflect", 2, 2, 3, 512},
          Fact{"trace/simple/box_cyl_trans_shadow", 2, 1, 3, 512},
          Fact{"trace/simple/cyl_ambient", 1, 1, 3, 512},
          Fact{"trace/simple/cyl_diffuse", 1, 1, 3, 512},
          Fact{"trace/simple/poly_sphere", 1, 1, 3, 512},
          Fact{"trace/simple/sphere_refract", 3, 1, 3, 512},
          Fact{"trace/trimeshes/revolution", 1, 2, 3, 512}, Fact{"robotarm", 3, 2, 5, 1280},
          Fact{"robotarm_with_ui", 3, 2, 5, 1280},
          Fact{"scene/point_light_scene", 1, 3, 5, 1280}}) {
        SCOPED_TRACE(fact.file);
        Diagnostics found;
        const SceneDescription scene = import_scene(
            testing::test_data() / "ray/uw2020_yaml/assets" / (std::string(fact.file) + ".yaml"),
            {}, found);
        EXPECT_EQ(scene.format, "uw_yaml");
        EXPECT_EQ(scene.objects[0].parts.size(), fact.parts);
        EXPECT_EQ(scene.lights.size(), fact.lights);
        EXPECT_EQ(scene.conventions.shading.max_depth, fact.depth);
        EXPECT_EQ(scene.picture.width, fact.width);
        EXPECT_EQ(scene.cameras.size(), 1u);
        const bool has_prop = std::string(fact.file) == "robotarm_with_ui";
        EXPECT_EQ(found.warning_count(), has_prop ? 1u : 0u) << text_of(found);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
