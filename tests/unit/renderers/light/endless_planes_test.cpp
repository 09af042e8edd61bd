// Light from the sky and the sun in scenes with unbounded surfaces.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "alhazen/scene/scene_sphere.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// A matt table with a ball, seen from above, under a uniform sky.
SceneMaker table_under_the_sky() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 1.2}, {0, 0, -1}, {0.9, 0, 0}, {0, 0.9, 0}};
    maker.description().picture.background = Rgb{0.5, 0.8, 1.2};
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), maker.material(matt({0.6, 0.5, 0.4})));
    maker.add(ball({0.3, 0.2, 0.3}, 0.3), maker.material(matt({0.7, 0.7, 0.2})));
    return maker;
}

TEST(EndlessPlanes, NoLightGetsBetweenTwo) {
    for (const double roof : {1.6, 20.0, 1e9, 1e15}) {
        SceneMaker maker = table_under_the_sky();
        const MaterialId white = maker.material(matt({0.8, 0.8, 0.8}));
        maker.add(Plane{{0, 0, roof}, {0, 0, 1}}, white);
        maker.add(Plane{{0, 0, -0.1}, {0, 0, 1}}, white);
        maker.light(DirectionalLight{.to_light = {0.6, 0, 0.8}, .color = {1, 1, 1}});
        const Scene scene = maker.compile();
        for (const char* renderer :
             {"path_tracing", "light_tracing", "bidirectional", "vcm:photons=400,radius=0.05",
              "sppm:photons=2000,radius=0.1", "photon_mapping:photons=2000,nearest=20"}) {
            EXPECT_EQ(mean_of(picture_of(scene, renderer, 8, 16)), Rgb{}) << renderer << roof;
        }
    }
}

TEST(EndlessPlanes, StrategiesAgreeBesideAndBelowThem) {
    Material black = matt({});
    Material mirror = matt({});
    mirror.reflective.color = {0.8, 0.7, 0.6};
    Material sheet;
    sheet.metallic_roughness.emplace();
    sheet.metallic_roughness->base_color.color = {0.9, 0.5, 0.3};
    sheet.metallic_roughness->metallic.value = 0;
    sheet.metallic_roughness->roughness.value = 0;
    sheet.metallic_roughness->transmission.value = 1;
    const Plane wall{{3, 0, 0}, {1, 0, 0}}, roof{{0, 0, 4}, normalize(Vec3{0.2, 0.1, 1})};
    struct Case {
        std::string name;
        Plane plane;
        Material material;
        bool all;  ///< light paths find what arrives
    };
    const std::vector<Case> cases{{"black wall", wall, black, true},
                                  {"matt wall", wall, matt({0.8, 0.4, 0.4}), false},
                                  {"mirror", wall, mirror, false},
                                  {"tinted sheet", roof, sheet, true},
                                  {"water above", roof, smooth_glass(1.3), false}};
    for (const Case& c : cases) {
        SceneMaker maker = table_under_the_sky();
        maker.add(c.plane, maker.material(c.material));
        const Scene scene = maker.compile();
        std::vector<std::string> renderers{"path_tracing:depth=5", "bidirectional:depth=5",
                                           "vcm:photons=100,radius=0.04,pilot=off,depth=5"};
        if (c.all) renderers.push_back("light_tracing:depth=5");
        expect_same_light(scene, c.name, renderers, 24);
    }
}

/// Light paths of the sun begin above an unbounded surface.
TEST(EndlessPlanes, TheSunLightsOneAboveAllThatIsBounded) {
    SceneMaker maker = table_under_the_sky();
    maker.description().picture.background.reset();
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 9}, {0, 0, -1}, {0.5, 0, 0}, {0, 0.5, 0}};
    maker.add(Plane{{0, 0, 7}, {0, 0, 1}}, maker.material(matt({0.5, 0.5, 0.5})));
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing", "light_tracing", "bidirectional"}) {
        EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 4096)).g, 0.5, 0.02) << renderer;
    }
}

