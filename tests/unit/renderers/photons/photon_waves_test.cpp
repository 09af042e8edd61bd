#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>
#include <span>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/renderers/photons/photon.h"
#include "alhazen/renderers/photons/photon_passes.h"
#include "support/light_pictures.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::Blocks;
using testing::blocks_of;
using testing::floor_from_above;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;

TEST(StoredLight, KeepsFourWavelengthsWithinTheirBits) {
    testing::Random random(3);
    Wavelengths waves = Wavelengths::drawn(0.3);
    Wavelengths hero = waves;
    Spectrum ignored;
    hero.keep_hero(ignored);
    for (int trial = 0; trial < 1000; ++trial) {
        Spectrum light;
        for (int i = 0; i < Spectrum::kCount; ++i) {
            light[i] = random.coin() ? random.log_uniform(1e-30, 1e30) : 0.0;
        }
        for (const Wavelengths* w : {&waves, &hero}) {
            Photon photon;
            photon.power = stored_light(light, *w);
            EXPECT_EQ(photon.hero_only(), w == &hero);
            for (int i = 0; i < Spectrum::kCount; ++i) {
                EXPECT_NEAR(photon.light()[i], light[i], 0x1p-16 * light[i]);
            }
        }
    }
    Photon photon;
    photon.power = stored_light({0.1, 2, 30, 30}, {});
    EXPECT_EQ(photon.light().a, double{0.1f});
    EXPECT_EQ(photon.light().d, 30.0);
    EXPECT_FALSE(photon.hero_only());
}

Material flint(double roughness) {
    Material m = testing::glass_named("SF11");
    m.roughness.value = roughness;
    return m;
}

/// A coloured floor and a wall, a light, and a ball of flint in front of it.
Scene room(double roughness) {
    SceneMaker maker = floor_from_above(1.2, {0.8, 0.5, 0.2});
    maker.add(rectangle({-1, 0.8, 0}, {2, 0, 0}, {0, 0, 2}), maker.material(matt({0.2, 0.5, 0.8})));
    maker.add(ball({0, 0, 2}, 0.5), maker.material(shining({4, 4, 3})));
    maker.add(ball({0.1, 0, 0.35}, 0.25), maker.material(flint(roughness)));
    return maker.compile();
}

struct Case {
    const char* renderer;
    double bias;  ///< of the picture's mean, of disc and radius
    int samples;
};
/// Every day with the case `one`.
void expect_light_of_path_tracing(const Scene& scene, std::span<const Case> cases,
                                  const std::string& name, std::size_t one) {
    const Blocks truth = blocks_of(scene, "path_tracing --spectral", 96);
    double whole = 0.0;
    for (const double mean : truth.mean) whole += mean / double(truth.mean.size());
    EXPECT_GT(whole, 0.05) << name;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        if (!testing::is_tried(k, cases.size(), one)) continue;
        const Case& c = cases[k];
        const Blocks found = blocks_of(scene, c.renderer, c.samples);
        for (std::size_t i = 0; i < truth.mean.size(); ++i) {
            const double error = std::hypot(found.error[i], truth.error[i]);
            EXPECT_LE(error, 0.1 * whole) << name << ", block " << i << ", " << c.renderer;
            EXPECT_LE(std::abs(found.mean[i] - truth.mean[i]), 5.0 * error + c.bias * whole)
                << name << ", block " << i << ", " << c.renderer << ": " << found.mean[i] << " +- "
                << found.error[i] << ", path_tracing " << truth.mean[i] << " +- " << truth.error[i];
        }
    }
}

TEST(PhotonWaves, AgreeWithPathTracingByWavelengths) {
    const Case cases[] = {
        {"photon_mapping:photons=96000,caustics=48000,nearest=96,filter=disc --spectral", 0.03, 16},
        {"photon_mapping:photons=24000,caustics=48000,nearest=96,filter=disc,gather=4 --spectral",
         0.03, 32},
        {"sppm:photons=2000,radius=0.06 --spectral", 0.02, 48},
        {"vcm:photons=300,radius=0.06,pilot=off --spectral", 0.01, 32},
    };
    for (const double roughness : {0.0, 0.4}) {
        expect_light_of_path_tracing(room(roughness), cases,
                                     "roughness " + std::to_string(roughness),
                                     roughness > 0.0 ? 1 : 3);
    }
}

