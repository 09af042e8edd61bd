// Paths from both ends through scattering volumes: closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

const std::vector<std::string> kJoining{"path_tracing", "light_tracing", "bidirectional",
                                        "vcm:photons=50,radius=0.01,pilot=off"};

/// Every day one of them for each turn.
std::vector<std::string> joining(std::size_t turn) {
    std::vector<std::string> some;
    for (std::size_t k = 0; k < kJoining.size(); ++k) {
        if (testing::is_tried(k, kJoining.size(), turn)) some.push_back(kJoining[k]);
    }
    return some;
}

/// `name` with a setting more.
std::string with(const std::string& name, const std::string& setting) {
    return name + (name.find(':') == std::string::npos ? ":" : ",") + setting;
}

/// A view of a whole ball of radius 1 and some of its surroundings.
SceneMaker beside_a_ball() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {2.4, 0, 0}, {0, 2.4, 0}};
    return maker;
}

/// A furnace: what only scatters is invisible in even surroundings.
TEST(VolumePaths, WhatOnlyScattersIsInvisibleInEvenSurroundings) {
    std::size_t turn = 0;
    for (const double g : {0.0, 0.8, -0.5}) {
        SceneMaker maker = beside_a_ball();
        maker.description().picture.background = Rgb{1, 1, 1};
        maker.add(ball({0, 0, 0}, 1), maker.material(fog({}, {0.5, 1, 2}, g)));
        const Scene scene = maker.compile();
        for (const std::string& renderer : joining(turn++)) {
            expect_mean(scene, with(renderer, "depth=200"), {1, 1, 1},
                        {.samples = 128, .largest_error = 0.04});
        }
    }
}

/// The same behind a boundary that reflects and refracts: no light is lost, none is found twice.
TEST(VolumePaths, ABallOfMilkIsInvisibleInEvenSurroundings) {
    SceneMaker maker = beside_a_ball();
    maker.description().picture.background = Rgb{1, 1, 1};
    maker.add(ball({0, 0, 0}, 1), maker.material(fog({}, {2, 3, 4}, 0.8, 1.35)));
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing:depth=500", "bidirectional:depth=500",
                                 "vcm:photons=50,radius=0.01,pilot=off,depth=500"}) {
        expect_mean(scene, renderer, {1, 1, 1}, {.samples = 64, .largest_error = 0.02});
    }
}

/// Airlight: light scattered once by fog, along parallel views.
TEST(VolumePaths, ALampInFogShinesByTheIntegralAlongTheView) {
    const Rgb absorption{0.1, 0, 0.4}, scattering{0.3, 0.2, 0.15};
    const Vec3 lamp{1.6, 0, 1};
    constexpr double kWide = 2.0;
    std::size_t turn = 1;
    for (const double g : {0.0, 0.8, -0.5}) {
        SceneMaker maker;
        maker.description().cameras[0].camera =
            OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {kWide, 0, 0}, {0, kWide, 0}};
        maker.description().conventions.shading.clamp_attenuation = false;
        maker.add(BoxShape{{-50, -50, -1}, {50, 50, 3}},
                  maker.material(fog(absorption, scattering, g)));
        maker.light(PointLight{.position = lamp, .color = {3, 3, 3}, .attenuation = {0, 0, 1}});
        Rgb expected;
        constexpr int kSteps = 400, kGrid = 80;
        for (int k = 0; k < kGrid * kGrid; ++k) {
            const double x = kWide * ((k % kGrid + 0.5) / kGrid - 0.5);
            const double y = kWide * ((k / kGrid + 0.5) / kGrid - 0.5);
            for (int i = 0; i < kSteps; ++i) {
                const double depth = 4.0 * (i + 0.5) / kSteps;
                const Vec3 to = lamp - Vec3{x, y, 3 - depth};
                const double d = length(to);
                // A light of intensity 1 gives the irradiance pi at a distance of 1.
                const double light = 4.0 / kSteps * henyey_greenstein(-to.z / d, g) * 3.0 * kPi /
                                     (d * d) / (kGrid * kGrid);
                for (int c = 0; c < 3; ++c) {
                    const double extinction = absorption[c] + scattering[c];
                    expected[c] += light * scattering[c] * std::exp(-extinction * (depth + d));
                }
            }
        }
        const Scene scene = maker.compile();
        for (const std::string& renderer : joining(turn++)) {
            expect_mean(scene, with(renderer, "depth=1"), expected,
                        {.samples = 200, .largest_error = 0.05});
        }
    }
}

