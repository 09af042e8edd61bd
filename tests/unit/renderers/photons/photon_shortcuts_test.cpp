// Optimisations of photon lookups: lookups in turn, irradiance at photons, the irradiance cache.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "alhazen/base/error.h"
#include "alhazen/renderers/core/rounds.h"
#include "alhazen/renderers/photon_mapping/fill_cache.h"
#include "alhazen/shapes/polygons/box_shape.h"
#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::matt;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;

/// A floor, seen from above, lit by a light directly and by way of a wall out of sight. Its shading
/// normals are tilted by `leaning` radians.
Scene floor_beside_wall(double side, double leaning = 0.0) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.5}, {0, 0, -1}, {side, 0, 0}, {0, side, 0}};
    TriangleMesh floor;
    floor.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    floor.normals.assign(4, {std::sin(leaning), 0, std::cos(leaning)});
    maker.add(maker.mesh(floor), maker.material(matt({0.8, 0.8, 0.8})));
    maker.add(rectangle({1, -1, 0}, {0, 0, 2}, {0, 2, 0}), maker.material(matt({0.9, 0.6, 0.3})));
    maker.light(PointLight{.position = {0, 0, 1}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    return maker.compile();
}

/// All samples see the same photons in the same light: pixels differ by their lookups alone.
TEST(PhotonLooks, OfNeighbouringPixelsAreAsMany) {
    const Scene scene = floor_beside_wall(1e-6);
    const std::string renderer = "photon_mapping:photons=4000,caustics=0,nearest=50,every=";
    constexpr int kSide = 16;
    const double even = picture_of(scene, renderer + "1", kSide, 1).at(0, 0).g;
    const double without =
        picture_of(scene, "photon_mapping:photons=4000,caustics=0,nearest=50,depth=1", kSide, 1)
            .at(0, 0)
            .g;
    const double by_photons = even - without;
    ASSERT_GT(by_photons, 0.02 * even);
    for (const int every : {2, 4, 8}) {
        for (const int samples : {1, 2, 4, 6, 8, 12, 24}) {
            const Film film = picture_of(scene, renderer + std::to_string(every), kSide, samples);
            double sum = 0.0;
            const int fewest = samples / every, most = (samples + every - 1) / every;
            for (int i = 0; i < kSide * kSide; ++i) {
                const double lookups =
                    (film.at(i % kSide, i / kSide).g - without) / by_photons * samples / every;
                EXPECT_GT(lookups, fewest - 0.01) << every << ", " << samples << " samples";
                EXPECT_LT(lookups, most + 0.01) << every << ", " << samples << " samples";
                sum += lookups / (kSide * kSide);
            }
            // Four standard errors of the random count of each pixel.
            const double share = double(samples) / every - fewest;
            EXPECT_NEAR(sum, double(samples) / every,
                        4.0 * std::sqrt(share * (1.0 - share)) / kSide + 0.01)
                << every << ", " << samples << " samples";
        }
    }
}

TEST(PhotonLooks, InTurnFillTheIrradianceCacheAsAll) {
    const Scene scene = floor_beside_wall(1.8);
    const Illumination lights(scene);
    const Film film(32, 32, {0, 0, 32, 32});
    const RenderJob job = with_plan({.scene = scene, .camera = scene.cameras[0].camera});
    PhotonMappingSettings settings;
    settings.photons = 2000;
    settings.gather = 16;
    settings.cache = 0.03;
    const PhotonMaps maps = make_photon_maps(job, lights, settings);
    RayCounters counters;
    const IrradianceCache all = filled_cache(job, film, lights, maps, settings, counters);
    settings.paths.every = 8;
    const IrradianceCache in_turn = filled_cache(job, film, lights, maps, settings, counters);
    EXPECT_GT(all.size(), 50u);
    EXPECT_EQ(in_turn.size(), all.size());
    int known = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 point{(i % 20 - 9.5) / 11, (i / 20 - 9.5) / 11, 0};
        const auto a = all.irradiance(point, {0, 0, 1}), b = in_turn.irradiance(point, {0, 0, 1});
        ASSERT_EQ(a.has_value(), b.has_value()) << i;
        if (!a) continue;
        ++known;
        EXPECT_EQ(a->max(), b->max()) << i;
    }
    EXPECT_GT(known, 200);
}

/// A slab of glass at normal incidence: the radiance behind it is 1, the reflected one 3.
constexpr double kMirrored = 0.04;
constexpr double kTwoSides = 2 * kMirrored / (1 + kMirrored);  ///< mirror, again and again
constexpr double kThroughSlab = (1 - kTwoSides) + 3 * kTwoSides;
Scene slab_of_glass() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 1}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    maker.add(BoxShape{{-9, -9, -1}, {9, 9, 0}}, maker.material(testing::smooth_glass(1.5)));
    maker.add(rectangle({-9, -9, -2}, {18, 0, 0}, {0, 18, 0}),
              maker.material(testing::shining({1, 1, 1})));
    maker.add(rectangle({-9, -9, 2}, {18, 0, 0}, {0, 18, 0}),
              maker.material(testing::shining({3, 3, 3})));
    return maker.compile();
}

