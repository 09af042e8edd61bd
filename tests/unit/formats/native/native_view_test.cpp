/// Cameras, lights and settings of the native format.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::expect_near;
using testing::import_native;
using testing::Imported;

TEST(NativeImporter, ReadsCameras) {
    const Imported i = import_native(
        "picture { width = 200; height = 100 }"
        "perspective_camera \"p\" { eye = (0,0,5); look_at = (0,0,0); fov_deg = 90 }"
        "perspective_camera { eye = (0,0,5); direction = (0,0,-7); fov_deg = 90; aspect = 1 }"
        "sheared_camera { eye = (1,0,0); look = (0,0,-2); right = (3,0,1); up = (0,4,0); aspect = "
        "1 }"
        "orthographic_camera { eye = (0,0,5); direction = (0,0,-1); height = 6 }");
    ASSERT_EQ(i.messages(), "");
    const auto& p = std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera);
    expect_near(p.look, {0, 0, -1});
    expect_near(p.right, {4, 0, 0});
    expect_near(p.up, {0, 2, 0});
    EXPECT_EQ(i.scene.cameras[0].aspect, 2);
    EXPECT_EQ(i.scene.cameras[0].name, "p");
    expect_near(std::get<PerspectiveCamera>(i.scene.cameras.at(1).camera).right, {2, 0, 0});
    expect_near(std::get<PerspectiveCamera>(i.scene.cameras.at(2).camera).right, {3, 0, 1});
    const auto& o = std::get<OrthographicCamera>(i.scene.cameras.at(3).camera);
    expect_near(o.right, {12, 0, 0});
    expect_near(o.up, {0, 6, 0});
}

