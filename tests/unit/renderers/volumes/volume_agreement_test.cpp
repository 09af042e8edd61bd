// Scenes with volumes that scatter: the renderers of light transport agree in pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/light_agreement.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// Block by block, in all ways to divide the renderers in two. What differs by `finds` of the
/// block, or of the picture where that is brighter, is found.
void expect_agreement(const Scene& scene, const std::string& name,
                      const std::vector<std::string>& renderers, int runs, int samples,
                      double finds) {
    std::vector<Shown> shown;
    for (const std::string& renderer : renderers) {
        // Merging is biased by its radius alone.
        const double bias = renderer.starts_with("vcm") ? 0.005 : 0.0;
        // A light path finds less than an eye path, and costs less.
        const int times = renderer.starts_with("light_tracing") ? 5 : 1;
        shown.push_back({renderer, blocks_of(scene, renderer, times * samples, runs), bias});
    }
    EXPECT_GT(shown[0].blocks.whole(), 0.01) << name;
    expect_same_light(shown, name, kByChance, finds);
}

const std::vector<std::string> kAll{"path_tracing", "light_tracing", "bidirectional",
                                    "vcm:photons=400,radius=0.03,pilot=off"};
/// Where light tracing sees nothing.
const std::vector<std::string> kBehindGlass{"path_tracing", "bidirectional",
                                            "vcm:photons=400,radius=0.03,pilot=off"};

std::vector<std::string> spectral(std::vector<std::string> renderers) {
    for (std::string& r : renderers) r += " --spectral";
    return renderers;
}

/// A floor seen aslant from above.
SceneMaker over_a_floor() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -3.5, 2}, {0, 3.5, -1.4}, {0, 0, 1}, 0.6, 1.0);
    maker.add(rectangle({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), maker.material(matt({0.6, 0.5, 0.4})));
    return maker;
}
void add_point(SceneMaker& maker, const Vec3& at, const Rgb& color) {
    maker.light(PointLight{.position = at, .color = color, .attenuation = {0, 0, 1}});
}

TEST(VolumeAgreement, APointOfLightOutsideOfFog) {
    for (const double g : {0.0, 0.8, -0.5}) {
        SceneMaker maker = over_a_floor();
        maker.add(ball({0, 0, 0.7}, 0.6), maker.material(fog({0.2, 0.1, 0}, {0.8, 1.2, 1.6}, g)));
        add_point(maker, {0.8, -0.5, 1.8}, {1, 1, 1});
        expect_agreement(maker.compile(), "point of light, " + std::to_string(g), kAll, 24, 8, 0.4);
    }
}

/// Photons that come through a boundary which is passed straight are direct light, as all that
/// shadow rays find: it is not found twice. Balls of estimates reach beyond the fog, which is thin.
TEST(VolumeAgreement, PhotonsOfAPointOutsideOfFog) {
    SceneMaker maker = over_a_floor();
    maker.add(BoxShape{{-1, -1, 0.02}, {1, 1, 1.2}},
              maker.material(fog({0.1, 0.1, 0}, {0.15, 0.2, 0.25}, 0.3)));
    add_point(maker, {0.8, -0.5, 1.8}, {1, 1, 1});
    const Scene scene = maker.compile();
    for (const std::string depth : {"depth=1", "depth=2"}) {
        // Light that is scattered once needs no photons.
        const double bias = depth == "depth=1" ? 0.0 : 0.04;
        const std::string eye = "path_tracing:" + depth;
        const Shown truth{eye, blocks_of(scene, eye, 32, 16)};
        const std::string mapping = "photon_mapping:photons=20000,caustics=5000,nearest=20,";
        for (const std::string& name : {mapping + (bias > 0.0 ? "" : "projection=off,"),
                                        std::string("sppm:photons=2500,radius=0.1,")}) {
            const Shown found{name + depth, blocks_of(scene, name + depth, 16, 12), bias};
            expect_same_light({found, truth}, depth, 1e-4, 0.27 + bias);
        }
    }
}

TEST(VolumeAgreement, TheSunAndTheSkyOverACloud) {
    SceneMaker maker = over_a_floor();
    maker.description().picture.background = Rgb{0.3, 0.4, 0.6};
    maker.light(
        DirectionalLight{.to_light = normalize(Vec3{0.3, -0.4, 0.8}), .color = {1, 1, 0.8}});
    maker.add(ball({0, 0, 0.7}, 0.6), maker.material(fog({}, {2, 2, 2}, 0.6)));
    expect_agreement(maker.compile(), "cloud", kAll, 32, 8, 0.3);
}

