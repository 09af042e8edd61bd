// Photons in scattering volumes: closed forms, and path_tracing.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "alhazen/math/constants.h"
#include "alhazen/renderers/light_transport/volume_scattering.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// Estimates over balls of one radius.
constexpr double kRadius = 0.2;
const std::string kMapped =
    "photon_mapping:photons=40000,caustics=40000,nearest=1000000,radius=0.2";
/// Few photons in many passes: most of the error is that of the eye paths.
const std::string kProgressive = "sppm:photons=1000,radius=0.2,alpha=1";

/// With a map or with passes; every day one of them.
void expect_mean_of_both(const Scene& scene, const std::string& settings, const Rgb& expected,
                         bool mapped) {
    // Rounding of photons may take 0.3 %.
    MeanBounds bounds{.samples = 64, .largest_error = 0.03, .bias = 0.003};
    if (thorough() || mapped) expect_mean(scene, kMapped + settings, expected, bounds);
    bounds.samples = 128;
    if (thorough() || !mapped) expect_mean(scene, kProgressive + settings, expected, bounds);
}

/// The share of a ball of kRadius around a point that lies in the unit ball; the point is `apart`
/// from its middle.
double share_inside(double apart) {
    if (apart + kRadius <= 1.0) return 1.0;
    const double r = kRadius, d = apart, over = 1.0 + r - d;
    const double lens =
        kPi * over * over * (d * d + 2 * d * r - 3 * r * r + 2 * d + 6 * r - 3) / (12 * d);
    return lens / (4.0 / 3.0 * kPi * r * r * r);
}

/// Light from all sides enters through the boundary as caustic photons, and is scattered. Estimates
/// extend beyond the boundary into empty space.
TEST(PhotonVolumes, WhatOnlyScattersIsInvisibleInEvenSurroundings) {
    for (const double g : {0.0, 0.5}) {
        if (!thorough() && g == 0.0) continue;
        const Rgb scattering{0.4, 0.8, 1.6};
        SceneMaker maker = looking_down();
        maker.description().picture.background = Rgb{1, 1, 1};
        maker.add(ball({0, 0, 0}, 1), maker.material(fog({}, scattering, g, kNearlyOne)));
        Rgb expected;
        constexpr int kSteps = 2000;
        for (int i = 0; i < 3; ++i) {
            expected[i] = std::exp(-2.0 * scattering[i]);
            for (int k = 0; k < kSteps; ++k) {
                const double s = 2.0 * (k + 0.5) / kSteps;
                expected[i] += 2.0 / kSteps * scattering[i] * std::exp(-scattering[i] * s) *
                               share_inside(std::abs(1.0 - s));
            }
        }
        const Scene scene = maker.compile();
        expect_mean_of_both(scene, "", expected, g == 0.0);
    }
}

/// Shadow rays end at the boundary; the photons of the sun do not.
TEST(PhotonVolumes, ALayerInTheSunShowsTheFirstOrderOfItsScattering) {
    const Rgb absorption{0.1, 0.3, 0}, scattering{0.3, 0.2, 0.6};
    constexpr double kThick = 1.5;
    for (const double g : {0.0, -0.4}) {
        if (!thorough() && g == 0.0) continue;
        SceneMaker maker = looking_down();
        maker.add(BoxShape{{-1, -1, -kThick}, {1, 1, 0}},
                  maker.material(fog(absorption, scattering, g, kNearlyOne)));
        maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
        Rgb expected;
        constexpr int kSteps = 400;
        for (int i = 0; i < 3; ++i) {
            const double extinction = absorption[i] + scattering[i];
            for (int k = 0; k < kSteps * kSteps; ++k) {
                const double depth = kThick * (k % kSteps + 0.5) / kSteps;
                // A slice of the ball around that depth.
                const double off = kRadius * (2.0 * (k / kSteps + 0.5) / kSteps - 1.0);
                if (depth + off < 0.0 || depth + off > kThick) continue;
                const double slice = 0.75 / (kRadius * kRadius * kRadius) *
                                     (kRadius * kRadius - off * off) * 2.0 * kRadius / kSteps;
                // A light of colour 1 gives the irradiance pi.
                expected[i] += kThick / kSteps * scattering[i] * std::exp(-extinction * depth) *
                               henyey_greenstein(-1.0, g) * slice * kPi *
                               std::exp(-extinction * (depth + off));
            }
        }
        const Scene scene = maker.compile();
        expect_mean_of_both(scene, ",depth=2", expected, g != 0.0);
    }
}

