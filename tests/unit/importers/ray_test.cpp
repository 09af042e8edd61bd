#include "alhazen/importers/ray/ray_importer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "alhazen/base/file.h"
#include "support/test_data.h"
#include "text_scene.h"

namespace alhazen {
namespace {

using testing::Imported;

Imported import(const std::string& body, const ImportOptions& options = {}) {
    return testing::import_text<RayImporter>("SBT-raytracer 1.0\n" + body, "scene.ray", options);
}

Imported import_file(const std::filesystem::path& path) {
    return testing::import_text<RayImporter>(read_file(path), path);
}

const Material& material_of(const Imported& i, std::size_t part) {
    return i.scene.materials.at(static_cast<std::size_t>(i.parts().at(part).material)).material;
}

void expect_near(const Vec3& a, const Vec3& b) {
    EXPECT_NEAR(a.x, b.x, 1e-12);
    EXPECT_NEAR(a.y, b.y, 1e-12);
    EXPECT_NEAR(a.z, b.z, 1e-12);
}

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

TEST(RayImporter, LooksDownMinusZWithUnitHeightByDefault) {
    const Imported i = import("camera { }");
    ASSERT_EQ(i.scene.cameras.size(), 1u);
    const auto& c = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    expect_near(c.look, {0, 0, -1});
    expect_near(c.right, {1, 0, 0});
    expect_near(c.up, {0, 1, 0});
}

TEST(RayImporter, AFileWithoutACameraHasTheProgramsOwn) {
    const Imported i = import("sphere { }");
    ASSERT_EQ(i.scene.cameras.size(), 1u);
    const auto& camera = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    EXPECT_EQ(camera.eye, (Vec3{0, 0, 0}));
    EXPECT_EQ(camera.look, (Vec3{0, 0, -1}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
}

TEST(RayImporter, SmallShininessDecidesNothingWhereTheTokenFamilySpellsItself) {
    const std::string material = "sphere { material = { shininess = 0.2; } }\n";
    using ShadowTint = ShadingConventions::ShadowTint;
    EXPECT_EQ(import(material).scene.conventions.shadow_tint, ShadowTint::PerCrossing);
    const std::string mesh =
        "polymesh { points = ((0,0,0),(1,0,0),(0,1,0)); faces = ((0,1,2)); gennormals; }\n";
    EXPECT_EQ(import(material + mesh).scene.conventions.shadow_tint, ShadowTint::PerDistance);
}

TEST(RayImporter, KeepsTheShearAndLengthOfTheCamera) {
    const Imported i = import(
        "camera { position = (15,0,5); viewdir = (-1,0,-.3); updir = (0,0,2);"
        " fov = 90 aspectratio = 1.5 }");
    const auto& c = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    expect_near(c.eye, {15, 0, 5});
    expect_near(c.look, {-1, 0, -.3});
    expect_near(c.up, {0, 0, 4});  // updir times 2 tan 45
    expect_near(c.right, 3.0 * cross(Vec3{-1, 0, -.3}, Vec3{0, 0, 2}));
    EXPECT_EQ(i.scene.cameras[0].aspect, 1.5);
}

TEST(RayImporter, NormalisesTheCameraOfTheDictionaryFamilyOnly) {
    const std::string camera = "camera { viewdir = (0,0,-3); updir = (0,2,1); ";
    const auto look = [](const Imported& i) {
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).look;
    };
    const auto up = [](const Imported& i) {
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).up;
    };
    expect_near(look(import(camera + "}")), {0, 0, -3});
    const Imported a = import(camera + "focaldistance = 3; }");
    expect_near(look(a), {0, 0, -1});
    expect_near(up(a), Vec3{0, 2, 1} / std::sqrt(5.0));  // and still not perpendicular
}

TEST(RayImporter, TurnsTheCameraByAQuaternionInBothSpellings) {
    const double s = std::sin(std::numbers::pi / 4);  // a quarter turn about y: -z becomes -x
    for (const char* key : {"quaternian", "quaternion"}) {
        const Imported i = import(std::string("camera { ") + key + " = (0," + std::to_string(s) +
                                  ",0," + std::to_string(s) + ") }");
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        const Vec3 look = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).look;
        expect_near(look, {-1, 0, 0});
    }
}

TEST(RayImporter, WantsViewAndUpTogether) {
    EXPECT_TRUE(import("camera { viewdir = (1,0,0) }").says("together"));
    EXPECT_TRUE(import("camera { viewdir = (0,0,0); updir = (0,1,0) }").says("zero vector"));
}

TEST(RayImporter, DefaultsAttenuationByFamily) {
    const std::string light = "point_light { position = (1,2,3); colour = (1,.5,.25) ";
    const Imported b = import(light + "}");
    const auto& of_b = std::get<PointLight>(b.scene.lights.at(0).light);
    EXPECT_EQ(of_b.attenuation.constant, 0);
    EXPECT_EQ(of_b.attenuation.quadratic, 1);
    expect_near(of_b.position, {1, 2, 3});
    EXPECT_EQ(of_b.color, (Rgb{1, .5, .25}));
    const Imported a = import(light + "} material { name = \"m\"; }");
    const auto& of_a = std::get<PointLight>(a.scene.lights.at(0).light);
    EXPECT_EQ(of_a.attenuation.constant, 1);
    EXPECT_EQ(of_a.attenuation.quadratic, 0);
}

TEST(RayImporter, TurnsLightDirectionsAround) {
    const Imported i = import("directional_light { direction = (0,0,-2); color = (1,1,1) }");
    expect_near(std::get<DirectionalLight>(i.scene.lights.at(0).light).to_light, {0, 0, 1});
}

TEST(RayImporter, RequiresWhatALightNeeds) {
    EXPECT_TRUE(import("point_light { color = (1,1,1) }").says("'position = ...' is missing"));
    EXPECT_TRUE(import("point_light { position = (1,1,1) }").says("'color = ...' is missing"));
    EXPECT_TRUE(import("directional_light { color = (1,1,1) }").says("'direction = ...'"));
    EXPECT_TRUE(import("directional_light { color = (1,1,1); direction = (0,0,0) }")
                    .says("must not be the zero vector"));
}

TEST(RayImporter, ReadsSpotLightsInThreeSpellings) {
    const std::string start = "spot_light { position = (0,2,0); colour = (1,1,1); ";
    const struct {
        const char* keys;
        double inner, outer;
    } cases[] = {{"direction = (0,-2,0); edgeplace = (30,0,0); }", 30, 30},
                 {"direction = (0,-2,0); size = 60; blend = 0.5; }", 15, 30},
                 {"target = (0,0,0); cone_angle = 40; penumbra = 5; }", 20, 25}};
    for (const auto& c : cases) {
        const Imported i = import(start + c.keys);
        ASSERT_EQ(i.errors(), 0u) << i.messages();
        const auto& light = std::get<SpotLight>(i.scene.lights.at(0).light);
        expect_near(light.direction, {0, -1, 0});
        EXPECT_NEAR(light.inner_angle * 180 / std::numbers::pi, c.inner, 1e-12);
        EXPECT_NEAR(light.outer_angle * 180 / std::numbers::pi, c.outer, 1e-12);
    }
    EXPECT_EQ(import(start + "direction = (0,0,0); size = 3 }").errors(), 1u);
    EXPECT_EQ(import(start + "direction = (0,1,0) }").errors(), 1u);
}

TEST(RayImporter, TakesAnAreaLightOfRadiusZeroForAPoint) {
    const std::string start = "area_light { position = (0,2,0); color = (1,1,1); ";
    EXPECT_EQ(import(start + "light_radius = 0 }").errors(), 0u);
    EXPECT_EQ(import(start + "light_radius = 0.5 }").errors(), 1u);
    EXPECT_TRUE(import(start + "u = (1,0,0); v = (0,1,0) }").says("lights with an extent"));
}

TEST(RayImporter, MultipliesTransformsFromTheOutsideIn) {
    const Imported i = import(
        "translate(1,2,3, rotate(0,0,1, 1.5707963267948966, scale(2, translate(1,0,0, "
        "sphere{}))))");
    ASSERT_EQ(i.parts().size(), 1u) << i.messages();
    expect_near(i.parts()[0].object_from_part.point({0, 0, 0}), {1, 4, 3});
    expect_near(i.parts()[0].object_from_part.point({1, 0, 0}), {1, 6, 3});
}

TEST(RayImporter, TakesTheRowsOfAMatrix) {
    const Imported i = import("transform((1,2,3,4),(0,1,5,6),(0,0,1,7),(0,0,0,1), box{})");
    expect_near(i.parts().at(0).object_from_part.point({1, 1, 1}), {10, 12, 8});
    EXPECT_TRUE(
        import("transform((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,1,1), box{})").says("last row"));
}

TEST(RayImporter, GivesTheSolidsTheSizesOfTheFormat) {
    const Imported i = import(
        "sphere{} box{} square{} cylinder{} cone{}"
        "cone{ height = -2; bottom_radius = -.5; top_radius = .25; capped = false }");
    ASSERT_EQ(i.parts().size(), 6u) << i.messages();
    EXPECT_EQ(std::get<Sphere>(std::get<AnyShape>(i.parts()[0].what)).radius, 1);
    EXPECT_EQ(std::get<BoxShape>(std::get<AnyShape>(i.parts()[1].what)).lo, (Vec3{-.5, -.5, -.5}));
    EXPECT_EQ(std::get<Rectangle>(std::get<AnyShape>(i.parts()[2].what)).corner,
              (Vec3{-.5, -.5, 0}));
    EXPECT_EQ(std::get<Cylinder>(std::get<AnyShape>(i.parts()[3].what)).top, (Vec3{0, 0, 1}));
    const auto& cone = std::get<Cone>(std::get<AnyShape>(i.parts()[5].what));
    EXPECT_EQ(cone.top, (Vec3{0, 0, -2}));
    EXPECT_EQ(cone.base_radius, .5);
    EXPECT_EQ(cone.top_radius, .25);
    EXPECT_FALSE(cone.capped);
}

TEST(RayImporter, CarriesADefaultMaterialOnAndBackOutOfAGroup) {
    const Imported i = import(
        "material = { diffuse = (1,0,0); shininess = 9 }"
        "sphere {}"
        "{ material = { specular = (0,1,0) } sphere {} }"
        "translate(1,0,0, { material = { diffuse = (0,0,1) } sphere {} })"
        "sphere { material = { ambient = (1,1,1) } }"
        "sphere {}");
    ASSERT_EQ(i.parts().size(), 5u) << i.messages();
    EXPECT_EQ(material_of(i, 0).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(material_of(i, 1).specular.color, (Rgb{0, 1, 0}));
    EXPECT_EQ(material_of(i, 2).diffuse.color, (Rgb{0, 0, 1}));
    EXPECT_EQ(material_of(i, 3).shininess.value, 9);
    EXPECT_EQ(material_of(i, 4).specular.color, (Rgb{}));
    EXPECT_EQ(material_of(i, 4).ambient.color, (Rgb{}));
}

TEST(RayImporter, FindsMaterialsByNameInBothSpellings) {
    const Imported i = import(
        "material = { name red; diffuse = (1,0,0) } "
        "material { name = \"#2\"; diffuse = (0,1,0); } "
        "sphere { material = \"#2\" } sphere { material = red } sphere { }");
    ASSERT_EQ(i.parts().size(), 3u) << i.messages();
    EXPECT_EQ(i.errors(), 0u) << i.messages();
    EXPECT_EQ(material_of(i, 0).diffuse.color, (Rgb{0, 1, 0}));
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{1, 0, 0}));
    EXPECT_EQ(i.parts()[1].material, i.parts()[2].material);
}