TEST(VolumeAgreement, MilkInARoomWithALamp) {
    SceneMaker maker = over_a_floor();
    maker.add(rectangle({-0.6, -0.6, 2.2}, {0, 1.2, 0}, {1.2, 0, 0}),
              maker.material(shining({5, 5, 5})));
    maker.add(ball({0, 0, 0.55}, 0.5),
              maker.material(fog({0.02, 0.05, 0.3}, {3, 4, 5}, 0.7, 1.35)));
    const Scene scene = maker.compile();
    expect_agreement(scene, "milk", kBehindGlass, 28, 16, 0.48);
    expect_agreement(scene, "milk, spectral", spectral(kBehindGlass), 28, 16, 0.48);
}

TEST(VolumeAgreement, ALampInsideOfAVolume) {
    for (const double index : {1.0, 1.2}) {
        SceneMaker maker = over_a_floor();
        maker.add(ball({0, 0, 0.9}, 0.15), maker.material(shining({12, 10, 8})));
        maker.add(ball({0, 0, 0.9}, 0.7),
                  maker.material(fog({0.3, 0.1, 0.1}, {0.5, 0.9, 1.3}, 0.4, index)));
        expect_agreement(maker.compile(), "lamp inside, index " + std::to_string(index),
                         index == 1.0 ? kAll : kBehindGlass, 22, 16, 0.5);
    }
}

/// Fog around what absorbs, around denser fog: of one index, which is that of the air or not.
TEST(VolumeAgreement, NestedVolumes) {
    for (const double index : {1.0, 1.3}) {
        SceneMaker maker = over_a_floor();
        maker.add(BoxShape{{-1, -1, 0.05}, {1, 1, 1.4}},
                  maker.material(fog({0.05, 0, 0.1}, {0.3, 0.4, 0.5}, 0.3, index)));
        Material absorbing;
        absorbing.index.value = index;
        absorbing.dielectric = Dielectric{{0.2, 0.9, 0.5}};
        maker.add(ball({0, 0, 0.7}, 0.6), maker.material(absorbing));
        maker.add(ball({0.1, 0, 0.7}, 0.35), maker.material(fog({}, {2, 1.5, 1}, -0.5, index)));
        maker.add(ball({0.7, -0.5, 1.15}, 0.12), maker.material(shining({20, 20, 20})));
        const Scene scene = maker.compile();
        const std::string name = "nested, index " + std::to_string(index);
        const auto& renderers = index == 1.0 ? kAll : kBehindGlass;
        expect_agreement(scene, name, renderers, 24, 8, 0.3);
        if (index == 1.0) expect_agreement(scene, name + ", spectral", spectral(kAll), 24, 8, 0.3);
    }
}

/// All is in the fog: the eye, the lamp, a glossy ball, half a wall.
SceneMaker room_of_fog() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -0.9, 1}, {0, 1, -0.2}, {0, 0, 1}, 0.9, 1.0);
    const auto wall = [&](const Vec3& corner, const Vec3& u, const Vec3& v, const Rgb& color) {
        maker.add(rectangle(corner, u, v), maker.material(matt(color)));
    };
    wall({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0.7, 0.7, 0.7});
    wall({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}, {0.6, 0.7, 0.8});
    wall({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}, {0.8, 0.2, 0.2});
    Material glossy, half = matt({0.9, 0.9, 0.9});
    glossy.metallic_roughness.emplace();
    glossy.metallic_roughness->base_color.color = {0.8, 0.7, 0.6};
    glossy.metallic_roughness->metallic.value = 0.5;
    glossy.metallic_roughness->roughness.value = 0.4;
    half.alpha_mode = AlphaMode::Blend;
    half.alpha.value = 0.5;
    maker.add(ball({0.4, 0.4, 0.4}, 0.3), maker.material(glossy));
    maker.add(rectangle({-0.7, 0.5, 0.1}, {0.7, 0.1, 0}, {0, 0, 1.0}), maker.material(half));
    maker.add(rectangle({-0.3, -0.1, 1.8}, {0.6, 0, 0}, {0, 0.6, 0}),
              maker.material(shining({6, 6, 5})));
    maker.add(BoxShape{{-3, -3, -3}, {3, 3, 3}},
              maker.material(fog({0.1, 0.05, 0}, {0.4, 0.5, 0.6}, 0.3)));
    return maker;
}

