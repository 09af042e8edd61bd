#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "alhazen/renderers/volumes/media_finder.h"
#include "support/light_pictures.h"
#include "unit/renderers/light/glass_volumes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::absorbing_glass;
using testing::ball;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::kGlassIndex;
using testing::kGlassReflectance;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
using testing::through_slab;
using testing::wall_of_light;

TEST(LightVolumes, ASlabOfSixPartsShowsWhatASolidShows) {
    const double thick = 0.5, absorption = 1.2;
    const double expected = through_slab(std::exp(-absorption * thick));
    for (const bool of_parts : {false, true}) {
        SceneMaker maker = wall_of_light();
        const MaterialId slab =
            maker.material(absorbing_glass({absorption, absorption, absorption}));
        const Vec3 lo{-4, -4, 0}, x{8, 0, 0}, y{0, 8, 0}, z{0, 0, thick};
        if (of_parts) {
            maker.add(rectangle(lo, y, x), slab);
            maker.add(rectangle(lo + z, x, y), slab);
            maker.add(rectangle(lo, x, z), slab);
            maker.add(rectangle(lo + y, z, x), slab);
            maker.add(rectangle(lo, z, y), slab);
            maker.add(rectangle(lo + x, y, z), slab);
        } else {
            BoxShape box;
            box.lo = lo;
            box.hi = lo + x + y + z;
            maker.add(box, slab);
        }
        const Scene scene = maker.compile();
        for (const char* renderer : {"path_tracing", "bidirectional"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 1024)).g, expected, 0.01)
                << renderer << (of_parts ? " of six parts" : " of one");
        }
    }
}

TEST(LightVolumes, AnEyeInGlassLooksThroughIt) {
    const double radius = 2, absorption = 0.4, t = std::exp(-absorption * radius);
    SceneMaker maker = wall_of_light();
    maker.description().cameras[0].camera = look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.02, 1.0);
    maker.add(ball({0, 0, 0}, radius),
              maker.material(absorbing_glass({absorption, absorption, absorption})));
    const Scene scene = maker.compile();
    // What is reflected comes back through the ball, twice reflected. Radiance is denser in glass.
    const double back = kGlassReflectance * kGlassReflectance * std::pow(t, 4);
    const double expected = kGlassIndex * kGlassIndex * (1 - kGlassReflectance) * t / (1 - back);
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 512)).g, expected, 0.01) << renderer;
    }
}

/// A floor below a grey slab of the index of the air, and a point light above it.
TEST(LightVolumes, APointLightShinesThroughASlabThatDoesNotRefract) {
    const double absorption = 0.8, thick = 0.75, expected = std::exp(-absorption * thick);
    const auto lit_floor = [&](bool covered, const Material& material, double side = 0.01) {
        SceneMaker maker = floor_from_above(side, {0.5, 0.5, 0.5});
        if (covered) {
            maker.add(BoxShape{{-9, -9, 1}, {9, 9, 1 + thick}}, maker.material(material));
        }
        maker.light(PointLight{.position = {0, 0, 3}, .color = {1, 1, 1}});
        return maker.compile();
    };
    Material gltf = testing::smooth_glass(1.0);
    gltf.metallic_roughness->attenuation_color = Rgb{1, 1, 1} * std::exp(-absorption);
    gltf.metallic_roughness->attenuation_distance = 1;
    const Scene clear = lit_floor(false, {});
    for (const Material& material :
         {absorbing_glass({absorption, absorption, absorption}, 1.0), gltf}) {
        const Scene scene = lit_floor(true, material);
        for (const char* renderer :
             {"path_tracing", "path_tracing:depth=1", "path_tracing:manifold=on",
              "path_tracing --spectral", "photon_mapping:photons=1000", "sppm:photons=1000"}) {
            const double open = mean_of(picture_of(clear, renderer, 2, 4)).g;
            EXPECT_GT(open, 0.1) << renderer;
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 2, 4)).g / open, expected, 1e-4)
                << renderer;
        }
    }
    const Scene wide = lit_floor(true, gltf, 4.0);
    expect_same_light(wide, "below a slab", {"path_tracing", "light_tracing", "bidirectional"}, 32);
    expect_same_light(wide, "below a slab, merged", {"path_tracing", "vcm:photons=5000"}, 8);
}