/// Distant light begins in the unbounded medium; so do an eye and a light inside of water that
/// extends above all bounded objects.
TEST(EndlessPlanes, WaterWithoutEndTakesLightFromAfar) {
    Material water;
    water.index.value = 1.0 + 1e-9;
    water.dielectric = Dielectric{{0.3, 0.1, 0.05}};
    Material fog = water;
    fog.index.value = 1.0;
    fog.scattering = {{0.2, 0.3, 0.2}, 0.3};
    struct Case {
        std::string name;
        Plane plane;
        Material material;
    };
    const std::vector<Case> cases{
        {"water below", {{0, 0, -0.2}, {0, 0, 1}}, water},
        {"water above all", {{0, 0, 9}, normalize(Vec3{0.1, 0, 1})}, water},
        {"fog below", {{0, 0, -0.2}, {0, 0, 1}}, fog},
        {"fog above all", {{0, 0, 9}, normalize(Vec3{0.1, 0, 1})}, fog}};
    for (const Case& c : cases) {
        SceneMaker maker;
        maker.description().cameras[0].camera =
            OrthographicCamera{{0, 0, 1.2}, {0, 0, -1}, {0.9, 0, 0}, {0, 0.9, 0}};
        maker.description().picture.background = Rgb{0.5, 0.8, 1.2};
        // Seen from above, and lit from below by way of a tilted card.
        maker.add(ball({0.3, 0.2, 0.3}, 0.3), maker.material(matt({0.7, 0.7, 0.2})));
        maker.add(rectangle({-0.6, -0.5, 0}, {0.5, 0, 0.5}, {0, 1, 0}),
                  maker.material(matt({0.8, 0.8, 0.8})));
        maker.add(rectangle({-0.1, -0.3, 0.4}, {0, 0.2, 0}, {0.2, 0, 0}),
                  maker.material(shining({2, 2, 2})));
        maker.add(c.plane, maker.material(c.material));
        const Scene scene = maker.compile();
        std::vector<std::string> renderers{"path_tracing:depth=5", "bidirectional:depth=5",
                                           "vcm:photons=100,radius=0.04,pilot=off,depth=5"};
        // Fog outside the disc of the light paths stays dark to light tracing.
        if (!scene.has_scattering) renderers.push_back("light_tracing:depth=5");
        expect_same_light(scene, c.name, renderers, 24);
    }
}

/// A black plane, a ball at rest and one that moves by 6 while the shutter is open.
SceneMaker moving_ball_above_a_plane(bool with_plane) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{3, -15, 0}, {0, 1, 0}, {4, 0, 0}, {0, 0, 4}};
    maker.description().picture.background = Rgb{0.5, 0.5, 0.5};
    if (with_plane) maker.add(Plane{{0, 0, -1.5}, {0, 0, 1}}, maker.material(matt({})));
    maker.add(ball({0, 2, 0}, 0.2), maker.material(matt({0.5, 0.5, 0.5})));
    maker.add(ball({0, 0, 0}, 0.7), maker.material(matt({0.9, 0.9, 0.9})));
    SceneDescription& d = maker.description();
    d.objects[0].parts.back().motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({6, 0, 0})}}, {}});
    d.shutter = {0, 1};
    return maker;
}

TEST(EndlessPlanes, TheSphereOfAllThatIsBoundedHoldsWhatMovesAndWhatRests) {
    const Scene scene = moving_ball_above_a_plane(true).compile();
    const BoundingSphere sphere = sphere_around_bounded(scene);
    for (const Vec3& p : {Vec3{-0.7, 0, 0}, {6.7, 0, 0}, {0, 2.2, 0}, {6, 0, 0.7}}) {
        EXPECT_LE(length(p - sphere.center), sphere.radius);
    }
    EXPECT_LT(sphere.radius, 5);
    const BoundingSphere alone = sphere_around_bounded(moving_ball_above_a_plane(false).compile());
    EXPECT_NEAR(sphere.radius, alone.radius, 1e-6);
}

TEST(EndlessPlanes, LightPathsReachWhatMovesAboveThem) {
    expect_same_light(moving_ball_above_a_plane(true).compile(), "moving ball",
                      {"path_tracing:depth=5", "bidirectional:depth=5", "light_tracing:depth=5"},
                      24);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