TEST(NativeImporter, ReadsLights) {
    const Imported i = import_native(
        "ambient_light { color = (.1,.2,.3) }"
        "directional_light \"sun\" { direction = (0,0,-2); color = (1,.5,0); ambient = (.1,.1,.1) }"
        "directional_light { to_light = (0,0,2) }"
        "point_light { position = (1,2,3); attenuation = (1,2,3) }"
        "spot_light { position = (0,0,5); look_at = (0,0,0); inner_angle_deg = 10; outer_angle_deg "
        "= 20 }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(std::get<AmbientLight>(i.scene.lights.at(0).light).ambient, (Rgb{.1, .2, .3}));
    const auto& sun = std::get<DirectionalLight>(i.scene.lights.at(1).light);
    expect_near(sun.to_light, {0, 0, 2});  // `compile` makes it unit
    EXPECT_EQ(sun.ambient, (Rgb{.1, .1, .1}));
    expect_near(std::get<DirectionalLight>(i.scene.lights.at(2).light).to_light, {0, 0, 2});
    EXPECT_EQ(std::get<PointLight>(i.scene.lights.at(3).light).attenuation.quadratic, 3);
    const auto& spot = std::get<SpotLight>(i.scene.lights.at(4).light);
    expect_near(spot.direction, {0, 0, -5});
    EXPECT_NEAR(spot.outer_angle, std::numbers::pi / 9, 1e-15);
}

TEST(NativeImporter, ReadsRangesGreyColorsAndAnglesInRadians) {
    const Imported i = import_native(
        "picture { background = 0.25; up_axis = z }"
        "point_light { position = (1,2,3); color = 0.5; range = 7 }"
        "spot_light { position = (0,0,5); direction = (0,0,-1); inner_angle_rad = 0.1;"
        " outer_angle_deg = 20; range = 3 }");
    ASSERT_EQ(i.messages(), "");
    EXPECT_EQ(i.scene.picture.background, (Rgb{.25, .25, .25}));
    EXPECT_EQ(i.scene.up_axis, UpAxis::Z);
    const auto& point = std::get<PointLight>(i.scene.lights.at(0).light);
    EXPECT_EQ(point.color, (Rgb{.5, .5, .5}));
    EXPECT_EQ(point.range, 7);
    const auto& spot = std::get<SpotLight>(i.scene.lights.at(1).light);
    EXPECT_EQ(spot.inner_angle, 0.1);
    EXPECT_EQ(spot.range, 3);
    EXPECT_TRUE(
        import_native("point_light { position = (0,0,0); range = 0 }").says("greater than 0"));
    EXPECT_TRUE(
        import_native("spot_light { position = (0,0,0); direction = (0,0,1); inner_angle_rad = 1;"
                      " inner_angle_deg = 1 }")
            .says("exclude each other"));
}

TEST(NativeImporter, WarnsOfNegativeColorsOfLights) {
    for (const char* text : {"point_light { position = (0,0,0); color = (1, -0.5, 0) }",
                             "ambient_light { color = -1 }",
                             "directional_light { direction = (0,0,1); ambient = (0, 0, -1) }",
                             "sphere_light { center = (0,0,0); radius = 1; radiance = -1 }"}) {
        const Imported i = import_native(text);
        EXPECT_EQ(i.errors(), 0u) << i.messages();
        EXPECT_TRUE(i.says("is negative: this light is subtracted")) << i.messages();
    }
    EXPECT_EQ(import_native("point_light { position = (0,0,0); color = (1, 0, 5) }").messages(),
              "");
}

TEST(NativeImporter, ThePlaneOfFocusIsInFrontOfTheCamera) {
    const auto read = [](const std::string& keys) {
        return import_native(
            "perspective_camera { eye = (0,0,1); direction = (0,0,-1); lens_radius = 0.1; " + keys +
            " }\nsphere { }");
    };
    const auto focus = [&](const std::string& point) {
        const Imported i = read("focus_at = " + point);
        EXPECT_EQ(i.messages(), "");
        return std::get<PerspectiveCamera>(i.scene.cameras.at(0).camera).lens.focus_distance;
    };
    EXPECT_NEAR(focus("(5,0,-2)"), 3.0, 1e-12);
    for (const char* point : {"(0,0,5)", "(3,0,1)"}) {
        const Imported i = read("focus_at = " + std::string(point));
        EXPECT_EQ(i.errors(), 1u);
        EXPECT_TRUE(i.says("in front of the camera")) << i.messages();
    }
    // The right vector of a mirrored camera points to the left.
    const Imported mirrored = import_native(
        "sheared_camera { eye = (0,0,0); look = (0,0,-2); right = (-1,0,0); up = (0,1,0); aspect = "
        "1;"
        " lens_radius = 0.1; focus_at = (0,0,-4) }\nsphere { }");
    EXPECT_EQ(mirrored.messages(), "");
    EXPECT_EQ(std::get<PerspectiveCamera>(mirrored.scene.cameras.at(0).camera).lens.focus_distance,
              4.0);
    EXPECT_TRUE(read("focus_distance = 3; blade_turn_deg = 5; blade_turn_rad = 1")
                    .says("exclude each other"));
}

TEST(NativeImporter, ReadsFisheyesAndPanoramas) {
    const Imported i = import_native(
        "picture { width = 300; height = 200 }"
        "fisheye_camera { eye = (1,2,3); look_at = (1,2,0); fov_deg = 220; projection = equisolid }"
        "panorama_camera { eye = (1,2,3); direction = (0,1,0); up = (0,0,1) }"
        "panorama_camera { eye = (1,2,3); direction = (0,1,0); up = (0,0,1); width_deg = 90;"
        " height_deg = 30 }");
    ASSERT_EQ(i.messages(), "");
    constexpr double kDegree = 3.14159265358979323846 / 180;
    const auto& fisheye = std::get<WideCamera>(i.scene.cameras.at(0).camera);
    EXPECT_EQ(fisheye.projection, WideProjection::Equisolid);
    EXPECT_NEAR(fisheye.height, 220 * kDegree, 1e-12);
    EXPECT_NEAR(fisheye.width, 330 * kDegree, 1e-12);
    EXPECT_EQ(fisheye.eye, (Vec3{1, 2, 3}));
    const auto& around = std::get<WideCamera>(i.scene.cameras.at(1).camera);
    EXPECT_EQ(around.projection, WideProjection::Panorama);
    EXPECT_NEAR(around.width, 360 * kDegree, 1e-12);
    EXPECT_EQ(i.scene.cameras.at(1).aspect, 2.0);
    EXPECT_EQ(i.scene.cameras.at(2).aspect, 3.0);
    EXPECT_TRUE(import_native("fisheye_camera { eye = (0,0,0); direction = (0,1,0); up = (0,0,1);"
                              " fov_deg = 361 }")
                    .says("at most 360"));
    EXPECT_TRUE(import_native("panorama_camera { eye = (0,0,0); direction = (0,1,0); up = (0,0,1);"
                              " height_deg = 181 }")
                    .says("at most 180"));
}

TEST(NativeImporter, ReadsEveryConvention) {
    const Imported i = import_native(
        "conventions { highlight = phong; shadow_tint = opaque; refraction_tint = per_distance;"
        " ambient_factor = diffuse; ambient_inside_times_kt = true; ambient_from_eye = true;"
        " clamp_attenuation = true; fresnel = true; beer = true;"
        " truncate_material_colors = true; transmitting_surfaces_reflect = true; air_index = 1.1;"
        " pixel_sample = lower_left_corner; linear_output = true; round_output = true; max_depth = "
        "9;"
        " min_contribution = 0.01; min_distance = 0.25 }");
    ASSERT_EQ(i.messages(), "");
    const Conventions& c = i.scene.conventions;
    EXPECT_EQ(c.shading.highlight, ShadingConventions::Highlight::Phong);
    EXPECT_EQ(c.shading.shadow_tint, ShadingConventions::ShadowTint::Opaque);
    EXPECT_EQ(c.shading.refraction_tint, ShadingConventions::RefractionTint::PerDistance);
    EXPECT_EQ(c.shading.ambient_factor, ShadingConventions::AmbientFactor::Diffuse);
    EXPECT_TRUE(c.shading.ambient_inside_times_kt && c.shading.ambient_from_eye &&
                c.shading.optics.fresnel && c.shading.optics.beer && c.shading.clamp_attenuation &&
                c.importing.truncate_material_colors && c.shading.transmitting_surfaces_reflect &&
                c.film.linear_output);
    EXPECT_EQ(c.film.encoding(), Encoding::LinearRounded);
    EXPECT_EQ(c.shading.air_index, 1.1);
    EXPECT_EQ(c.sampling.pixel_sample, SamplingConventions::PixelSample::LowerLeftCorner);
    EXPECT_EQ(c.shading.max_depth, 9);
    EXPECT_EQ(c.shading.min_contribution, 0.01);
    EXPECT_EQ(c.shading.min_distance, 0.25);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