TEST(RayImporter, ReportsUndefinedAndRepeatedNames) {
    const Imported i = import("material = { name red; } sphere { material = blue }");
    EXPECT_TRUE(i.says("scene.ray:2:46: error: material 'blue' is not defined; defined are red"))
        << i.messages();
    EXPECT_TRUE(import("material = { name red; } material = { name red; }")
                    .says("'red' is already defined in line 2"));
}

TEST(RayImporter, TellsTheFamiliesApart) {
    const auto shininess = [](const std::string& value, const std::string& more = "") {
        const Imported i = import(
            "sphere { material = { specular = (.5,.5,.5); shininess = " + value + " } } " + more);
        return material_of(i, 0).shininess.value;
    };
    EXPECT_EQ(shininess("25.6"), 25.6);
    EXPECT_EQ(shininess("0.5"), 64);
    EXPECT_EQ(shininess("2"), 256);
    EXPECT_EQ(shininess("0.5", "sphere { material = { shininess = 76.8 } }"), 0.5);
    EXPECT_EQ(shininess("25.6", "material { name = \"x\" }"), 25.6);

    const Imported b = import("sphere { material = { specular = (.5,.5,.5); shininess = 25.6 } }");
    EXPECT_EQ(material_of(b, 0).reflective.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(b.scene.conventions.shadow_tint, ShadingConventions::ShadowTint::PerDistance);
    EXPECT_EQ(b.scene.conventions.refraction_tint, ShadingConventions::RefractionTint::PerDistance);
    const Imported a = import("sphere { material = { specular = (.5,.5,.5); shininess = .2 } }");
    EXPECT_EQ(material_of(a, 0).reflective.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(a.scene.conventions.shadow_tint, ShadingConventions::ShadowTint::PerCrossing);
    EXPECT_EQ(a.scene.conventions.refraction_tint, ShadingConventions::RefractionTint::PerEvent);
    for (const Imported* i : {&a, &b}) {
        EXPECT_EQ(i->scene.conventions.pixel_sample,
                  ShadingConventions::PixelSample::LowerLeftCorner);
        EXPECT_EQ(i->scene.conventions.highlight, ShadingConventions::Highlight::Phong);
        EXPECT_TRUE(i->scene.conventions.linear_output);
    }
}

TEST(RayImporter, KeepsAWrittenReflectiveWhateverTheSpecular) {
    const Imported i = import(
        "sphere { material = { reflective = (0,0,0); specular = (.5,.5,.5); shininess = .2 } }");
    EXPECT_EQ(material_of(i, 0).reflective.color, (Rgb{}));
}

constexpr const char* kSquareMesh =
    "points = ((0,0,0),(1,0,0),(1,1,0),(0,1,0)); faces = ((0,1,2,3)); ";

TEST(RayImporter, MakesFansOfPolygons) {
    const Imported i = import(std::string("polymesh { ") + kSquareMesh + " gennormals; }");
    ASSERT_EQ(i.scene.meshes.size(), 1u) << i.messages();
    const TriangleMesh& mesh = *i.scene.meshes[0].mesh;
    ASSERT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
    ASSERT_EQ(mesh.normals.size(), 4u);
    expect_near(mesh.normals[0], {0, 0, 1});
}

TEST(RayImporter, ReadsNormalsAndMaterialsAtTheVertices) {
    const Imported i =
        import(std::string("material = { name a; diffuse = (1,0,0) } trimesh { ") + kSquareMesh +
               "normals = ((0,0,2),(0,0,2),(0,0,2),(0,2,0)); "
               "materials = (a, { diffuse = (0,1,0) }, a, a); }");
    ASSERT_EQ(i.errors(), 0u) << i.messages();
    const TriangleMesh& mesh = *i.scene.meshes.at(0).mesh;
    expect_near(mesh.normals.at(3), {0, 1, 0});
    ASSERT_EQ(mesh.vertex_materials.size(), 4u);
    EXPECT_EQ(mesh.vertex_materials[0], mesh.vertex_materials[2]);
    EXPECT_EQ(i.scene.materials[mesh.vertex_materials[1]].material.diffuse.color, (Rgb{0, 1, 0}));
}

TEST(RayImporter, ReportsEveryBadIndexOfAMesh) {
    const Imported i = import(
        "trimesh { points = ((0,0,0),(1,0,0),(1,1,0));\n"
        " faces = ((0,1,3),(0,1,-1),(0,1,.5),(0,1),(0,1,x),(0,1,2)); }");
    EXPECT_EQ(i.errors(), 5u) << i.messages();
    EXPECT_TRUE(
        i.says("scene.ray:3:16: error: faces: a vertex number must be a whole number "
               "from 0 to 2"))
        << i.messages();
    EXPECT_TRUE(i.scene.meshes.empty());
    EXPECT_EQ(import("trimesh { faces = ((0,1,2)); points = ((0,0,0)) }").errors(), 1u);
    EXPECT_EQ(import("trimesh { }").errors(), 2u);
    EXPECT_EQ(import(std::string("trimesh { ") + kSquareMesh + "normals = ((0,0,1)); }").errors(),
              1u);
    EXPECT_EQ(import(std::string("trimesh { ") + kSquareMesh + "materials = ({}); }").errors(), 1u);
}

TEST(RayImporter, WarnsOfUnknownKeysWithTheirPlace) {
    const Imported i = import("sphere {\n  colour = (1,1,1) }");
    EXPECT_EQ(i.errors(), 0u);
    EXPECT_TRUE(i.says("scene.ray:3:3: warning: sphere: unknown key 'colour'; known are material"))
        << i.messages();
    EXPECT_TRUE(import("sphere { material = { roughnes = 1 } }").says("warning"));
    EXPECT_TRUE(import("camera { position = (0,0,0); position = (1,1,1) }").says("given twice"));
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
        {"warp { }", "unknown object 'warp'; known are sphere"},
    };
    for (const auto& c : cases) {
        const Imported i = import(c.text);
        EXPECT_EQ(i.errors(), 1u) << c.text << "\n" << i.messages();
        EXPECT_TRUE(i.says(c.message)) << i.messages();
    }
}

TEST(RayImporter, GoesOnAfterAnErrorAndReportsAll) {
    const Imported i = import(
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
    const Imported i = import("box { material = {\n diffuse = map(\"no_such.bmp\") } }");
    EXPECT_EQ(i.errors(), 1u) << i.messages();
    EXPECT_TRUE(i.says("scene.ray:3:16: error: texture: ")) << i.messages();
    EXPECT_EQ(import("box { material = { diffuse = map(\"/etc/passwd\") } }").errors(), 1u);
    EXPECT_EQ(import("box { material = { diffuse = map(\"../../../x.png\") } }").errors(), 1u);
    EXPECT_EQ(import("box { material = { diffuse = map(\"\") } }").errors(), 1u);
    EXPECT_EQ(import("box { material = { diffuse = map(3) } }").errors(), 1u);
}

TEST(RayImporter, RefusesDeepNestingWithOneError) {
    for (const char* open : {"translate(0,0,0,", "{", "sphere { material = {", "x = ("}) {
        std::string text;
        for (int k = 0; k < 100'000; ++k) text += open;
        const Imported i = import(text);
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
        const Imported i = import(text, {.max_nesting = 1'000'000});
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        expect_near(i.parts().at(0).object_from_part.point({0, 0, 0}), {1.0 * levels, 0, 0});
    }
}

TEST(RayImporter, MakesAValidSceneOfNothing) {
    Imported i = import("camera { }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 0u) << i.messages();
}

TEST(RayImporter, StopsAtTheLimitOfElements) {
    std::string text;
    for (int k = 0; k < 200; ++k) text += "sphere{}";
    EXPECT_THROW((void)import(text, {.max_elements = 100}), Error);
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

/// The scenes that need an extension, and what the message must name.
const std::pair<const char*, const char*> kRefused[] = {
    {"csg.ray", "constructive solid geometry"},
    {"hyperbolic.ray", "hyperbolic"},
    {"metaball.ray", "metaballs"},
    {"meteorite.ray", "particle"},
    {"paraboloid.ray", "paraboloids"},
    {"shapeLight.ray", "lights cut to a shape"},
};

TEST(RayImporter, ReadsTheScenesOfThreeUniversities) {
    ALHAZEN_NEEDS_DATA("ray/ut_austin");
    ALHAZEN_NEEDS_DATA("ray/hkust");
    int read = 0, refused = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(testing::test_data() / "ray")) {
        if (entry.path().extension() != ".ray") continue;
        const Imported i = import_file(entry.path());
        const std::string name = entry.path().filename().string();
        const auto* expected = std::find_if(std::begin(kRefused), std::end(kRefused),
                                            [&](const auto& r) { return r.first == name; });
        if (expected != std::end(kRefused)) {
            ++refused;
            EXPECT_GE(i.errors(), 1u) << entry.path();
            EXPECT_TRUE(i.says(expected->second)) << i.messages();
            continue;
        }
        ++read;
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        EXPECT_EQ(i.scene.cameras.size(), 1u) << entry.path();
        EXPECT_TRUE(!i.parts().empty() || name == "blank.ray") << entry.path();
    }
    EXPECT_EQ(read, 82);
    EXPECT_EQ(refused, 6);
}

TEST(RayImporter, CountsWhatIsInKnownScenes) {
    ALHAZEN_NEEDS_DATA("ray/ut_austin/assets/scenes/polymesh/dragon.ray");
    const auto scenes = testing::test_data() / "ray/ut_austin/assets/scenes";
    const Imported dragon = import_file(scenes / "polymesh/dragon.ray");
    EXPECT_EQ(dragon.scene.meshes.at(0).mesh->triangles.size(), 10'000u);
    const Imported map = import_file(scenes / "simple/texture_map_png.ray");
    ASSERT_EQ(map.scene.textures.size(), 1u);
    EXPECT_EQ(material_of(map, 0).diffuse.texture, TextureId{0});
}

}  // namespace
}  // namespace alhazen