/// A ball of flint and a matt one that cross the picture while the shutter is open.
TEST(PhotonWaves, AgreeWithPathTracingOnWhatMoves) {
    SceneMaker maker = floor_from_above(1.2, {0.8, 0.5, 0.2});
    maker.add(ball({0, 0, 2}, 0.5), maker.material(shining({4, 4, 3})));
    maker.add(ball({-0.4, -0.2, 0.35}, 0.2), maker.material(flint(0.0)));
    maker.add(ball({-0.4, 0.3, 0.3}, 0.15), maker.material(matt({0.2, 0.5, 0.8})));
    SceneDescription& d = maker.description();
    for (const std::size_t part : {2u, 3u}) {
        d.objects[0].parts[part].motion = std::make_shared<const PartMotion>(
            PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({0.8, 0, 0})}}, {}});
    }
    d.shutter = {0, 1};
    const Scene scene = maker.compile();
    ASSERT_TRUE(scene.has_motion);
    const Case cases[] = {
        {"photon_mapping:photons=8000,caustics=64000,nearest=96,filter=disc --spectral", 0.03, 16},
        {"sppm:photons=2000,radius=0.06 --spectral", 0.03, 32},
        {"vcm:photons=2000,radius=0.06,pilot=off --spectral", 0.03, 32},
    };
    expect_light_of_path_tracing(scene, cases, "moving balls", 1);
}

/// Light passes a pane to the floor while one card is out of its way; the eye sees the floor while
/// another card is away: before that, or `at_once`. Both jump near the middle of the shutter time.
Scene floor_behind_cards(bool cards, bool at_once) {
    SceneMaker maker;
    SceneDescription& d = maker.description();
    d.cameras[0].camera =
        OrthographicCamera{{-0.8, 0, 0.8}, normalize(Vec3{1, 0, -1}), {0, 0.1, 0}, {0.07, 0, 0.07}};
    maker.add(rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}), maker.material(matt({0.8, 0.8, 0.8})));
    maker.add(BoxShape{{-9, -9, 1}, {9, 9, 1.1}}, maker.material(testing::smooth_glass()));
    maker.light(PointLight{.position = {0, 0, 3}, .color = {9, 9, 9}, .attenuation = {0, 0, 1}});
    if (!cards) return maker.compile();
    const MaterialId black = maker.material(matt({}));
    const auto card = [&](const Rectangle& shape, double moment, bool leaves) {
        maker.add(shape, black);
        const Affine here, away = Affine::translate({0, 40, 0});
        d.objects[0].parts.back().motion =
            std::make_shared<const PartMotion>(PartMotion{{},
                                                          {{0, leaves ? here : away},
                                                           {moment - 0.001, leaves ? here : away},
                                                           {moment + 0.001, leaves ? away : here},
                                                           {1, leaves ? away : here}},
                                                          {}});
    };
    card(rectangle({-5, -5, 2}, {10, 0, 0}, {0, 10, 0}), 0.503, true);
    card(rectangle({-0.7, -0.1, 0.5}, {0.2, 0, 0.2}, {0, 0.2, 0}), 0.497, at_once);
    d.shutter = {0, 1};
    return maker.compile();
}

TEST(PhotonPasses, ShowTheLightOfTheMomentThatIsSeen) {
    for (const std::string renderer : {"sppm:photons=2000,radius=0.1,alpha=1",
                                       "vcm:photons=2000,radius=0.1,alpha=1,pilot=off"}) {
        const auto light = [&](const Scene& scene) {
            return mean_of(picture_of(scene, renderer, 8, 64)).g;
        };
        const double still = light(floor_behind_cards(false, false));
        ASSERT_GT(still, 0.1) << renderer;
        // Two of 64 passes are of the whole time, whose light a fourth of the pairs would have.
        EXPECT_NEAR(light(floor_behind_cards(true, false)), 0.0, 0.02 * still) << renderer;
        EXPECT_NEAR(light(floor_behind_cards(true, true)), 0.5 * still, 0.05 * still) << renderer;
    }
}