/// The mean of the pixels' values, and their standard deviation.
struct PixelValues {
    double mean = 0, deviation = 0;
};
PixelValues pixels_of(const Scene& scene, const std::string& renderer, int samples) {
    constexpr int kSide = 32;
    const Film film = picture_of(scene, renderer, kSide, samples);
    PixelValues values;
    for (int i = 0; i < kSide * kSide; ++i) {
        values.mean += film.at(i % kSide, i / kSide).g / (kSide * kSide);
    }
    for (int i = 0; i < kSide * kSide; ++i) {
        const double apart = film.at(i % kSide, i / kSide).g - values.mean;
        values.deviation += apart * apart / (kSide * kSide);
    }
    values.deviation = std::sqrt(values.deviation);
    return values;
}

TEST(DimWaysAtGlass, InTurnAreTheSameForAllPixels) {
    const Scene scene = slab_of_glass();
    for (const std::string renderer : {"photon_mapping:photons=10,caustics=0,split=0.3",
                                       "sppm:photons=10,radius=0.1,split=0.3"}) {
        const double by_chance = pixels_of(scene, renderer + ",turns=1", 16).deviation;
        const double in_turn = pixels_of(scene, renderer + ",turns=16", 16).deviation;
        EXPECT_GT(by_chance, 0.08) << renderer;
        EXPECT_LT(in_turn, 0.15 * by_chance) << renderer;
    }
}

/// The reflected surface ends within the pixels, or moves while the shutter is open: turns cover
/// the whole pixel and the whole time.
TEST(DimWaysAtGlass, SeeAllOfThePixelAndOfTheTime) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 1}, {0, 0, -1}, {1e-3, 0, 0}, {0, 1e-3, 0}};
    maker.add(BoxShape{{-9, -9, -1}, {9, 9, 0}}, maker.material(testing::smooth_glass(1.5)));
    // One of the 32 columns of pixels is cut in half.
    maker.add(rectangle({-9, -9, 2}, {9 + 0.5e-3 / 32, 0, 0}, {0, 18, 0}),
              maker.material(testing::shining({3, 3, 3})));
    const Scene still = maker.compile();
    const Film film = picture_of(still, "photon_mapping:photons=10,caustics=0,split=0.3", 32, 256);
    for (int y = 0; y < 32; ++y) {
        EXPECT_NEAR(film.at(16, y).g, 3 * kTwoSides / 2, 0.7 * 3 * kTwoSides / 2) << y;
    }
    maker.add(rectangle({-9, -9, 1.5}, {18, 0, 0}, {0, 18, 0}), maker.material(matt({0, 0, 0})));
    auto& part = maker.description().objects[0].parts.back();
    part.motion = std::make_shared<const PartMotion>(PartMotion{
        {}, {{0, Affine{}}, {0.4999, Affine{}}, {0.5001, Affine::translate({0, 40, 0})}}, {}});
    open_shutter(maker.description(), {0, 1});
    const PixelValues moving =
        pixels_of(maker.compile(), "sppm:photons=10,radius=0.1,split=0.3", 256);
    const PixelValues drawn =
        pixels_of(maker.compile(), "sppm:photons=10,radius=0.1,split=0.3,turns=1", 256);
    EXPECT_LT(moving.deviation, 1.3 * drawn.deviation);
}

TEST(DimWaysAtGlass, CountAsOftenAsTheirShare) {
    const Scene scene = slab_of_glass();
    for (const char* turns : {"1", "2", "4", "8", "16"}) {
        for (const char* split : {"0.01", "0.1", "0.3", "1"}) {
            for (const int samples : {1, 3, 16}) {
                const std::string renderer =
                    std::string("photon_mapping:photons=10,caustics=0,split=") + split +
                    ",turns=" + turns;
                // Every day about a third of them.
                const std::size_t number =
                    testing::number_of(renderer + " " + std::to_string(samples));
                if (!testing::is_tried(number, 3)) continue;
                const PixelValues seen = pixels_of(scene, renderer, samples);
                // Four standard errors; all samples of a pixel may miss the rarest branches.
                EXPECT_NEAR(seen.mean, kThroughSlab, 4.0 * seen.deviation / 32 + 0.001)
                    << renderer << ", " << samples << " samples";
            }
        }
    }
}

/// A light in glass is equally bright if its branch is followed in turn or always.
TEST(DimWaysAtGlass, AreHeldByClampAsOften) {
    const Scene scene = slab_of_glass();
    const std::string renderer = "photon_mapping:photons=10,caustics=0,clamp=0.05,split=";
    const double always = pixels_of(scene, renderer + "0.01", 16).mean;
    EXPECT_NEAR(pixels_of(scene, renderer + "0.3", 16).mean, always, 0.01);
    EXPECT_GT(always, 0.1);
    EXPECT_LT(always, 0.2);
}