/// Half of the eye rays begin in an absorbing block, half next to it.
TEST(LightVolumes, EachRayOfAParallelCameraBeginsInItsOwnVolume) {
    const double absorption = 0.7, way = 1;
    SceneMaker maker = wall_of_light();
    BoxShape block;
    block.lo = {0, -4, 5 - way};
    block.hi = {4, 4, 6};
    maker.add(block, maker.material(absorbing_glass({absorption, absorption, absorption}, 1.0)));
    const Scene scene = maker.compile();
    for (const char* renderer :
         {"path_tracing", "bidirectional", "photon_mapping:photons=10,caustics=0",
          "sppm:photons=10,radius=0.1", "vcm:photons=10,radius=0.1,pilot=off"}) {
        const Film film = picture_of(scene, renderer, 4, 64);
        for (int i = 0; i < 16; ++i) {
            const double expected = i % 4 < 2 ? 1.0 : std::exp(-absorption * way);
            EXPECT_NEAR(film.at(i % 4, i / 4).g, expected, 1e-9) << renderer << " " << i;
        }
    }
}

/// A ball that eye rays see, behind a sheet and a block that are passed straight.
TEST(LightVolumes, WhatAnEyeRayPassesStraightLeavesItAnEyeRay) {
    Material sheet = testing::smooth_glass(1.0);
    sheet.metallic_roughness->thickness.value = 0;
    sheet.metallic_roughness->specular.value = 0;
    for (const bool of_sheet : {true, false}) {
        SceneMaker maker = wall_of_light();
        maker.add(ball({0, 0, 0}, 0.5), maker.material(shining({3, 3, 3})));
        maker.description().objects[0].parts.back().visible_to = mask_of(RayKind::Eye);
        if (of_sheet) {
            maker.add(rectangle({-4, -4, 2}, {8, 0, 0}, {0, 8, 0}), maker.material(sheet));
        } else {
            maker.add(BoxShape{{-4, -4, 2}, {4, 4, 3}}, maker.material(absorbing_glass({}, 1.0)));
        }
        const Scene scene = maker.compile();
        for (const char* renderer : {"path_tracing", "bidirectional", "photon_mapping:photons=10",
                                     "sppm:photons=10,radius=0.1"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 4)).g, 3.0, 1e-9)
                << renderer << of_sheet;
        }
    }
}

TEST(LightVolumes, ALampInGlassShinesThroughIt) {
    // A small light in the middle of a ball: its rays meet the glass at normal incidence.
    const double radius = 0.5, lamp = 0.02, absorption = 1.5, high = 2;
    constexpr double kSide = 1.5;
    SceneMaker maker = floor_from_above(kSide);
    maker.add(ball({0, 0, high}, lamp), maker.material(shining({100, 100, 100})));
    maker.add(ball({0, 0, high}, radius),
              maker.material(absorbing_glass({absorption, 0, absorption})));
    const Scene scene = maker.compile();
    // Mean over the matt light's directions of exp(-absorption * way), with r = radius: way =
    // sqrt(r^2 - b^2) - lamp cos, b = lamp sin.
    double t = 0;
    constexpr int kAngles = 256;
    for (int i = 0; i < kAngles; ++i) {
        const double squared = (i + 0.5) / kAngles;  // of the cosine: even for matt surfaces
        const double b = lamp * std::sqrt(1 - squared);
        const double way = std::sqrt(radius * radius - b * b) - lamp * std::sqrt(squared);
        t += std::exp(-absorption * way) / kAngles;
    }
    // Reflected light ends at the black light, except for oblique rays that miss it.
    double falls = 0;  // mean of the cube of the cosine over the picture
    constexpr int kGrid = 64;
    for (int i = 0; i < kGrid * kGrid; ++i) {
        const double x = kSide * ((i % kGrid + 0.5) / kGrid - 0.5);
        const double y = kSide * ((i / kGrid + 0.5) / kGrid - 0.5);
        falls += std::pow(1 + (x * x + y * y) / (high * high), -1.5) / (kGrid * kGrid);
    }
    const double matt_floor = falls * 100 * (lamp / high) * (lamp / high) * (1 - kGlassReflectance);
    const Rgb seen = mean_of(picture_of(scene, "light_tracing", 4, 1 << 14));
    EXPECT_NEAR(seen.g, matt_floor, 0.03 * matt_floor);
    EXPECT_NEAR(seen.r / seen.g, t, 0.01 * t);
}

