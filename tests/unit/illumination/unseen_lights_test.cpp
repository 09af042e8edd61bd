/// Lights that no ray meets: hidden area lights, punctual ones.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/illumination.h"
#include "alhazen/sampling/random.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"
#include "unit/illumination/lamps.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

AreaLight unseen_sphere() {
    AreaLight lamp;
    lamp.extent = SphereExtent{{0, 0, 3}, 1};
    lamp.seen = false;
    lamp.radiance = {2, 2, 2};
    return lamp;
}

TEST(Emitters, HiddenAreaLightsGiveTheIrradianceOfTheirDirection) {
    SceneMaker maker;
    maker.light(unseen_sphere());
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RandomStream random(1);
    double sum = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const double u = random.uniform(), v = random.uniform();
        const LightDraw draw = lights.draw(kBelowLamps, 0.5, {u, v}, kColorChannels);
        ASSERT_TRUE(draw.singular);
        sum += draw.radiance.a / draw.density;
    }
    const double sine2 = 1.0 / (0.1 * 0.1 + 0.2 * 0.2 + 9.0);
    EXPECT_NEAR(sum / 1000 / (2.0 * 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2))), 1.0, 1e-9);
}

/// No ray meets the light: that of the inner side passes through the rest of the surface.
TEST(Emitters, HiddenSpheresOfTwoSidesShineFromBoth) {
    SceneMaker maker;
    AreaLight lamp = unseen_sphere();
    lamp.two_sided = true;
    maker.light(lamp);
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RandomStream random(1);
    double sum = 0.0, inner = 0.0;
    for (int i = 0; i < 1000; ++i) {
        const Vec2 u{(i + random.uniform()) / 1000, random.uniform()};
        const LightDraw draw = lights.draw(kBelowLamps, 0.5, u, kColorChannels);
        sum += draw.radiance.a / draw.density;
        const Vec3 place = kBelowLamps.point + draw.distance * draw.to_light;
        const Vec3 normal = place - Vec3{0, 0, 3};
        EXPECT_NEAR(length(normal), 1.0, 1e-9);
        inner += dot(normal, draw.to_light) > 0.0 ? 1 : 0;
        // What another strategy finds for the same place.
        const Illumination::LightPoint point = lights.point_of_light(draw.place, place);
        const double density = lights.density(kBelowLamps, point, draw.to_light, draw.distance);
        const double sine2 = 1.0 / length_squared(kBelowLamps.point - Vec3{0, 0, 3});
        const double cone = 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2));
        EXPECT_NEAR(density * cone, 0.5, 1e-9);
    }
    EXPECT_EQ(inner, 500);
    const double sine2 = 1.0 / (0.1 * 0.1 + 0.2 * 0.2 + 9.0);
    EXPECT_NEAR(sum / 1000 / (2.0 * 2.0 * 2.0 * kPi * (1.0 - std::sqrt(1.0 - sine2))), 1.0, 1e-9);
}

TEST(Emitters, PunctualLightsAreTimesPi) {
    SceneMaker maker;
    maker.light(PointLight{.position = {0, 0, 2}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    const LightDraw draw = lights.draw({{0, 0, 0}, {0, 0, 1}}, 0.3, {0.5, 0.5}, kColorChannels);
    EXPECT_TRUE(draw.singular);
    EXPECT_DOUBLE_EQ(draw.radiance.a / draw.density, kPi / 4);
    EXPECT_EQ(draw.distance, 2.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