TEST(VolumeAgreement, ARoomOfFog) {
    SceneMaker maker = room_of_fog();
    expect_agreement(maker.compile(), "room of fog", kAll, 20, 8, 0.5);
    // A sheet that reflects, which light paths do not show.
    Material sheet = smooth_glass();
    sheet.metallic_roughness->thickness.value = 0;
    sheet.metallic_roughness->base_color.color = {0.9, 0.6, 0.5};
    maker.add(rectangle({-0.8, 0.1, 1.3}, {0.9, 0, 0}, {0, 0.8, 0.1}), maker.material(sheet));
    expect_agreement(maker.compile(), "room of fog with a sheet", kBehindGlass, 20, 8, 0.5);
}

/// Rays of a parallel camera, and paths that are joined to it, begin in the fog.
TEST(VolumeAgreement, AParallelCameraInFog) {
    SceneMaker maker = room_of_fog();
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, -0.9, 1}, {0, 1, -0.2}, {1.4, 0, 0}, {0, 0.28, 1.4}};
    expect_agreement(maker.compile(), "parallel camera in fog", kAll, 20, 8, 0.5);
}

/// A glass ball in fog, lit from outside through the boundary of the fog.
TEST(VolumeAgreement, GlassInFog) {
    SceneMaker maker = over_a_floor();
    maker.add(BoxShape{{-1.5, -1.5, 0.02}, {1.5, 1.5, 1.3}},
              maker.material(fog({}, {0.4, 0.4, 0.5}, 0.5)));
    maker.add(ball({0, 0, 0.6}, 0.4), maker.material(smooth_glass()));
    maker.add(ball({0.3, -0.3, 2.2}, 0.4), maker.material(shining({9, 9, 9})));
    expect_agreement(maker.compile(), "glass in fog", kBehindGlass, 24, 16, 0.4);
}

/// A boundary that covers in part is open into its volume for the rest: eye, lamps and paths agree
/// on what lies behind. Before, paths went in without a medium, and lost it where they went out.
TEST(VolumeAgreement, BoundariesThatCoverInPart) {
    struct Case {
        std::string name;
        Material material;
        AlphaMode mode;
        double alpha;
    };
    Material ink = smooth_glass(1.2);
    ink.metallic_roughness->attenuation_color = {0.5, 0.7, 0.9};
    ink.metallic_roughness->attenuation_distance = 0.3;
    const std::vector<Case> cases{
        {"ink", ink, AlphaMode::Blend, 0.4},
        {"cut out ink", ink, AlphaMode::Mask, 0.2},
        {"fog", fog({0.2, 0.5, 0.9}, {0.8, 1.2, 1.6}, 0.3), AlphaMode::Blend, 0.5},
        {"cut out fog", fog({0.2, 0.5, 0.9}, {0.8, 1.2, 1.6}, 0.3), AlphaMode::Mask, 0.2},
        {"milk", fog({0.02, 0.05, 0.3}, {1, 2, 3}, 0.5, 1.35), AlphaMode::Blend, 0.5}};
    for (const Case& c : cases) {
        SceneMaker maker = over_a_floor();
        Material material = c.material;
        material.alpha_mode = c.mode;
        material.alpha.value = c.alpha;
        maker.add(BoxShape{{-0.7, -0.6, 0.02}, {0.6, 0.5, 0.9}}, maker.material(material));
        maker.add(rectangle({-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}),
                  maker.material(shining({4, 4, 4})));
        // A lamp and a ball inside.
        maker.add(ball({0.2, 0, 0.5}, 0.1), maker.material(shining({3, 2, 2})));
        maker.add(ball({-0.3, 0.1, 0.4}, 0.2), maker.material(matt({0.7, 0.7, 0.7})));
        expect_agreement(maker.compile(), c.name, c.mode == AlphaMode::Mask ? kAll : kBehindGlass,
                         27, 16, 0.4);
    }
}

/// A ball of fog that flies while the shutter is open, seen by an open lens.
TEST(VolumeAgreement, FogThatMoves) {
    SceneMaker maker = over_a_floor();
    auto& camera = std::get<PerspectiveCamera>(maker.description().cameras[0].camera);
    camera.lens.radius = 0.1;
    camera.lens.focus_distance = 3.6;
    maker.add(ball({0, 0, 0.7}, 0.5), maker.material(fog({0.1, 0.1, 0}, {1, 1.5, 2}, 0.3)));
    auto& part = maker.description().objects[0].parts.back();
    part.motion = std::make_shared<const PartMotion>(
        PartMotion{{}, {{10, Affine{}}, {14, Affine::translate({1.2, 0, 0})}}, {}});
    open_shutter(maker.description(), {11, 13});
    add_point(maker, {0.8, -0.5, 1.8}, {1, 1, 1});
    const Scene scene = maker.compile();
    ASSERT_TRUE(scene.has_motion);
    expect_agreement(scene, "fog that moves", kAll, 20, 16, 0.4);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
