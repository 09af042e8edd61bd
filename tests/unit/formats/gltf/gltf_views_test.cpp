/// Cameras and lights of glTF files.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/formats/gltf/gltf_nodes_text.h"

namespace alhazen::testing::ALHAZEN_TEST_FILE {
namespace {

TEST(GltfViews, CamerasLookAlongMinusZOfTheirNodes) {
    const Imported result = import_gltf(with_nodes(R"({"mesh": 0},
        {"name": "eye", "camera": 0, "translation": [1, 2, 3], "scale": [5, 5, 5],
         "rotation": [0, 0.70710678118654757, 0, 0.70710678118654757]}, {"camera": 1})",
                                                   "0, 1, 2", R"(, "cameras": [
          {"type": "perspective", "perspective": {"yfov": 1.5707963267948966, "aspectRatio": 2,
            "znear": 0.1}},
          {"name": "flat", "type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0,
            "zfar": 10}}])"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    ASSERT_EQ(result.scene.cameras.size(), 2u);
    EXPECT_EQ(result.scene.cameras[0].name, "eye");
    EXPECT_EQ(result.scene.cameras[0].aspect, 2);
    const auto& eye = std::get<PerspectiveCamera>(result.scene.cameras[0].camera);
    EXPECT_NEAR_VEC((Vec3{1, 2, 3}), eye.eye, 1e-12);
    EXPECT_NEAR_VEC((Vec3{-1, 0, 0}), normalize(eye.look), 1e-12);
    EXPECT_NEAR_VEC((Vec3{0, 0, -1}), normalize(eye.right), 1e-12);
    EXPECT_NEAR(length(eye.up) / length(eye.look), 2, 1e-12);
    EXPECT_NEAR(length(eye.right) / length(eye.look), 4, 1e-12);
    EXPECT_EQ(result.scene.cameras[1].name, "flat");
    const auto& flat = std::get<OrthographicCamera>(result.scene.cameras[1].camera);
    EXPECT_NEAR_VEC((Vec3{6, 0, 0}), flat.right, 1e-12);
    EXPECT_NEAR_VEC((Vec3{0, 4, 0}), flat.up, 1e-12);
}

TEST(GltfViews, LightsKeepTheirUnitsUpToPi) {
    const Imported result =
        import_gltf(with_nodes(R"({"mesh": 0},
        {"translation": [0, 5, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        {"rotation": [-0.70710678118654757, 0, 0, 0.70710678118654757],
         "extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 2}}})",
                               "0, 1, 2, 3", R"(, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [
          {"type": "point", "color": [1, 0.5, 0], "intensity": 40, "range": 10},
          {"type": "directional", "name": "sun", "intensity": 3},
          {"type": "spot", "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]}})"));
    EXPECT_EQ(result.errors(), 0u) << result.messages();
    EXPECT_FALSE(result.scene.conventions.shading.clamp_attenuation);
    ASSERT_EQ(result.scene.lights.size(), 3u);
    // At half of its range: 40 cd / pi / 25 m^2 * (1 - 1/16).
    const LightSample point = sample(result.scene.lights[0].light, {0, 0, 0}, false);
    EXPECT_NEAR(point.intensity.r, 40 / std::numbers::pi / 25 * 15 / 16, 1e-12);
    EXPECT_NEAR(point.intensity.g, 20 / std::numbers::pi / 25 * 15 / 16, 1e-12);
    EXPECT_EQ(sample(result.scene.lights[0].light, {0, -5, 0}, false).intensity, Rgb{});
    EXPECT_EQ(sample(result.scene.lights[0].light, {0, -9, 0}, false).intensity, Rgb{});
    // -z rotated by -90 degrees about x points down.
    const auto& sun = std::get<DirectionalLight>(result.scene.lights[1].light);
    EXPECT_EQ(result.scene.lights[1].name, "sun");
    EXPECT_NEAR_VEC((Vec3{0, 1, 0}), sun.to_light, 1e-12);
    EXPECT_NEAR(sun.color.b, 3 / std::numbers::pi, 1e-12);
    const auto& spot = std::get<SpotLight>(result.scene.lights[2].light);
    EXPECT_EQ(result.scene.lights[2].name, "lamp");
    EXPECT_EQ(spot.inner_angle, 0.1);
    EXPECT_EQ(spot.outer_angle, 0.2);
    EXPECT_EQ(spot.range, kNoRange);
}

}  // namespace
}  // namespace alhazen::testing::ALHAZEN_TEST_FILE
