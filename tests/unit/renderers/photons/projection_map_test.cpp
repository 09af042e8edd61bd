#include "alhazen/renderers/photons/projection_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "support/light_pictures.h"
#include "support/scene_maker.h"
#include "unit/renderers/photons/photon_shots.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::matt;
using testing::power_of;
using testing::SceneMaker;
using testing::shot_of;
using testing::smooth_glass;
constexpr double kPi = std::numbers::pi;

/// A ball within a small angle of a light receives exactly the photons that the projection map
/// sends there, most of all photons.
TEST(ProjectionMap, SendsThePhotonsTowardsTheGlassAndLosesNoLight) {
    constexpr double kAngle = 0.3;
    const double sphere = 4 * kPi * kPi;
    const double received = sphere * (1 - std::cos(kAngle)) / 2;
    const auto lit_by = [&](bool two_lights) {
        SceneMaker maker;
        maker.add(ball({3, 0, 0}, 3 * std::sin(kAngle)), maker.material(smooth_glass(1.5)));
        maker.add(ball({0, 0, 0}, 10), maker.material(matt({0, 0, 0.0001})));
        maker.light(PointLight{.color = {1, 1, 1}, .attenuation = {0, 0, 1}});
        if (two_lights) {
            // Behind the ball, at the same distance.
            maker.light(
                PointLight{.position = {6, 0, 0}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
        }
        return maker.compile();
    };
    for (const bool two_lights : {false, true}) {
        const Scene scene = lit_by(two_lights);
        const Illumination lights(scene);
        const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
        RayCounters counters;
        const ProjectionMap projection(job, lights, 3, counters);
        const double share = (1 - std::cos(kAngle)) / 2;
        const double cells = double(projection.cells());
        EXPECT_GT(double(projection.marked()), 0.9 * share * cells);
        EXPECT_LT(double(projection.marked()), (two_lights ? 2.5 : 1.8) * share * cells);
        PhotonShot shot{20000, {PhotonKind::Caustic}, 64, 5};
        const std::size_t anywhere = shot_of(scene, shot).photons.size();
        shot.projection = &projection;
        const ShotPhotons aimed = shot_of(scene, shot);
        EXPECT_GT(aimed.photons.size(), (two_lights ? 10 : 15) * anywhere);
        const double expected = two_lights ? 2 * received : received;
        EXPECT_NEAR(power_of(aimed.photons).g, expected, 0.03 * expected) << two_lights;
    }
}

/// Glass receives the same power of area lights, spot lights and the sun with and without the map.
TEST(ProjectionMap, LosesNoLightOfAnyKindOfLamp) {
    Material glow, one_sided;
    glow.emission.color = one_sided.emission.color = {1, 1, 1};
    one_sided.double_sided = false;
    SpotLight spot;
    spot.position = {0, 0, 2};
    spot.direction = normalize(Vec3{0.2, 0, -1});
    spot.inner_angle = 0.3;
    spot.outer_angle = 0.9;
    spot.color = {1, 1, 1};
    spot.attenuation = {0, 0, 1};
    Disc disc;
    disc.center = {0.5, 0, 2};
    disc.radius = 0.3;
    disc.normal = {0, 0, -1};
    for (int kind = 0; kind < 5; ++kind) {
        SceneMaker maker;
        maker.add(ball({0, 0, 0}, 0.5), maker.material(smooth_glass(1.5)));
        Disc floor;
        floor.center = {0, 0, -3};
        floor.radius = 4;
        maker.add(floor, maker.material(matt({0, 0, 0.0001})));
        if (kind == 0) maker.light(spot);
        if (kind == 1) maker.add(ball({1, 0, 2}, 0.3), maker.material(glow));
        if (kind == 2) maker.add(disc, maker.material(glow));
        if (kind == 3) maker.add(disc, maker.material(one_sided));
        if (kind == 4) {
            maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            maker.light(spot);
        }
        const Scene scene = maker.compile();
        const Illumination lights(scene);
        const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
        RayCounters counters;
        const ProjectionMap projection(job, lights, 3, counters);
        PhotonShot shot{60000, {PhotonKind::Caustic}, 64, 5};
        const double anywhere = power_of(shot_of(scene, shot).photons).g;
        shot.projection = &projection;
        const double aimed = power_of(shot_of(scene, shot).photons).g;
        EXPECT_GT(anywhere, 0.0) << kind;
        EXPECT_NEAR(aimed, anywhere, 0.04 * anywhere) << kind;
    }
}

TEST(ProjectionMap, NoPhotonIsFarBrighterThanOthers) {
    SceneMaker maker;
    maker.add(ball({8, 0, 4}, 0.25), maker.material(testing::shining({256, 256, 256})));
    maker.add(ball({0, 0, 12}, 4), maker.material(testing::shining({1, 1, 1})));
    maker.add(ball({0, 0, 1}, 0.7), maker.material(smooth_glass(1.5)));
    maker.add(ball({0, 0, 0}, 30), maker.material(matt({0, 0, 0.0001})));
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RayCounters counters;
    const ProjectionMap projection({.scene = scene, .camera = scene.cameras[0].camera}, lights, 3,
                                   counters);
    PhotonShot shot{60000, {PhotonKind::Caustic}, 64, 5};
    shot.projection = &projection;
    const std::vector<Photon> photons = shot_of(scene, shot).photons;
    ASSERT_GT(photons.size(), 500u);
    const double mean = power_of(photons).g / double(photons.size());
    for (const Photon& p : photons) EXPECT_LT(p.light().b, 20 * mean);
}

TEST(ProjectionMap, AimsNowhereWhereNothingReflects) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 10), maker.material(matt({0.5, 0.5, 0.5})));
    maker.light(PointLight{.color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    RayCounters counters;
    const Illumination lights(scene);
    const ProjectionMap projection(job, lights, 3, counters);
    EXPECT_EQ(projection.marked(), 0u);
    const LightRay aimed = projection.emit(0.3, {0.1, 0.2}, {0.4, 0.5}, kColorChannels);
    const LightRay plain = lights.emit(0.3, {0.1, 0.2}, {0.4, 0.5}, kColorChannels);
    EXPECT_EQ(aimed.ray.direction.y, plain.ray.direction.y);
    EXPECT_EQ(aimed.direction_density, plain.direction_density);
}

/// Photons are aimed at a ball that moves past a light, wherever it is while the shutter is open.
TEST(ProjectionMap, AimsAtGlassOfAnyMoment) {
    SceneMaker maker;
    maker.add(ball({3, 0, 0}, 0.6), maker.material(smooth_glass(1.5)),
              Affine::translate({0, -2, 0}));
    maker.description().objects[0].parts.back().motion =
        std::make_shared<const PartMotion>(PartMotion{
            {}, {{0, Affine::translate({0, -2, 0})}, {1, Affine::translate({0, 2, 0})}}, {}});
    maker.add(ball({0, 0, 0}, 10), maker.material(matt({0, 0, 0.0001})));
    maker.light(PointLight{.color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    open_shutter(maker.description(), {0, 1});
    const Scene scene = maker.compile();
    const Illumination lights(scene);
    RayCounters counters;
    const ProjectionMap projection({.scene = scene, .camera = scene.cameras[0].camera}, lights, 3,
                                   counters);
    PhotonShot shot{60000, {PhotonKind::Caustic}, 64, 5};
    const std::vector<Photon> anywhere = shot_of(scene, shot).photons;
    shot.projection = &projection;
    const std::vector<Photon> aimed = shot_of(scene, shot).photons;
    EXPECT_GT(aimed.size(), 8 * anywhere.size());
    EXPECT_NEAR(power_of(aimed).g, power_of(anywhere).g, 0.06 * power_of(anywhere).g);
    // Not those of a place that was not aimed at.
    const double mean = power_of(aimed).g / double(aimed.size());
    for (const Photon& p : aimed) EXPECT_LT(p.light().max(), 6 * mean);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
