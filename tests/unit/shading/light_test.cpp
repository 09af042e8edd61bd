#include "alhazen/shading/lights/light.h"

#include <gtest/gtest.h>

#include <utility>

#include "alhazen/math/constants.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Light, PointLightAttenuatesByItsQuadratic) {
    PointLight light;
    light.position = {0, 0, 2};
    light.attenuation = {1, 2, 3};
    const LightSample s = sample(light, {0, 0, 0}, true);
    EXPECT_EQ(s.distance, 2.0);
    EXPECT_EQ(s.to_light, (Vec3{0, 0, 1}));
    EXPECT_DOUBLE_EQ(s.intensity.r, 1.0 / (1 + 4 + 12));
}

TEST(Light, AttenuationIsClampedToOneOnlyWhenTheConventionSaysSo) {
    PointLight light;
    light.position = {0, 0, 0.5};
    light.attenuation = {0, 0, 1};
    EXPECT_EQ(sample(light, {0, 0, 0}, true).intensity.r, 1.0);
    EXPECT_EQ(sample(light, {0, 0, 0}, false).intensity.r, 4.0);
    light.attenuation = {0, 0, 0};
    EXPECT_EQ(sample(light, {0, 0, 0}, true).intensity.r, 1.0);
}

TEST(Light, SpotIsFullInsideNothingOutsideAndHalfwayBetween) {
    SpotLight light;
    light.position = {0, 0, 1};
    light.direction = {0, 0, -1};
    light.inner_angle = 0.2;
    light.outer_angle = 0.4;
    const auto at_angle = [&](double a) {
        return sample(light, {std::tan(a), 0, 0}, true).intensity.r;
    };
    EXPECT_EQ(at_angle(0.1), 1.0);
    EXPECT_NEAR(at_angle(0.3), 0.5, 1e-12);
    EXPECT_EQ(at_angle(0.5), 0.0);
}

TEST(Light, AmbientLightOnlyHasAnAmbientTerm) {
    const Light light = AmbientLight{{0.1, 0.2, 0.3}};
    EXPECT_FALSE(illuminates(light));
    EXPECT_EQ(ambient_of(light), (Rgb{0.1, 0.2, 0.3}));
    EXPECT_TRUE(illuminates(Light{DirectionalLight{}}));
}

TEST(Light, CosinesOfASpotDecideAsItsAnglesDo) {
    for (const auto& [inner, outer] :
         {std::pair{0.2, 0.5}, {0.0, 0.0}, {0.3, 0.3}, {0.0, kPi}, {kPi, kPi}}) {
        SpotLight light;
        light.direction = {0, 0, -1};
        light.inner_angle = inner;
        light.outer_angle = outer;
        const Light prepared = ready_to_sample(light);
        const auto expect_same = [&](double angle) {
            const Vec3 point{std::sin(angle), 0, -std::cos(angle)};
            EXPECT_EQ(sample(prepared, point, true).intensity,
                      sample(Light{light}, point, true).intensity)
                << angle;
        };
        for (int i = 0; i <= 1000; ++i) expect_same(kPi * i / 1000);
        for (const double edge : {inner, outer}) {
            for (double apart = 1e-17; apart < 1e-3; apart *= 3) {
                expect_same(edge - apart);
                expect_same(edge + apart);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