/// A ceiling lit by two lights, seen directly or in a mirror.
Scene ceiling_with_lamps(bool in_mirror) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.5}, {0, 0, in_mirror ? -1.0 : 1.0}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    Material mirror;
    mirror.reflective.color = {0.8, 0.8, 0.8};
    maker.add(rectangle({-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0}), maker.material(mirror));
    maker.add(rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), maker.material(matt({0.5, 0.5, 0.5})));
    const MaterialId lamp = maker.material(testing::shining({1, 1, 1}));
    maker.add(rectangle({0.2, -1, 0.3}, {1, 0, 0}, {0, 2, 0}), lamp);
    maker.add(rectangle({-1, -0.5, 0.6}, {0.5, 0, 0}, {0, 1, 0}), lamp);
    // Occludes half of the second light.
    maker.add(rectangle({-1, -0.5, 0.7}, {0.9, 0, 0}, {0, 0.5, 0}),
              maker.material(matt({0, 0, 0})));
    return maker.compile();
}

TEST(ShadowRays, AreAsManyAsAsked) {
    for (const bool in_mirror : {false, true}) {
        const Scene scene = ceiling_with_lamps(in_mirror);
        for (const std::string renderer : {"photon_mapping:photons=10,caustics=0,depth=2",
                                           "sppm:photons=10,radius=0.01,depth=2"}) {
            const PixelValues one = pixels_of(scene, renderer + ",shadows=1", 1);
            const PixelValues eight = pixels_of(scene, renderer + ",shadows=8", 1);
            EXPECT_GT(one.mean, 0.02) << renderer;
            EXPECT_NEAR(eight.mean, one.mean, 4.0 * one.deviation / 32) << renderer;
            // Stratified: a smaller deviation than that of independent samples.
            EXPECT_LT(eight.deviation, 0.3 * one.deviation) << renderer;
        }
    }
}

/// Russian roulette after `roulette` scatterings does not end bright paths.
TEST(BrightWays, DoNotEndByChance) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 0.5}, {0, 0, -1}, {1e-6, 0, 0}, {0, 1e-6, 0}};
    Material mirror;
    mirror.reflective.color = {0.8, 0.8, 0.8};
    maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), maker.material(mirror));
    maker.add(rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}),
              maker.material(testing::shining({1, 1, 1})));
    const Scene scene = maker.compile();
    const std::string renderer = "photon_mapping:photons=10,caustics=0,roulette=0,split=";
    const PixelValues bright = pixels_of(scene, renderer + "0.7", 1);
    EXPECT_NEAR(bright.mean, 0.8, 1e-6);
    EXPECT_NEAR(bright.deviation, 0.0, 1e-6);
    const PixelValues dim = pixels_of(scene, renderer + "0.9", 1);
    EXPECT_NEAR(dim.mean, 0.8, 4.0 * dim.deviation / 32);
    EXPECT_GT(dim.deviation, 0.1);
}

double largest_difference(const Film& a, const Film& b) {
    double most = 0.0;
    for (int i = 0; i < 64; ++i) {
        const Rgb& x = a.at(i % 8, i / 8);
        const Rgb& y = b.at(i % 8, i / 8);
        most = std::max({most, std::abs(x.r - y.r), std::abs(x.g - y.g), std::abs(x.b - y.b)});
    }
    return most;
}

/// Irradiance at photons uses the geometric normal.
TEST(IrradianceAtPhotons, IsNotForOtherNormalsOfShading) {
    const std::string renderer = "photon_mapping:photons=4000,caustics=0,nearest=50,irradiance=";
    const auto difference = [&](double leaning) {
        const Scene scene = floor_beside_wall(1.8, leaning);
        return largest_difference(picture_of(scene, renderer + "on", 8, 4),
                                  picture_of(scene, renderer + "off", 8, 4));
    };
    EXPECT_GT(difference(0.0), 0.0);
    EXPECT_EQ(difference(0.3), 0.0);
    EXPECT_EQ(difference(-0.1), 0.0);
}

TEST(IrradianceAtPhotons, NeedsFourPhotons) {
    for (const char* few : {"2", "3"}) {
        const std::string nearest = std::string("photon_mapping:nearest=") + few;
        EXPECT_NO_THROW((void)make_renderer(nearest));
        try {
            (void)make_renderer(nearest + ",irradiance=on");
            ADD_FAILURE() << few;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage);
            EXPECT_NE(std::string(e.what()).find(std::string("nearest=") + few), std::string::npos);
        }
    }
    // Of four, two others count.
    const Scene scene = floor_beside_wall(1.8);
    const auto mean = [&](const std::string& irradiance) {
        return testing::mean_of(picture_of(
            scene,
            "photon_mapping:photons=8000,caustics=0,filter=disc,nearest=4,irradiance=" + irradiance,
            16, 4));
    };
    const double direct =
        testing::mean_of(picture_of(scene, "photon_mapping:photons=10,caustics=0,depth=1", 16, 4))
            .g;
    const double on = mean("on").g - direct, off = mean("off").g - direct;
    EXPECT_GT(off, 0.01);
    EXPECT_NEAR(on, off, 0.2 * off);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