TEST(LightVolumes, TheMediaAroundAPointAreFound) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 2), maker.material(absorbing_glass({}, 1.3)));
    maker.add(ball({0, 0, 0}, 1), maker.material(absorbing_glass({}, 1.6)));
    maker.add(rectangle({-9, -9, 0.1}, {18, 0, 0}, {0, 18, 0}), maker.material(matt({1, 1, 1})));
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    ASSERT_TRUE(finder.has_volumes());
    EXPECT_TRUE(finder.around({5, 0, 0}, 0).empty());
    ASSERT_FALSE(finder.around({1.5, 0, 0}, 0).empty());
    EXPECT_EQ(finder.around({1.5, 0, 0}, 0).here()->index, 1.3);
    ASSERT_FALSE(finder.around({0.2, 0.1, 0}, 0).empty());
    EXPECT_EQ(finder.around({0.2, 0.1, 0}, 0).here()->index, 1.6);
    EXPECT_TRUE(finder.around({0, 0, -3}, 0).empty());
}

/// Water that is a sheet alone reaches down without end.
TEST(LightVolumes, AreFoundBelowAnOpenSheet) {
    SceneMaker maker;
    maker.add(rectangle({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}),
              maker.material(absorbing_glass({}, 1.3)));
    const Scene scene = maker.compile();
    const MediaFinder finder(scene);
    ASSERT_FALSE(finder.around({0, 0, 0.5}, 0).empty());
    EXPECT_EQ(finder.around({0, 0, 0.5}, 0).here()->index, 1.3);
    EXPECT_TRUE(finder.around({0, 0, 1.5}, 0).empty());
}

/// Light focused by glass, found by paths that hit the light by chance and by other paths.
TEST(LightVolumes, PathsAgreeOnGlassInARoom) {
    const auto room = [](const Material& of_ball) {
        SceneMaker maker;
        const MaterialId white = maker.material(matt({0.7, 0.7, 0.7}));
        maker.description().cameras[0].camera =
            look_along({0, -3.8, 1}, {0, 1, 0}, {0, 0, 1}, 0.65, 1.0);
        maker.add(rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), white);
        maker.add(rectangle({-1, 1, 0}, {2, 0, 0}, {0, 0, 2}), white);
        maker.add(rectangle({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}),
                  maker.material(shining({1, 2, 3}, {0.5, 0.5, 0.5})));
        maker.add(ball({0.1, 0, 0.7}, 0.5), maker.material(of_ball));
        return maker.compile();
    };
    Material frosted = absorbing_glass({0.5, 0.1, 0.9});
    frosted.roughness.value = 0.4;
    const std::vector<std::string> both{"path_tracing:depth=7", "bidirectional:depth=7"};
    expect_same_light(room(absorbing_glass({0.5, 0.1, 0.9})), "clear glass", both, 32);
    expect_same_light(room(frosted), "frosted glass", both, 32);
}

TEST(LightVolumes, ASingleSidedSurfaceBlocksLightFromBothSides) {
    for (const bool turned : {false, true}) {
        SceneMaker maker = floor_from_above(0.2);
        maker.add(ball({0, 0, 3}, 0.5), maker.material(shining({9, 9, 9})));
        Material one_sided = matt({0.8, 0.8, 0.8});
        one_sided.double_sided = false;
        const Vec3 x{20, 0, 0}, y{0, 20, 0};
        maker.add(rectangle({-10, -10, 1}, turned ? x : y, turned ? y : x),
                  maker.material(one_sided));
        const Scene scene = maker.compile();
        for (const char* renderer : {"path_tracing", "light_tracing", "bidirectional"}) {
            EXPECT_EQ(mean_of(picture_of(scene, renderer, 4, 64)).g, 0.0) << renderer << turned;
        }
    }
}

