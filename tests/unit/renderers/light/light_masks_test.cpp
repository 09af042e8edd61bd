// Parts that only some kinds of rays see, in renderers of light transport.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/light_pictures.h"
#include "support/show_last_to.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ball;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
using testing::show_last_to;

constexpr RayMask kNoShadow = kRaysOfAllKinds & ~mask_of(RayKind::Shadow);

/// A point of light in a ball that casts no shadows.
Scene point_in_a_ball(const Material& surface) {
    SceneMaker maker = floor_from_above(2, {0.8, 0.5, 0.3});
    maker.add(rectangle({-1.2, 1, 0}, {2.4, 0, 0}, {0, 0, 2}), maker.material(matt({0.3, 0.5, 1})));
    maker.light(PointLight{.position = {0, 0, 1}, .color = {1, 1, 1}, .attenuation = {0, 0, 1}});
    maker.add(ball({0, 0, 1}, 0.2), maker.material(surface));
    show_last_to(maker, kNoShadow);
    return maker.compile();
}

TEST(LightMasks, APointOfLightShinesThroughASurfaceThatCastsNoShadows) {
    Material clear;
    clear.transmissive.color = {1, 1, 1};
    for (const Material& surface : {shining({1, 0.8, 0.5}), clear}) {
        const Scene scene = point_in_a_ball(surface);
        expect_same_light(scene, "point in a ball",
                          {"path_tracing", "light_tracing", "bidirectional"}, 64);
        const double light = mean_of(picture_of(scene, "path_tracing", 8, 256)).g;
        ASSERT_GT(light, 0.1);
        for (const std::string renderer :
             {"vcm:photons=500,radius=0.05,pilot=off", "sppm:photons=500,radius=0.1",
              "photon_mapping:photons=20000,nearest=50"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, 64)).g, light, 0.03 * light)
                << renderer;
        }
    }
}

TEST(LightMasks, IndirectLightIsTheSameForAllStrategies) {
    // A large ball without shadow hides the floor from the lit walls.
    SceneMaker maker = floor_from_above(1.2, {0.8, 0.8, 0.8});
    maker.add(rectangle({-1, -1, 0}, {0, 2, 0}, {0, 0, 2}), maker.material(matt({0.9, 0.9, 0.9})));
    maker.add(rectangle({1, -1, 0}, {0, 2, 0}, {0, 0, 2}), maker.material(matt({0.9, 0.9, 0.9})));
    maker.light(PointLight{.position = {0, 0, 3}, .color = {9, 9, 9}, .attenuation = {0, 0, 1}});
    maker.add(ball({0, 0, 0.8}, 0.7), maker.material(matt({0.1, 0.1, 0.1})));
    show_last_to(maker, kNoShadow & ~mask_of(RayKind::Eye));
    expect_same_light(maker.compile(), "ball without shadow",
                      {"path_tracing", "light_tracing", "bidirectional"}, 96);
}

TEST(LightMasks, TheSurfaceOfALightIsInTheWayOfOtherLight) {
    SceneMaker maker = floor_from_above(1.2, {0.8, 0.5, 0.3});
    maker.add(rectangle({-0.8, -0.8, 0.9}, {0, 1.6, 0}, {1.6, 0, 0}),
              maker.material(shining({0.3, 0.2, 0.1})));
    show_last_to(maker, kLightSurfaceMask);
    maker.description().environment = EnvironmentDescription{};
    const Scene scene = maker.compile();
    expect_same_light(scene, "lamp under a sky", {"path_tracing", "light_tracing", "bidirectional"},
                      128);
    const double light = mean_of(picture_of(scene, "path_tracing", 8, 256)).g;
    for (const std::string renderer :
         {"vcm:photons=500,radius=0.05,pilot=off", "sppm:photons=500,radius=0.1",
          "photon_mapping:photons=20000,nearest=50"}) {
        EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, 64)).g, light, 0.03 * light) << renderer;
    }
}

TEST(LightMasks, AllStrategiesAgreeForEveryMask) {
    for (RayMask mask = 1; mask <= kRaysOfAllKinds; ++mask) {
        if (!testing::is_tried(mask, 3)) continue;
        // A slope over one half of the floor, lit from above and from the floor beside it.
        SceneMaker maker = floor_from_above(1.2, {0.8, 0.5, 0.3});
        maker.add(rectangle({-0.5, -0.5, 0.05}, {0.6, 0, 0.3}, {0, 1, 0}),
                  maker.material(matt({0.4, 0.6, 0.9})));
        show_last_to(maker, mask);
        maker.light(
            PointLight{.position = {0.5, 0, 2}, .color = {4, 4, 4}, .attenuation = {0, 0, 1}});
        const Scene scene = maker.compile();
        const std::string name = "mask " + std::to_string(mask);
        expect_same_light(scene, name, {"path_tracing", "light_tracing", "bidirectional"}, 48);
        const double light = mean_of(picture_of(scene, "path_tracing", 8, 256)).g;
        for (const std::string renderer :
             {"vcm:photons=500,radius=0.05,pilot=off", "sppm:photons=500,radius=0.05"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, 128)).g, light, 0.02 * light)
                << name << " " << renderer;
        }
    }
}