/// A layer in sunlight, with boundaries without refraction.
TEST(VolumePaths, ALayerInTheSunShowsTheFirstOrderOfItsScattering) {
    const Rgb absorption{0.1, 0.3, 0}, scattering{0.3, 0.2, 0.6};
    constexpr double kThick = 1.5;
    std::size_t turn = 2;
    for (const double g : {0.0, -0.5}) {
        SceneMaker maker;
        maker.description().cameras[0].camera =
            OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
        maker.add(BoxShape{{-2, -2, -kThick}, {2, 2, 0}},
                  maker.material(fog(absorption, scattering, g)));
        maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
        Rgb expected;
        for (int i = 0; i < 3; ++i) {
            const double extinction = absorption[i] + scattering[i];
            expected[i] = scattering[i] / (2.0 * extinction) * henyey_greenstein(-1.0, g) * kPi *
                          (1.0 - std::exp(-2.0 * extinction * kThick));
        }
        const Scene scene = maker.compile();
        for (const std::string& renderer : joining(turn++)) {
            expect_mean(scene, with(renderer, "depth=1"), expected,
                        {.samples = 256, .largest_error = 0.05});
        }
    }
}

/// A small light in the middle of a ball of fog, seen by single scattering.
TEST(VolumePaths, ALampInABallOfFogIsFoundFromOutside) {
    const Rgb scattering{0.2, 0.5, 0.8};
    SceneMaker maker = beside_a_ball();
    maker.description().conventions.shading.clamp_attenuation = false;
    maker.add(ball({0, 0, 0}, 1), maker.material(fog({}, scattering)));
    maker.light(PointLight{.position = {0, 0, 0}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    // Integral over the distance r from the light: a shell scatters isotropically, and the light is
    // attenuated from there to the surface.
    Rgb expected;
    constexpr int kShells = 200, kCosines = 200;
    for (int i = 0; i < kShells * kCosines; ++i) {
        const double r = (i % kShells + 0.5) / kShells;
        const double cosine = 2.0 * (i / kShells + 0.5) / kCosines - 1.0;
        const double way = std::sqrt(1.0 - r * r * (1.0 - cosine * cosine)) - r * cosine;
        for (int c = 0; c < 3; ++c) {
            // Irradiance pi / r^2, over the volume 2 pi r^2 dr dcosine.
            expected[c] += scattering[c] * std::exp(-scattering[c] * (r + way)) / (4.0 * kPi) *
                           kPi * 2.0 * kPi / kShells * 2.0 / kCosines / (2.4 * 2.4);
        }
    }
    const Scene scene = maker.compile();
    // Views that pass close to the light have an infinite variance with paths from the eye alone.
    for (const std::string& renderer : kJoining) {
        if (renderer == "path_tracing") continue;
        expect_mean(scene, with(renderer, "depth=1"), expected,
                    {.samples = 100, .largest_error = 0.02, .side = 8});
    }
}

TEST(VolumePaths, PicturesDependNeitherOnThreadsNorOnTiles) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{0.5, 0.7, 1};
    maker.add(ball({0, 0, 0}, 1), maker.material(fog({0.1, 0, 0}, {1, 2, 3}, 0.5)));
    maker.add(ball({0.5, 0, 0}, 0.4), maker.material(fog({0.1, 0, 0}, {4, 2, 3}, 0.5, 1.3)));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
              maker.material(matt({0.5, 0.5, 0.5})));
    maker.light(PointLight{.position = {1, 0.3, 2}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile("wide_bvh");
    for (const std::string& name : kJoining) {
        for (const std::string& renderer : {name, name + " --spectral"}) {
            testing::expect_same_for_threads_and_tiles(scene, renderer, 4);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