/// A room of coloured mist with a light in it.
SceneMaker room_of_mist() {
    SceneMaker maker;
    const auto wall = [&](const Vec3& corner, const Vec3& u, const Vec3& v, const Rgb& color) {
        maker.add(rectangle(corner, u, v), maker.material(matt(color)));
    };
    wall({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {0.7, 0.7, 0.7});
    wall({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}, {0.6, 0.7, 0.8});
    wall({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}, {0.8, 0.2, 0.2});
    wall({1, -1, 0}, {0, 2, 0}, {0, 0, 2}, {0.2, 0.8, 0.2});
    maker.add(ball({0.3, 0.3, 0.4}, 0.3), maker.material(matt({0.8, 0.8, 0.3})));
    maker.add(rectangle({-0.3, -0.1, 1.8}, {0.6, 0, 0}, {0, 0.6, 0}),
              maker.material(shining({6, 6, 5})));
    maker.add(BoxShape{{-3, -3, -3}, {3, 3, 3}},
              maker.material(fog({0.1, 0.05, 0}, {0.4, 0.5, 0.6}, 0.3)));
    return maker;
}

/// Direct light by shadow rays, all other by photons, against path_tracing, which draws each
/// scattering. Every day one renderer, `first`.
void expect_light_of(const Scene& scene, const std::string& path_tracing,
                     const std::vector<std::string>& renderers, std::size_t first) {
    constexpr double kMost = 5.4, kBias = 0.03;  // as in photon_renderers_test
    const Blocks truth = blocks_of(scene, path_tracing, 96, 8);
    double whole = 0.0;
    for (const double mean : truth.mean) whole += 0.25 * mean;
    EXPECT_GT(whole, 0.1);
    for (std::size_t k = 0; k < renderers.size(); ++k) {
        if (!is_tried(k, renderers.size(), first)) continue;
        const std::string& renderer = renderers[k];
        // Each sample of sppm is a pass with photons of its own.
        const Blocks found = blocks_of(scene, renderer, renderer.starts_with("sppm") ? 16 : 32, 8);
        for (std::size_t i = 0; i < 4; ++i) {
            const double error = std::hypot(found.error[i], truth.error[i]);
            EXPECT_LE(error, 0.05 * whole) << renderer << ", block " << i;
            EXPECT_LE(std::abs(found.mean[i] - truth.mean[i]), kMost * error + kBias * whole)
                << renderer << ", block " << i << ": " << found.mean[i] << " +- " << found.error[i]
                << ", path_tracing " << truth.mean[i] << " +- " << truth.error[i];
        }
    }
}

TEST(PhotonVolumes, AgreeWithPathTracingInARoomOfMist) {
    SceneMaker maker = room_of_mist();
    maker.description().cameras[0].camera =
        look_along({0, -0.9, 1}, {0, 1, -0.2}, {0, 0, 1}, 0.9, 1.0);
    const Scene scene = maker.compile();
    expect_light_of(scene, "path_tracing",
                    {"photon_mapping:photons=10000,caustics=0,nearest=40",
                     "photon_mapping:photons=10000,caustics=0,nearest=40,gather=4",
                     "sppm:photons=4000,radius=0.1"},
                    1);
    if (!thorough()) return;
    // A sixteenth of the photons are looked up.
    expect_light_of(scene, "path_tracing --spectral",
                    {"photon_mapping:photons=40000,caustics=0,nearest=160 --spectral",
                     "sppm:photons=4000,radius=0.1 --spectral"},
                    0);
}

TEST(PhotonVolumes, AgreeWithPathTracingForAParallelCameraInMist) {
    SceneMaker maker = room_of_mist();
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 1.5}, {0, 0, -1}, {1.6, 0, 0}, {0, 1.6, 0}};
    const Scene scene = maker.compile();
    expect_light_of(
        scene, "path_tracing",
        {"photon_mapping:photons=10000,caustics=0,nearest=40", "sppm:photons=4000,radius=0.1"}, 1);
}

TEST(PhotonVolumes, PicturesDependNeitherOnThreadsNorOnTiles) {
    SceneMaker maker;
    maker.description().picture.background = Rgb{0.5, 0.7, 1};
    maker.add(ball({0, 0, 0}, 1), maker.material(fog({0.1, 0, 0}, {1, 2, 3}, 0.5)));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
              maker.material(matt({0.5, 0.5, 0.5})));
    const Scene scene = maker.compile("wide_bvh");
    for (const std::string& renderer : {std::string("photon_mapping:photons=2000,caustics=2000"),
                                        std::string("sppm:photons=2000")}) {
        const Film a = picture_of(scene, renderer, 16, 4, 7, 1, 32);
        const Film b = picture_of(scene, renderer, 16, 4, 7, 2, 5);
        for (int i = 0; i < 256; ++i) {
            EXPECT_EQ(a.at(i % 16, i / 16), b.at(i % 16, i / 16)) << renderer << " " << i;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
