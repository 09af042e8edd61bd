// Scenes with scattering volumes: the renderers of light transport agree in pairs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

struct Found {
    std::string renderer;
    Blocks blocks;
    double bias;  ///< allowed, of the picture
};

/// Compares all pairs, every day one, block by block. 24 cases in a scene of four renderers: a t of
/// 22 degrees of freedom beyond 5.7 occurs in one of 4000 runs of it. Errors are at most `most` of
/// the block, or of the picture if that is brighter; differences of several times as much are
/// detected.
void expect_agreement(const Scene& scene, const std::string& name,
                      const std::vector<std::string>& all, int samples, double most) {
    constexpr double kMost = 5.7;
    std::vector<Found> found;
    for (const std::string& renderer : to_compare(all, name)) {
        // Merging is biased by its radius alone.
        const double bias = renderer.starts_with("vcm") ? 0.005 : 0.0;
        // A light path finds less than an eye path, and costs less.
        const int times = renderer.starts_with("light_tracing") ? 4 : 1;
        found.push_back({renderer, blocks_of(scene, renderer, times * samples), bias});
    }
    double whole = 0.0;
    for (const double mean : found[0].blocks.mean) whole += mean / 4;
    EXPECT_GT(whole, 0.01) << name;
    for (std::size_t a = 0; a < found.size(); ++a) {
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_LE(found[a].blocks.error[i], most * std::max(whole, found[0].blocks.mean[i]))
                << name << ", block " << i << ": " << found[a].renderer;
        }
        for (std::size_t b = a + 1; b < found.size(); ++b) {
            for (std::size_t i = 0; i < 4; ++i) {
                const double error = std::hypot(found[a].blocks.error[i], found[b].blocks.error[i]);
                const double bias = (found[a].bias + found[b].bias) * whole;
                EXPECT_LE(std::abs(found[a].blocks.mean[i] - found[b].blocks.mean[i]),
                          kMost * error + bias)
                    << name << ", block " << i << ": " << found[a].renderer << " "
                    << found[a].blocks.mean[i] << ", " << found[b].renderer << " "
                    << found[b].blocks.mean[i] << " +- " << error;
            }
        }
    }
}

/// Merging counts as much with few photons and a wide radius: by their number times its square.
const std::vector<std::string> kAll{"path_tracing", "light_tracing", "bidirectional",
                                    "vcm:photons=100,radius=0.06,pilot=off"};
/// Renderers for scenes that are black to light tracing.
const std::vector<std::string> kBehindGlass{"path_tracing", "bidirectional",
                                            "vcm:photons=100,radius=0.06,pilot=off"};

std::vector<std::string> spectral(std::vector<std::string> renderers) {
    for (std::string& r : renderers) r += " --spectral";
    return renderers;
}

/// A floor seen obliquely from above.
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
        if (!thorough() && g != 0.8) continue;
        SceneMaker maker = over_a_floor();
        maker.add(ball({0, 0, 0.7}, 0.6), maker.material(fog({0.2, 0.1, 0}, {0.8, 1.2, 1.6}, g)));
        add_point(maker, {0.8, -0.5, 1.8}, {1, 1, 1});
        expect_agreement(maker.compile(), "point of light, " + std::to_string(g), kAll, 24, 0.05);
    }
}

/// Photons through a boundary without refraction are direct light, which shadow rays find: it is
/// not counted twice. Balls of estimates extend beyond the thin fog.
TEST(VolumeAgreement, PhotonsOfAPointOutsideOfFog) {
    SceneMaker maker = over_a_floor();
    maker.add(BoxShape{{-1, -1, 0.02}, {1, 1, 1.2}},
              maker.material(fog({0.1, 0.1, 0}, {0.15, 0.2, 0.25}, 0.3)));
    add_point(maker, {0.8, -0.5, 1.8}, {1, 1, 1});
    const Scene scene = maker.compile();
    constexpr double kMost = 5.4;
    const std::vector<std::string> many{
        "photon_mapping:photons=10000,caustics=10000,nearest=10,projection=off,",
        "sppm:photons=10000,radius=0.1,"};
    // Single scattering needs no photons: few would show as well that they are not counted.
    const std::vector<std::string> few{
        "photon_mapping:photons=4000,caustics=1000,nearest=40,projection=off,",
        "sppm:photons=1000,radius=0.1,"};
    for (const char* depth : {"depth=1", "depth=2"}) {
        const bool single = std::string(depth) == "depth=1";
        const double bias = single ? 0.0 : 0.04;
        const Blocks truth = blocks_of(scene, std::string("path_tracing:") + depth, 48, 8);
        double whole = 0.0;
        for (const double mean : truth.mean) whole += mean / 4;
        for (const std::string& name : single ? few : many) {
            // Every day passes for single scattering, a map for more.
            if (!thorough() && name.starts_with("sppm") != single) continue;
            const Blocks found =
                blocks_of(scene, name + depth, name.starts_with("sppm") ? 16 : 32, 8);
            for (std::size_t i = 0; i < 4; ++i) {
                const double error = std::hypot(found.error[i], truth.error[i]);
                EXPECT_LE(error, 0.05 * whole) << name << depth << ", block " << i;
                EXPECT_LE(std::abs(found.mean[i] - truth.mean[i]), kMost * error + bias * whole)
                    << name << depth << ", block " << i << ": " << found.mean[i]
                    << ", path_tracing " << truth.mean[i] << " +- " << error;
            }
        }
    }
}