TEST(LightMasks, AWallWithoutShadowIsLitByLightPaths) {
    // The red light of the wall reaches the floor by light paths that land on the wall.
    SceneMaker maker = floor_from_above(2, {0.8, 0.8, 0.8});
    maker.add(rectangle({-1.5, 0.5, 0}, {3, 0, 0}, {0, 0, 2}),
              maker.material(matt({0.95, 0.05, 0.05})));
    show_last_to(maker, kNoShadow);
    maker.light(PointLight{.position = {0, -1, 2}, .color = {9, 9, 9}, .attenuation = {0, 0, 1}});
    const Scene scene = maker.compile();
    expect_same_light(scene, "wall", {"path_tracing", "light_tracing", "bidirectional"}, 64);
}

// Connections pass the near side of a sphere that casts no shadow: its inner side shines out of it.
TEST(LightMasks, ASphereOfLightWithoutShadowShowsBothOfItsSides) {
    // The mean over a square of side 2 below the centre is the square's solid angle, over its area.
    const double once = 8 * 0.25 * std::asin(0.2);
    for (const bool two_sided : {true, false}) {
        for (const bool instanced : {false, true}) {
            SceneMaker maker = floor_from_above(2);
            Material surface = shining({8, 4, 2});
            surface.double_sided = two_sided;
            const MaterialId material = maker.material(surface);
            if (instanced) {
                const ObjectIndex lamp = maker.object("lamp");
                maker.add(ball({0, 0, 0}, 0.25), material, {}, lamp);
                maker.add(lamp, {}, Affine::translate({0, 0, 2}) * Affine::scale({2, 2, 2}));
            } else {
                maker.add(ball({0, 0, 2}, 0.5), material);
            }
            show_last_to(maker, kNoShadow);
            const Scene scene = maker.compile("wide_bvh");
            const double light = two_sided ? 2 * once : once;
            for (const std::string renderer :
                 {"path_tracing", "path_tracing --spectral", "bidirectional", "light_tracing",
                  "vcm:photons=2000,pilot=off", "sppm:photons=2000",
                  "photon_mapping:photons=2000"}) {
                const int samples = renderer == "light_tracing" ? 1024 : 64;
                EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, samples)).r, light, 0.04 * light)
                    << renderer << (two_sided ? ", two-sided" : "")
                    << (instanced ? ", instanced" : "");
            }
        }
    }
}

// Rays that scatter at the floor find them: they meet the near side of a ball, and what hides it.
TEST(LightMasks, LightLeftToChanceIsWhatReflectedRaysMeet) {
    const double once = 8 * 0.25 * std::asin(0.2);
    enum class Lamp { Superellipsoid, Solid, Moving };
    const struct {
        RayMask lamp, screen;
        double light;
    } cases[] = {
        {kNoShadow, mask_of(RayKind::Eye), once},
        {kAllRays, mask_of(RayKind::Shadow), once},
        {kAllRays, kNoShadow, 0.0},
    };
    for (const Lamp lamp : {Lamp::Superellipsoid, Lamp::Solid, Lamp::Moving}) {
        for (const auto& c : cases) {
            SceneMaker maker = floor_from_above(2);
            const MaterialId material = maker.material(shining({8, 4, 2}));
            if (lamp == Lamp::Superellipsoid) {
                maker.add(Superellipsoid{.center = {0, 0, 2},
                                         .axis_a = {0.5, 0, 0},
                                         .axis_b = {0, 0.5, 0},
                                         .axis_c = {0, 0, 0.5}},
                          material);
            } else if (lamp == Lamp::Solid) {
                const ObjectIndex solid = maker.object("solid");
                maker.description().objects.back().combine = Combine::Union;
                maker.add(ball({0, 0, 2}, 0.5), material, {}, solid);
                maker.add(solid);
            } else {
                maker.add(ball({0, 0, 2}, 0.5), material);
                maker.description().objects[0].parts.back().motion =
                    std::make_shared<const PartMotion>(
                        PartMotion{{}, {{0, Affine{}}, {1, Affine::translate({0, 0, 1e-9})}}, {}});
            }
            show_last_to(maker, c.lamp);
            maker.add(rectangle({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}),
                      maker.material(matt({0, 0, 0})));
            show_last_to(maker, c.screen);
            const Scene scene = maker.compile("wide_bvh");
            for (const std::string renderer : {"path_tracing", "bidirectional"}) {
                EXPECT_NEAR(mean_of(picture_of(scene, renderer, 8, 512)).r, c.light, 0.04 * once)
                    << renderer << ", lamp " << static_cast<int>(lamp) << ", case " << &c - cases;
            }
        }
    }
}

TEST(LightMasks, TheSurfaceOfALightDoesNotOccludeAmbientLight) {
    const auto seen = [](RayMask mask) {
        SceneMaker maker = floor_from_above(1.2);
        maker.add(rectangle({-1, -1, 0.9}, {0, 2, 0}, {2, 0, 0}),
                  maker.material(shining({1, 1, 1})));
        show_last_to(maker, mask);
        return mean_of(picture_of(maker.compile(), "ambient_occlusion", 8, 16)).g;
    };
    EXPECT_EQ(seen(kLightSurfaceMask), seen(kNoShadow));
    EXPECT_LT(seen(kRaysOfAllKinds), 0.9 * seen(kLightSurfaceMask));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