TEST(LightVolumes, TheEyeSeesThroughTheBackOfASingleSidedSurface) {
    SceneMaker maker = floor_from_above(0.2);
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 4}, {0, 0, -1}, {0.2, 0, 0}, {0, 0.2, 0}};
    maker.add(ball({1, 0, 1}, 0.3), maker.material(shining({9, 9, 9})));
    Material ceiling = matt({0.8, 0.8, 0.8});
    ceiling.double_sided = false;
    maker.add(rectangle({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}), maker.material(ceiling));
    const Scene scene = maker.compile("wide_bvh");
    EXPECT_GT(mean_of(picture_of(scene, "path_tracing", 4, 64)).g, 0.3);
    expect_same_light(scene, "under a ceiling", {"path_tracing", "light_tracing", "bidirectional"},
                      24);
}

TEST(LightVolumes, TheSunShinesOnEndlessPlanes) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{500, 0, 5}, {0, 0, -1}, {2, 0, 0}, {0, 2, 0}};
    maker.add(Plane{{0, 0, 0}, {0, 0, 1}}, maker.material(matt({0.5, 0.5, 0.5})));
    maker.add(ball({0, 0, 1}, 1), maker.material(matt({0.5, 0.5, 0.5})));
    maker.description().picture.background = Rgb{0.2, 0.3, 0.4};
    maker.light(DirectionalLight{.to_light = {0, 0.6, 0.8}, .color = {1, 1, 1}});
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        const Rgb seen = mean_of(picture_of(scene, renderer, 4, 256));
        EXPECT_NEAR(seen.r, 0.5 * (0.8 + 0.2), 0.005) << renderer;
        EXPECT_NEAR(seen.b, 0.5 * (0.8 + 0.4), 0.008) << renderer;
    }
}

TEST(LightVolumes, LightsThatDoNotFallAreTheSameForAllStrategies) {
    for (const Attenuation& falloff : {Attenuation{1, 0, 0}, Attenuation{0.5, 0.25, 0}}) {
        SceneMaker maker = floor_from_above(2, {0.5, 0.6, 0.7});
        maker.light(
            PointLight{.position = {0.5, 0, 2}, .color = {2, 3, 4}, .attenuation = falloff});
        SpotLight spot;
        spot.position = {-0.5, 0, 1.5};
        spot.direction = {0, 0, -1};
        spot.inner_angle = 0.3;
        spot.outer_angle = 0.6;
        spot.color = {4, 3, 2};
        spot.attenuation = falloff;
        maker.light(spot);
        const Scene scene = maker.compile();
        const Rgb direct = mean_of(picture_of(scene, "whitted", 4, 64));
        for (const char* renderer : {"path_tracing", "light_tracing", "bidirectional"}) {
            const Rgb seen = mean_of(picture_of(scene, renderer, 4, 1 << 13));
            EXPECT_NEAR(seen.r, direct.r, 0.02 * direct.r) << renderer;
            EXPECT_NEAR(seen.b, direct.b, 0.02 * direct.b) << renderer;
        }
    }
}

TEST(LightVolumes, WhatLightTracingCannotSampleIsSaid) {
    SceneMaker maker = floor_from_above(0.2);
    Torus ring;
    maker.add(ring, maker.material(shining({1, 1, 1})));
    const Scene scene = maker.compile();
    const SamplingPlan plan;
    Film film(2, 2, {0, 0, 2, 2});
    const RenderJob job{.scene = scene, .camera = scene.cameras[0].camera, .sampling = &plan};
    EXPECT_EQ(make_renderer("light_tracing")->render(job, film).notes.size(), 1u);
    EXPECT_TRUE(make_renderer("path_tracing")->render(job, film).notes.empty());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
