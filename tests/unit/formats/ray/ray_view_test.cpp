/// Cameras and lights of .ray files.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "ray_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::import_ray;
using testing::Imported;

TEST(RayImporter, LooksDownMinusZWithUnitHeightByDefault) {
    const Imported i = import_ray("camera { }");
    ASSERT_EQ(i.scene.cameras.size(), 1u);
    const auto& c = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    expect_near(c.look, {0, 0, -1});
    expect_near(c.right, {1, 0, 0});
    expect_near(c.up, {0, 1, 0});
}

TEST(RayImporter, AFileWithoutACameraHasTheProgramsOwn) {
    const Imported i = import_ray("sphere { }");
    ASSERT_EQ(i.scene.cameras.size(), 1u);
    const auto& camera = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    EXPECT_EQ(camera.eye, (Vec3{0, 0, 0}));
    EXPECT_EQ(camera.look, (Vec3{0, 0, -1}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
}

TEST(RayImporter, KeepsTheShearAndLengthOfTheCamera) {
    const Imported i = import_ray(
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
    expect_near(look(import_ray(camera + "}")), {0, 0, -3});
    const Imported a = import_ray(camera + "focaldistance = 3; }");
    expect_near(look(a), {0, 0, -1});
    expect_near(up(a), Vec3{0, 2, 1} / std::sqrt(5.0));  // not perpendicular to the view either
}

TEST(RayImporter, TurnsTheCameraByAQuaternionInBothSpellings) {
    // A quarter turn about y: -z becomes -x.
    const std::string s = "0.70710678118654752";
    for (const char* key : {"quaternian", "quaternion"}) {
        const Imported i =
            import_ray(std::string("camera { ") + key + " = (0," + s + ",0," + s + ") }");
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        const Vec3 look = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).look;
        expect_near(look, {-1, 0, 0});
    }
}

TEST(RayImporter, OfTwoSpellingsOfAKeyTheLastCountsWithAWarning) {
    const auto of_light = [](const char* colors) {
        return import_ray(std::string("ambient_light { ") + colors + " }");
    };
    const Imported first = of_light("colour = (.2,.2,.2); color = (1,0,0)");
    EXPECT_EQ(std::get<AmbientLight>(first.scene.lights.at(0).light).ambient, (Rgb{1, 0, 0}));
    EXPECT_TRUE(first.says("warning: ambient_light: 'color' is given twice, first as 'colour'"))
        << first.messages();
    const Imported last = of_light("color = (1,0,0); colour = (.2,.2,.2)");
    EXPECT_EQ(std::get<AmbientLight>(last.scene.lights.at(0).light).ambient, (Rgb{.2, .2, .2}));
    EXPECT_TRUE(last.says("warning: ambient_light: 'colour' is given twice, first as 'color'"));
    EXPECT_EQ(of_light("colour = (.2,.2,.2)").messages(), "");
    EXPECT_TRUE(of_light("color = (1,0,0); color = (0,0,0)").says("'color' is given twice\n"));

    const Imported turned = import_ray("camera { quaternion = (0,0,0,1); quaternian = (0,1,0,0) }");
    expect_near(std::get<PerspectiveCamera>(turned.scene.cameras.at(0).camera).look, {0, 0, 1});
    EXPECT_TRUE(turned.says("'quaternian' is given twice, first as 'quaternion'"));
    const Imported both =
        import_ray("camera { viewdir = (0,0,-1); updir = (0,1,0); quaternian = (0,1,0,0) }");
    expect_near(std::get<PerspectiveCamera>(both.scene.cameras.at(0).camera).look, {0, 0, -1});
    EXPECT_TRUE(both.says("warning: camera: a quaternion has no effect beside viewdir"));
}

TEST(RayImporter, LooksAtAPoint) {
    const auto camera = [](const Imported& i) {
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    };
    const PerspectiveCamera c =
        camera(import_ray("camera { look_at = (3,0,4); position = (3,0,9); }"));
    expect_near(c.look, {0, 0, -1});
    expect_near(c.up, {0, 1, 0});
    expect_near(c.right, {1, 0, 0});
    const PerspectiveCamera turned =
        camera(import_ray("camera { position = (0,0,0); look_at = (0,9,9); updir = (0,0,2); }"));
    expect_near(turned.look, Vec3{0, 1, 1} / std::sqrt(2.0));
    expect_near(turned.up, {0, 0, 2});
    for (const char* bad : {"look_at = (0,0,0);", "look_at = (0,3,0); updir = (0,1,0);"}) {
        EXPECT_TRUE(import_ray(std::string("camera { ") + bad + " }").says("look_at must not lie"));
    }
}

TEST(RayImporter, LooksAtAPointAsAlongItsDirectionWithUpdirAsWritten) {
    const auto camera = [](const char* keys) {
        const Imported i =
            import_ray(std::string("camera { position = (0,3,4); ") + keys + " updir = (0,1,0); }");
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    };
    const PerspectiveCamera at = camera("look_at = (0,0,0);");
    const PerspectiveCamera along = camera("viewdir = (0,-.6,-.8);");
    expect_near(at.look, along.look);
    expect_near(at.up, along.up);
    expect_near(at.right, along.right);
    expect_near(at.right, {0.8, 0, 0});
}

TEST(RayImporter, LooksStraightUpOrDownWithXUp) {
    for (const double y : {4.0, -4.0}) {
        const Imported i =
            import_ray("camera { position = (0," + std::to_string(y) + ",0); look_at = (0,0,0); }");
        ASSERT_EQ(i.errors(), 0u) << i.messages();
        const auto& c = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
        expect_near(c.look, {0, y > 0 ? -1.0 : 1.0, 0});
        expect_near(c.up, {1, 0, 0});
        expect_near(c.right, cross(c.look, c.up));
    }
}

TEST(RayImporter, TakesQuaternionsAsWritten) {
    // 1 - 2 (.35^2) = 0.755 and 2 (.35) (.9) = 0.63: not quite a rotation.
    const Imported i = import_ray("camera { quaternian = (.35,0,0,.9); }");
    const auto& c = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    expect_near(c.look, {0, 0.63, -0.755});
    expect_near(c.up, {0, 0.755, 0.63});
    expect_near(c.right, {1, 0, 0});
}

TEST(RayImporter, ReportsBadValuesOfACameraWhereTheyStand) {
    const Imported i = import_ray("camera {\n  fov = 190;\n  aspectratio = 0;\n}");
    EXPECT_TRUE(i.says("scene.ray:3:9: error: camera: fov must be between 0 and 180 degrees"))
        << i.messages();
    EXPECT_TRUE(i.says("scene.ray:4:17: error: camera: aspectratio must be greater than 0"))
        << i.messages();
}

TEST(RayImporter, APointToLookAtMayLieWhereTheEyeIsBeforeALaterBlockMovesIt) {
    const Imported moved =
        import_ray("camera { look_at = (0,0,0); fov = 30 } camera { position = (0,0,5) }");
    EXPECT_EQ(moved.errors(), 0u) << moved.messages();
    expect_near(std::get<PerspectiveCamera>(moved.scene.cameras.at(0).camera).look, {0, 0, -1});
    const Imported turned =
        import_ray("camera { look_at = (0,0,0) } camera { viewdir = (1,0,0); updir = (0,1,0) }");
    EXPECT_EQ(turned.errors(), 0u) << turned.messages();
    const Imported still = import_ray("camera { look_at = (0,0,0) } camera { fov = 30 }");
    EXPECT_EQ(still.errors(), 1u) << still.messages();
    EXPECT_TRUE(still.says("look_at must not lie at the position"));
}

TEST(RayImporter, APointToLookAtHasNoEffectBesideAViewDirection) {
    const Imported i = import_ray(
        "camera { position = (0,0,3); viewdir = (0,1,0); updir = (0,0,1); look_at = (5,0,0); }");
    EXPECT_TRUE(i.says("warning: camera: look_at has no effect beside viewdir and updir"));
    EXPECT_FALSE(i.says("unknown key")) << i.messages();
    expect_near(std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).look, {0, 1, 0});
}

TEST(RayImporter, ACameraKeepsLookingAtItsPointWhereverALaterBlockMovesIt) {
    const auto look = [](const std::string& blocks) {
        const Imported i = import_ray(blocks);
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    };
    const PerspectiveCamera moved =
        look("camera { look_at = (3,0,4); updir = (0,0,2); } camera { position = (3,-5,4); }");
    expect_near(moved.look, {0, 1, 0});
    expect_near(moved.up, {0, 0, 2});
    const PerspectiveCamera tilted =
        look("camera { look_at = (3,0,4); position = (3,0,9); } camera { updir = (1,0,0); }");
    expect_near(tilted.look, {0, 0, -1});
    expect_near(tilted.up, {1, 0, 0});
    // A direction in a later block replaces the point.
    const PerspectiveCamera turned = look(
        "camera { look_at = (3,0,4); position = (0,0,9); }"
        "camera { viewdir = (0,1,0); updir = (0,0,1); } camera { position = (5,5,5); }");
    expect_near(turned.look, {0, 1, 0});
}

TEST(RayImporter, CameraBlocksChangeOneCamera) {
    const Imported i = import_ray(
        "camera { position = (1,2,3); viewdir = (1,0,0); updir = (0,1,0); fov = 90 }"
        "camera { position = (4,5,6); aspectratio = 2 }");
    ASSERT_EQ(i.scene.cameras.size(), 1u);
    EXPECT_TRUE(i.says("warning: another camera block changes the camera of the first"))
        << i.messages();
    const auto& c = std::get<PerspectiveCamera>(i.scene.cameras[0].camera);
    expect_near(c.eye, {4, 5, 6});
    expect_near(c.look, {1, 0, 0});
    expect_near(c.up, {0, 2, 0});
    expect_near(c.right, {0, 0, 4});
    EXPECT_EQ(i.scene.cameras[0].aspect, 2);
}

TEST(RayImporter, WantsViewAndUpTogether) {
    EXPECT_TRUE(import_ray("camera { viewdir = (1,0,0) }").says("together"));
    EXPECT_TRUE(import_ray("camera { viewdir = (0,0,0); updir = (0,1,0) }").says("zero vector"));
}

TEST(RayImporter, DefaultsAttenuationByFamily) {
    const std::string light = "point_light { position = (1,2,3); colour = (1,.5,.25) ";
    const Imported b = import_ray(light + "}");
    const auto& of_b = std::get<PointLight>(b.scene.lights.at(0).light);
    EXPECT_EQ(of_b.attenuation.constant, 0);
    EXPECT_EQ(of_b.attenuation.quadratic, 1);
    expect_near(of_b.position, {1, 2, 3});
    EXPECT_EQ(of_b.color, (Rgb{1, .5, .25}));
    const Imported a = import_ray(light + "} material { name = \"m\"; }");
    const auto& of_a = std::get<PointLight>(a.scene.lights.at(0).light);
    EXPECT_EQ(of_a.attenuation.constant, 1);
    EXPECT_EQ(of_a.attenuation.quadratic, 0);
}

TEST(RayImporter, TurnsLightDirectionsAround) {
    const Imported i = import_ray("directional_light { direction = (0,0,-2); color = (1,1,1) }");
    expect_near(std::get<DirectionalLight>(i.scene.lights.at(0).light).to_light, {0, 0, 1});
}

TEST(RayImporter, RequiresWhatALightNeeds) {
    EXPECT_TRUE(import_ray("point_light { color = (1,1,1) }").says("'position = ...' is missing"));
    EXPECT_TRUE(import_ray("point_light { position = (1,1,1) }").says("'color = ...' is missing"));
    EXPECT_TRUE(import_ray("directional_light { color = (1,1,1) }").says("'direction = ...'"));
    EXPECT_TRUE(import_ray("directional_light { color = (1,1,1); direction = (0,0,0) }")
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
        const Imported i = import_ray(start + c.keys);
        ASSERT_EQ(i.errors(), 0u) << i.messages();
        const auto& light = std::get<SpotLight>(i.scene.lights.at(0).light);
        expect_near(light.direction, {0, -1, 0});
        EXPECT_NEAR(light.inner_angle * 180 / std::numbers::pi, c.inner, 1e-12);
        EXPECT_NEAR(light.outer_angle * 180 / std::numbers::pi, c.outer, 1e-12);
    }
    EXPECT_EQ(import_ray(start + "direction = (0,0,0); size = 3 }").errors(), 1u);
    EXPECT_EQ(import_ray(start + "direction = (0,1,0) }").errors(), 1u);
}

TEST(RayImporter, TakesAnAreaLightOfRadiusZeroForAPoint) {
    const std::string start = "area_light { position = (0,2,0); color = (1,1,1); ";
    EXPECT_EQ(import_ray(start + "light_radius = 0 }").errors(), 0u);
    EXPECT_EQ(import_ray(start + "light_radius = 0.5 }").errors(), 1u);
    EXPECT_TRUE(import_ray(start + "u = (1,0,0); v = (0,1,0) }").says("lights with an extent"));
}

TEST(RayImporter, ANegativeAttenuationIsOneError) {
    Imported i = import_ray(
        "point_light { color = (1,1,1); position = (0,0,1); constant_attenuation_coeff = -1; }");
    validate(i.scene, i.diagnostics);
    EXPECT_EQ(i.errors(), 1u) << i.messages();
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