TEST(PhotonPasses, HaveEachPartOfTheShutterOnce) {
    Scene scene = floor_behind_cards(false, false);
    RenderJob job{.scene = scene, .camera = scene.cameras[0].camera};
    constexpr std::uint32_t kPasses = 256;
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
        EXPECT_EQ(shutter_of_pass(job, pass).length, 1.0) << "nothing moves";
    }
    scene.has_motion = true;
    for (std::uint32_t pass = 0; pass < 2; ++pass) {
        EXPECT_EQ(shutter_of_pass(job, pass).begin, 0.0);
        EXPECT_EQ(shutter_of_pass(job, pass).length, 1.0);
    }
    std::set<double> first;
    for (job.seed = 0; job.seed < 32; ++job.seed) {
        first.insert(shutter_of_pass(job, kPasses / 2).begin);
        for (std::uint32_t parts = 2; parts < kPasses; parts *= 2) {
            // However few of them: of any first `some` each lies in another part of that many.
            for (std::uint32_t some = 2; some <= parts; some *= 2) {
                std::set<double> places;
                for (std::uint32_t k = 0; k < some; ++k) {
                    const ShutterPart part = shutter_of_pass(job, parts + k);
                    EXPECT_EQ(part.length, 1.0 / parts) << parts + k;
                    EXPECT_EQ(part.begin * parts, std::floor(part.begin * parts)) << parts + k;
                    EXPECT_GE(part.begin, 0.0);
                    EXPECT_LE(part.begin + part.length, 1.0);
                    places.insert(std::floor(part.begin * some));
                }
                EXPECT_EQ(places.size(), some) << parts << ", seed " << job.seed;
            }
        }
    }
    // Each of the parts is the first one for some seed.
    EXPECT_GT(first.size(), 16u);
}

TEST(PhotonWaves, ShowTheColoursOfMaterials) {
    // A floor below an environment: all light is direct.
    SceneMaker maker = floor_from_above(0.2, {0.7, 0.3, 0.1});
    maker.description().picture.background = Rgb{2, 2, 2};
    const Scene scene = maker.compile();
    for (const char* renderer : {"sppm:photons=10,radius=0.1 --spectral",
                                 "vcm:photons=10,radius=0.1,pilot=off --spectral"}) {
        const Rgb seen = mean_of(picture_of(scene, renderer, 8, 256));
        EXPECT_NEAR(seen.r, 1.4, 0.02) << renderer;
        EXPECT_NEAR(seen.g, 0.6, 0.02) << renderer;
        EXPECT_NEAR(seen.b, 0.2, 0.02) << renderer;
    }
}

TEST(PhotonWaves, PicturesDependNeitherOnThreadsNorOnTiles) {
    const Scene scene = room(0.0);
    for (const char* renderer : {"photon_mapping:photons=3000,caustics=3000 --spectral",
                                 "sppm:photons=1000,radius=0.1 --spectral",
                                 "vcm:photons=300,radius=0.1,pilot=off --spectral"}) {
        const Film one = picture_of(scene, renderer, 12, 4, 1, 1, 32);
        const Film two = picture_of(scene, renderer, 12, 4, 1, 2, 5);
        for (int i = 0; i < 144; ++i) {
            ASSERT_EQ(one.at(i % 12, i / 12), two.at(i % 12, i / 12)) << renderer;
        }
    }
}

TEST(PhotonWaves, AnIrradianceCacheIsRefused) {
    EXPECT_THROW((void)picture_of(room(0.0), "photon_mapping:gather=4,cache=0.2 --spectral", 4, 1),
                 Error);
}

TEST(PhotonWaves, WhatSparesLooksAtColoursIsRefused) {
    for (const char* setting : {"irradiance=on", "every=2"}) {
        const std::string renderer = std::string("photon_mapping:photons=1000,") + setting;
        EXPECT_NO_THROW((void)picture_of(room(0.0), renderer, 2, 1));
        try {
            (void)picture_of(room(0.0), renderer + " --spectral", 2, 1);
            ADD_FAILURE() << setting;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage);
            EXPECT_NE(std::string(e.what()).find(setting[0] == 'i' ? "irradiance=off" : "every=1"),
                      std::string::npos)
                << e.what();
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