TEST(VolumeAgreement, TheSunAndTheSkyOverACloud) {
    SceneMaker maker = over_a_floor();
    maker.description().picture.background = Rgb{0.3, 0.4, 0.6};
    maker.light(
        DirectionalLight{.to_light = normalize(Vec3{0.3, -0.4, 0.8}), .color = {1, 1, 0.8}});
    maker.add(ball({0, 0, 0.7}, 0.6), maker.material(fog({}, {2, 2, 2}, 0.6)));
    expect_agreement(maker.compile(), "cloud", kAll, 32, 0.05);
}

TEST(VolumeAgreement, MilkInARoomWithALamp) {
    SceneMaker maker = over_a_floor();
    maker.add(rectangle({-0.6, -0.6, 2.2}, {0, 1.2, 0}, {1.2, 0, 0}),
              maker.material(shining({5, 5, 5})));
    maker.add(ball({0, 0, 0.55}, 0.5),
              maker.material(fog({0.02, 0.05, 0.3}, {3, 4, 5}, 0.7, 1.35)));
    const Scene scene = maker.compile();
    if (thorough()) expect_agreement(scene, "milk", kBehindGlass, 48, 0.06);
    expect_agreement(scene, "milk, spectral", spectral(kBehindGlass), 48, 0.06);
}

TEST(VolumeAgreement, ALampInsideOfAVolume) {
    for (const double index : {1.0, 1.2}) {
        if (!thorough() && index == 1.0) continue;
        SceneMaker maker = over_a_floor();
        maker.add(ball({0, 0, 0.9}, 0.15), maker.material(shining({12, 10, 8})));
        maker.add(ball({0, 0, 0.9}, 0.7),
                  maker.material(fog({0.3, 0.1, 0.1}, {0.5, 0.9, 1.3}, 0.4, index)));
        expect_agreement(maker.compile(), "lamp inside, index " + std::to_string(index),
                         index == 1.0 ? kAll : kBehindGlass, 48, 0.07);
    }
}

/// Fog around an absorbing volume around denser fog, of one index, which is that of the air or not.
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
        // Every day spectral with null boundaries.
        if (thorough() || index != 1.0) expect_agreement(scene, name, renderers, 24, 0.06);
        if (index == 1.0) expect_agreement(scene, name + ", spectral", spectral(kAll), 24, 0.06);
    }
}

/// The eye, the light, a glossy ball and half a wall are in the fog.
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
    expect_agreement(maker.compile(), "room of fog", kAll, 20, 0.08);
    // A sheet that reflects, which light paths do not show.
    Material sheet = smooth_glass();
    sheet.metallic_roughness->thickness.value = 0;
    sheet.metallic_roughness->base_color.color = {0.9, 0.6, 0.5};
    maker.add(rectangle({-0.8, 0.1, 1.3}, {0.9, 0, 0}, {0, 0.8, 0.1}), maker.material(sheet));
    expect_agreement(maker.compile(), "room of fog with a sheet", kBehindGlass, 16, 0.07);
}

/// Rays of a parallel camera, and paths that are joined to it, begin in the fog.
TEST(VolumeAgreement, AParallelCameraInFog) {
    SceneMaker maker = room_of_fog();
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, -0.9, 1}, {0, 1, -0.2}, {1.4, 0, 0}, {0, 0.28, 1.4}};
    expect_agreement(maker.compile(), "parallel camera in fog", kAll, 20, 0.08);
}

/// A glass ball in fog, lit from outside through the boundary of the fog.
TEST(VolumeAgreement, GlassInFog) {
    SceneMaker maker = over_a_floor();
    maker.add(BoxShape{{-1.5, -1.5, 0.02}, {1.5, 1.5, 1.3}},
              maker.material(fog({}, {0.4, 0.4, 0.5}, 0.5)));
    maker.add(ball({0, 0, 0.6}, 0.4), maker.material(smooth_glass()));
    maker.add(ball({0.3, -0.3, 2.2}, 0.4), maker.material(shining({9, 9, 9})));
    expect_agreement(maker.compile(), "glass in fog", kBehindGlass, 48, 0.05);
}

/// A boundary of partial coverage is open into its volume for the rest: eye, lights and paths agree
/// on the medium behind it.
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
        if (!thorough() && (c.name == "cut out ink" || c.name == "fog")) continue;
        SceneMaker maker = over_a_floor();
        Material material = c.material;
        material.alpha_mode = c.mode;
        material.alpha.value = c.alpha;
        maker.add(BoxShape{{-0.7, -0.6, 0.02}, {0.6, 0.5, 0.9}}, maker.material(material));
        maker.add(rectangle({-0.5, -0.5, 2}, {0, 1, 0}, {1, 0, 0}),
                  maker.material(shining({4, 4, 4})));
        // A light and a ball inside.
        maker.add(ball({0.2, 0, 0.5}, 0.1), maker.material(shining({3, 2, 2})));
        maker.add(ball({-0.3, 0.1, 0.4}, 0.2), maker.material(matt({0.7, 0.7, 0.7})));
        expect_agreement(maker.compile(), c.name, c.mode == AlphaMode::Mask ? kAll : kBehindGlass,
                         64, 0.06);
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
    expect_agreement(scene, "fog that moves", kAll, 48, 0.05);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
