#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "alhazen/renderers/bidirectional/path_weight.h"
#include "alhazen/renderers/core/renderer.h"
#include "alhazen/renderers/light_transport/bsdf_cache.h"
#include "alhazen/renderers/light_transport/camera_lens.h"
#include "alhazen/renderers/volumes/medium_stack.h"
#include "alhazen/sampling/random.h"
#include "support/light_pictures.h"
#include "support/lit_rooms.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::add_lamp;
using testing::add_room;
using testing::ball;
using testing::expect_same_light;
using testing::floor_from_above;
using testing::matt;
using testing::mean_of;
using testing::picture_of;
using testing::rectangle;
using testing::SceneMaker;
using testing::shining;
constexpr double kPi = std::numbers::pi;

TEST(LightTransport, ASphereOfLightOverAFloorGivesItsFormFactor) {
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        SceneMaker maker = floor_from_above(0.2);
        Sphere lamp;
        lamp.center = {0, 0, 2};
        lamp.radius = 0.5;
        maker.add(lamp, maker.material(shining({8, 4, 2})));
        const Scene scene = maker.compile();
        const Rgb seen = mean_of(picture_of(scene, renderer, 4, 4096));
        // E / (pi L) = (r / d)^2, which hardly changes within the picture.
        EXPECT_NEAR(seen.r, 8 * 0.0625, 8 * 0.0625 * 0.02) << renderer;
        EXPECT_NEAR(seen.b / seen.r, 0.25, 1e-9) << renderer;
    }
}

// Scattered rays see the back of a single-sided light as black, consistent with sampling the light.
TEST(LightTransport, ASingleSidedLampShinesToItsFrontAlone) {
    for (const char* renderer :
         {"path_tracing", "path_tracing --spectral", "bidirectional", "light_tracing",
          "photon_mapping:photons=2000", "sppm:photons=2000", "vcm:photons=2000"}) {
        for (const bool down : {false, true}) {
            SceneMaker maker = floor_from_above(0.2);
            Material lamp = shining({8, 4, 2});
            lamp.double_sided = false;
            const Vec3 u{2, 0, 0}, v{0, 2, 0};
            maker.add(rectangle({-1, -1, 1}, down ? v : u, down ? u : v), maker.material(lamp));
            const Scene scene = maker.compile();
            const Rgb seen = mean_of(picture_of(scene, renderer, 4, 64));
            if (down) {
                EXPECT_GT(seen.b, 0.1) << renderer;
            } else {
                EXPECT_TRUE(seen.is_black()) << renderer << " " << seen.r;
            }
        }
    }
}

// A mirror sees the back of a surface that the eye does not.
TEST(LightTransport, UnlitSurfacesShowTheirColourOnBothSides) {
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        SceneMaker maker = floor_from_above(0.2);
        Material mirror;
        mirror.reflective.color = {0.9, 0.9, 0.9};
        maker.add(rectangle({-2, -2, 0.01}, {4, 0, 0}, {0, 4, 0}), maker.material(mirror));
        Material card;
        card.metallic_roughness.emplace();
        card.metallic_roughness->unlit = true;
        card.metallic_roughness->base_color.color = {0.2, 0.5, 0.8};
        card.double_sided = false;
        maker.add(rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), maker.material(card));
        const Rgb seen = mean_of(picture_of(maker.compile(), renderer, 4, 4));
        EXPECT_GT(seen.b, 0.1) << renderer;
    }
}

TEST(LightTransport, PunctualLightsShowWhatWhittedShows) {
    SceneMaker maker = floor_from_above(0.2, {0.5, 0.6, 0.7});
    maker.light(PointLight{.position = {1, 0, 2}, .color = {3, 3, 3}, .attenuation = {0, 0, 1}});
    maker.light(DirectionalLight{.to_light = {0, 0.6, 0.8}, .color = {0.2, 0.3, 0.4}});
    const Scene scene = maker.compile();
    const Rgb direct = mean_of(picture_of(scene, "whitted", 4, 64));
    const Rgb paths = mean_of(picture_of(scene, "path_tracing", 4, 256));
    EXPECT_NEAR(paths.r, direct.r, 0.01 * direct.r);
    EXPECT_NEAR(paths.b, direct.b, 0.01 * direct.b);
}

TEST(LightTransport, KeptBsdfsAreThoseOfTheirMaterials) {
    SceneMaker maker = floor_from_above(0.2);
    std::vector<MaterialId> ids;
    for (int i = 0; i < 50; ++i) {
        Material m;
        m.diffuse.color = {0.01 * i, 0.5, 0.3};
        if (i % 2 == 1) m.dielectric.emplace();
        m.index.value = 1.0 + 0.02 * i;
        ids.push_back(maker.material(m));
    }
    maker.description().textures.push_back({"", SolidTexture{}, {}});
    Material checked;
    checked.diffuse = {{1, 1, 1}, TextureId{0}};
    const MaterialId textured = maker.material(checked);
    const Scene scene = maker.compile();
    BsdfCache kept(scene);
    RandomStream random(4);
    const Vec3 view = normalize(Vec3{0.3, 0.2, 0.8});
    for (int n = 0; n < 2000; ++n) {
        const MaterialId id = ids[random.below(n % 3 == 0 ? 50 : 4)];
        const BsdfPlace place{.eta = random.below(2) == 0 ? 0.0 : 1.0 + 0.1 * (n % 4),
                              .from_inside = random.below(2) == 0};
        const Bsdf* const found = kept.find(id, place);
        ASSERT_NE(found, nullptr);
        const Bsdf made = bsdf_of(scene.materials[static_cast<std::size_t>(id)], {}, {}, place);
        const Vec2 u{random.uniform(), random.uniform()};
        const double choice = random.uniform();
        const auto drawn = found->sample(view, choice, u, Transport::Radiance);
        const auto own = made.sample(view, choice, u, Transport::Radiance);
        ASSERT_EQ(drawn.has_value(), own.has_value());
        if (!drawn) continue;
        EXPECT_EQ(drawn->direction, own->direction);
        EXPECT_EQ(drawn->weight, own->weight);
    }
    const Wavelengths waves = Wavelengths::drawn(0.5);
    EXPECT_EQ(kept.find(ids[0], {.waves = waves}), nullptr);
    const Spectrum etas = Spectrum::all(1.5);
    EXPECT_EQ(kept.find(ids[1], {.eta = 1.5, .etas = &etas}), nullptr);
    EXPECT_EQ(kept.find(textured, {}), nullptr);
}

/// A closed sphere of albedo a that glows with e shows e / (1 - a) everywhere.
TEST(LightTransport, AnIntegratingSphereShowsTheSumOfTheSeries) {
    SceneMaker maker;
    maker.description().cameras[0].camera = look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 1.0);
    Sphere around;
    around.radius = 3;
    maker.add(around, maker.material(shining({0.5, 0.5, 0.5}, {0.5, 0.2, 0.8})));
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        const Rgb seen = mean_of(picture_of(scene, renderer, 8, 256));
        EXPECT_NEAR(seen.r, 0.5 / (1 - 0.5), 0.01) << renderer;
        EXPECT_NEAR(seen.g, 0.5 / (1 - 0.2), 0.01) << renderer;
        EXPECT_NEAR(seen.b, 0.5 / (1 - 0.8), 0.03) << renderer;
    }
}

TEST(LightTransport, AnEvenSkyOverAMattFloorShowsItsAlbedo) {
    SceneMaker maker = floor_from_above(0.2, {0.25, 0.5, 1.0});
    maker.description().picture.background = Rgb{2, 2, 2};
    const Scene scene = maker.compile();
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        const Rgb seen = mean_of(picture_of(scene, renderer, 4, 256));
        EXPECT_NEAR(seen.r, 0.5, 0.01) << renderer;
        EXPECT_NEAR(seen.b, 2.0, 0.04) << renderer;
    }
}

/// The scenes on which all three must agree.
struct NamedScene {
    std::string name;
    Scene scene;
};

std::vector<NamedScene> scenes() {
    std::vector<NamedScene> all;
    const auto room = [&](const char* name, auto&& fill) {
        SceneMaker maker;
        add_room(maker, {0.7, 0.7, 0.7});
        fill(maker);
        all.push_back({name, maker.compile("wide_bvh")});
    };
    room("lamp", [](SceneMaker& m) { add_lamp(m, 0.3, {9, 8, 6}); });
    room("lamp and ball", [](SceneMaker& m) {
        add_lamp(m, 0.3, {9, 8, 6});
        m.add(ball({0.3, 0, 0.4}, 0.4), m.material(matt({0.8, 0.8, 0.2})));
    });
    room("sphere of light", [](SceneMaker& m) {
        m.add(ball({0.4, 0.2, 1.2}, 0.2), m.material(shining({5, 6, 7})));
    });
    room("point light", [](SceneMaker& m) {
        m.light(
            PointLight{.position = {0.3, -0.2, 1.5}, .color = {1, 1, 2}, .attenuation = {0, 0, 1}});
    });
    room("spot light", [](SceneMaker& m) {
        SpotLight spot;
        spot.position = {0, -0.5, 1.9};
        spot.direction = normalize(Vec3{0.2, 0.3, -1});
        spot.inner_angle = 0.4;
        spot.outer_angle = 0.7;
        spot.color = {3, 2, 1};
        spot.attenuation = {0, 0, 1};
        m.light(spot);
    });
    room("two lamps behind a screen", [](SceneMaker& m) {
        add_lamp(m, 0.2, {6, 6, 6});
        m.add(ball({-0.5, -0.2, 0.5}, 0.1), m.material(shining({20, 5, 1})));
        m.add(rectangle({-0.4, -0.4, 1.2}, {0.8, 0, 0}, {0, 0.8, 0}),
              m.material(matt({0.4, 0.4, 0.4})));
    });
    room("disc of light", [](SceneMaker& m) {
        Disc disc;
        disc.center = {0, 0.9, 1};
        disc.normal = {0, -1, 0};
        disc.radius = 0.4;
        m.add(disc, m.material(shining({4, 4, 4})));
    });
    room("mesh of light", [](SceneMaker& m) {
        m.add(m.mesh(testing::tetrahedron()), m.material(shining({9, 9, 3})),
              Affine::translate({0.2, 0.1, 1.1}) * Affine::scale({0.2, 0.2, 0.2}));
    });
    room("glowing wall", [](SceneMaker& m) {
        m.add(rectangle({-0.9, 0.95, 0.2}, {0.5, 0, 0}, {0, 0, 1.5}),
              m.material(shining({2, 3, 4}, {0.5, 0.5, 0.5})));
    });
    room("parallel plates", [](SceneMaker& m) {
        m.add(rectangle({-0.8, -0.8, 1.0}, {1.6, 0, 0}, {0, 1.6, 0}),
              m.material(matt({0.9, 0.9, 0.9})));
        m.add(rectangle({-0.5, -0.5, 0.5}, {0, 1, 0}, {1, 0, 0}), m.material(shining({3, 3, 3})));
    });
    room("instances of light", [](SceneMaker& m) {
        const ObjectIndex lamp = m.object("lamp");
        m.add(ball({0, 0, 0}, 0.1), m.material(shining({9, 6, 3})), {}, lamp);
        m.add(lamp, {}, Affine::translate({-0.5, 0, 1}));
        m.add(lamp, {}, Affine::translate({0.5, 0.2, 1.5}) * Affine::scale({1.5, 0.7, 1}));
    });
    room("pane before a lamp", [](SceneMaker& m) {
        add_lamp(m, 0.3, {9, 8, 6});
        Material pane;
        pane.metallic_roughness.emplace();
        pane.metallic_roughness->base_color.color = {0.9, 0.6, 0.5};
        pane.metallic_roughness->metallic.value = 0;
        pane.metallic_roughness->roughness.value = 0.6;
        pane.metallic_roughness->transmission.value = 0.5;
        pane.index.value = 1.5;
        m.add(rectangle({-0.7, -0.6, 1.1}, {1.4, 0, 0}, {0, 1.2, 0.2}), m.material(pane));
    });
    room("sun through the open side", [](SceneMaker& m) {
        m.light(DirectionalLight{.to_light = normalize(Vec3{0.2, -1, 0.8}), .color = {1, 1, 0.5}});
    });
    return all;
}

TEST(LightTransport, TheThreeStrategiesAgreeOnThirteenScenes) {
    for (const NamedScene& named : scenes()) {
        expect_same_light(
            named.scene, named.name,
            {"path_tracing:depth=5", "light_tracing:depth=5", "bidirectional:depth=5"}, 24);
    }
}

// The lamp covers the whole picture, and lights the floor below it.
TEST(LightTransport, ALampJustOverAFloorHidesItFromTheLens) {
    for (const char* renderer :
         {"path_tracing", "light_tracing", "bidirectional", "vcm:photons=200"}) {
        for (const double gap : {1e-4, 1e-9, 1e-11}) {
            SceneMaker maker = floor_from_above(0.2);
            maker.add(rectangle({-0.5, -0.5, gap}, {1, 0, 0}, {0, 1, 0}),
                      maker.material(shining({3, 2, 1})));
            const Rgb seen = mean_of(picture_of(maker.compile(), renderer, 4, 64));
            EXPECT_NEAR(seen.r, 3, 1e-12) << renderer << " " << gap;
            EXPECT_NEAR(seen.b, 1, 1e-12) << renderer << " " << gap;
        }
    }
}

/// A floor, a wall and a lamp; a sheet that halves the light at `sheet`, over all of its plane.
Scene room_with_sheet(double sheet) {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -4, 1.5}, {0, 4, -1.25}, {0, 0, 1}, 0.4, 1.0);
    const MaterialId white = maker.material(matt({0.7, 0.7, 0.7}));
    maker.add(rectangle({-2.5, -2.5, 0}, {5, 0, 0}, {0, 5, 0}), white);
    maker.add(rectangle({-2.5, 1.5, 0}, {5, 0, 0}, {0, 0, 4}), white);
    maker.add(rectangle({-0.5, -0.5, 1}, {1, 0, 0}, {0, 1, 0}), maker.material(shining({4, 4, 4})));
    Material half = testing::smooth_glass();
    half.metallic_roughness->thickness.value = 0;
    half.metallic_roughness->base_color.color = {0.5, 0.5, 0.5};
    half.index.value = 1.0;
    maker.add(rectangle({-2.5, -2.5, sheet}, {5, 0, 0}, {0, 5, 0}), maker.material(half));
    return maker.compile();
}

// Connections end before the lamp and the floor, but not before the sheets just below and above.
TEST(LightTransport, ASheetCloseToALampOrAFloorIsMet) {
    for (const char* renderer :
         {"path_tracing", "path_tracing --spectral", "bidirectional", "vcm:photons=200",
          "photon_mapping:photons=200,gather=2", "sppm:photons=200"}) {
        const auto seen_with = [&](double sheet) {
            return mean_of(picture_of(room_with_sheet(sheet), renderer, 4, 64)).g;
        };
        const double below_lamp = seen_with(1.0 - 1e-4), above_floor = seen_with(1e-4);
        for (const double gap : {1e-9, 1e-11}) {
            EXPECT_NEAR(seen_with(1.0 - gap), below_lamp, 2e-3 * below_lamp) << renderer;
            EXPECT_NEAR(seen_with(gap), above_floor, 2e-3 * above_floor) << renderer;
        }
    }
}

// The rays from the lens end before the floor that they connect to, also where they graze it.
TEST(LightTransport, AFarLensSeesAFloorFromASmallAngle) {
    for (const double slope : {1.0, 1e-1, 1e-2}) {
        SceneMaker maker;
        maker.add(rectangle({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}),
                  maker.material(matt({0.5, 0.5, 0.5})));
        maker.add(ball({0, 0, 3}, 0.5), maker.material(shining({8, 8, 8})));
        maker.description().cameras[0].camera =
            look_along(1e6 * Vec3{0.6, 0.8, slope}, Vec3{-0.6, -0.8, -slope}, {0, 0, 1}, 2e-6, 1.0);
        const Scene scene = maker.compile();
        const double wanted = mean_of(picture_of(scene, "path_tracing", 4, 1024)).r;
        const double found = mean_of(picture_of(scene, "light_tracing", 4, 1024)).r;
        EXPECT_NEAR(found / wanted, 1.0, 0.1) << slope;
    }
}

TEST(LightTransport, APlaneMirrorShowsTheLampBehindIt) {
    for (const char* renderer : {"path_tracing", "bidirectional"}) {
        SceneMaker maker = floor_from_above(0.02);
        Material lamp = shining({10, 10, 10});
        lamp.double_sided = false;
        maker.add(rectangle({-0.25, -0.25, 2}, {0, 0.5, 0}, {0.5, 0, 0}), maker.material(lamp));
        const Rgb without = mean_of(picture_of(maker.compile(), renderer, 2, 4096));
        Material mirror;
        mirror.reflective.color = {0.9, 0.9, 0.9};
        maker.add(rectangle({1, -5, 0}, {0, 10, 0}, {0, 0, 10}), maker.material(mirror));
        const Rgb with = mean_of(picture_of(maker.compile(), renderer, 2, 16384));
        // The light's image is 2 to the side: L A cos^2 / (pi d^2), over a small light.
        EXPECT_NEAR(without.r, 10 * 0.25 / (4 * kPi), 0.01) << renderer;
        EXPECT_NEAR(with.r - without.r, 0.9 * 10 * 0.25 * 0.5 / (8 * kPi), 0.003) << renderer;
    }
}

TEST(LightTransport, PicturesDependNeitherOnThreadsNorOnTiles) {
    SceneMaker maker;
    add_room(maker, {0.7, 0.7, 0.7});
    add_lamp(maker, 0.3, {9, 8, 6});
    Material glass;
    glass.transmissive.color = {0.9, 0.9, 0.9};
    glass.reflective.color = {0.1, 0.1, 0.1};
    glass.index.value = 1.5;
    maker.add(ball({0.3, 0, 0.4}, 0.4), maker.material(glass));
    const Scene scene = maker.compile("wide_bvh");
    for (const char* renderer :
         {"path_tracing", "light_tracing", "bidirectional", "ambient_occlusion"}) {
        const Film a = picture_of(scene, renderer, 16, 4, 7, 1, 32);
        const Film b = picture_of(scene, renderer, 16, 4, 7, 2, 5);
        for (int i = 0; i < 256; ++i) {
            EXPECT_EQ(a.at(i % 16, i / 16), b.at(i % 16, i / 16)) << renderer << " pixel " << i;
        }
    }
}

TEST(LightTransport, AmbientOcclusionOfAFloorBesideAHighWallIsOneHalf) {
    SceneMaker maker = floor_from_above(0.002);
    maker.add(rectangle({0.002, -900, 0}, {0, 1800, 0}, {0, 0, 900}));
    const Scene scene = maker.compile();
    const Rgb seen = mean_of(picture_of(scene, "ambient_occlusion:distance=10000", 2, 4096));
    EXPECT_NEAR(seen.r, 0.5, 0.01);
    EXPECT_EQ(mean_of(picture_of(scene, "ambient_occlusion:distance=0.0001", 2, 16)).g, 1.0);
}

TEST(PathWeight, TheWeightsOfAllStrategiesSumToOne) {
    RandomStream random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        WholePath path;
        const std::size_t m = 1 + random.below(6);
        for (std::size_t i = 0; i <= m; ++i) {
            path.vertices.push_back({std::exp(random.uniform(-3, 3)),
                                     std::exp(random.uniform(-3, 3)),
                                     i > 0 && random.uniform() < 0.2});
        }
        path.joined = random.uniform() < 0.1 ? 0.0 : std::exp(random.uniform(-3, 3));
        path.emitted = random.uniform() < 0.9;
        path.hit = random.uniform() < 0.9;
        double sum = 0.0;
        const auto singular = [&](std::size_t i) { return path.vertices[i].singular; };
        for (std::size_t s = 0; s <= m + 1; ++s) {
            const bool possible =
                s == 0   ? path.hit
                : s == 1 ? path.joined > 0.0 && !singular(1)
                         : path.emitted && !singular(s - 1) && (s == m + 1 || !singular(s));
            if (possible) sum += path_weight(path, static_cast<int>(s));
        }
        if (sum > 0.0) {
            EXPECT_NEAR(sum, 1.0, 1e-9) << trial;
        }
    }
}

TEST(LightTransport, PicturesGrowWithTheLightWhateverItsSize) {
    const auto seen = [](const char* renderer, double radiance) {
        SceneMaker maker;
        add_room(maker, {0.7, 0.7, 0.7});
        add_lamp(maker, 0.3, {radiance, radiance, radiance});
        return picture_of(maker.compile(), renderer, 4, 64);
    };
    for (const char* renderer :
         {"path_tracing", "light_tracing", "bidirectional", "vcm:photons=500"}) {
        const Film one = seen(renderer, 1.0);
        for (const double times : {0x1p-90, 0x1p35, 0x1p45, 0x1p90}) {
            const Film other = seen(renderer, times);
            for (int i = 0; i < 16; ++i) {
                const double expected = times * one.at(i % 4, i / 4).g;
                EXPECT_NEAR(other.at(i % 4, i / 4).g, expected, 1e-9 * expected)
                    << renderer << " " << times;
            }
        }
    }
}

TEST(MediumStack, VolumesAreLeftInAnyOrder) {
    MediumStack media;
    EXPECT_EQ(media.here(), nullptr);
    media.enter({1, 1.5, {}, 7});
    media.enter({2, 1.3, {}, 8});
    EXPECT_EQ(media.here()->index, 1.3);
    const Medium first{1, 1.5, {}, 7}, second{2, 1.3, {}, 8};
    EXPECT_EQ(media.without(second)->index, 1.5);
    EXPECT_EQ(media.without(first)->index, 1.3);
    media.leave(first);
    EXPECT_EQ(media.here()->index, 1.3);
    media.leave({9, 1.3, {}, 6});
    EXPECT_FALSE(media.empty());
    // Another part of the same boundary.
    media.leave({9, 1.3, {}, 8});
    EXPECT_TRUE(media.empty());
}

TEST(CameraLens, JoinsAPointWhereItsEyeRayStarted) {
    PerspectiveCamera camera = look_along({1, 2, 3}, {0.3, -0.2, -1}, {0, 1, 0}, 0.8, 1.5);
    camera.lens = {.radius = 0.2, .focus_distance = 4};
    const Camera cameras[] = {
        camera, OrthographicCamera{{0, 0, 5}, {0.1, 0, -1}, {3, 0, 0}, {0, 2, 0}},
        look_around({1, 2, 3}, {0.3, -0.2, -1}, {0, 1, 0}, WideProjection::Equidistant, 3.0, 1.2),
        look_around({1, 2, 3}, {0.3, -0.2, -1}, {0, 1, 0}, WideProjection::Equisolid, 2.5, 1.0),
        look_around({1, 2, 3}, {0.3, -0.2, -1}, {0, 1, 0}, WideProjection::Panorama, 3.0, 2.0)};
    SceneMaker empty;
    empty.add(Sphere{});
    const Scene scene = empty.compile();
    RandomStream random(3);
    for (const Camera& c : cameras) {
        const RenderJob job{.scene = scene, .camera = c};
        const CameraLens lens(job);
        const LensRays rays(c);
        for (int i = 0; i < 200; ++i) {
            const Vec2 film{random.uniform(), random.uniform()},
                u{random.uniform(), random.uniform()};
            const Ray ray = rays.through(eye_ray(c, film.x, film.y), u);
            const Vec3 point = ray.at(random.uniform(0.5, 9));
            const auto joined = lens.connect(point, u, 0.0);
            ASSERT_TRUE(joined);
            EXPECT_NEAR(joined->film.x, film.x, 1e-9);
            EXPECT_NEAR(joined->film.y, film.y, 1e-9);
            EXPECT_NEAR(dot(joined->to_lens, ray.direction), -1.0, 1e-12);
            if (!lens.is_parallel()) {
                EXPECT_NEAR(joined->density * joined->distance * joined->distance,
                            lens.direction_density(ray.direction, 0.0),
                            1e-9 * lens.direction_density(ray.direction, 0.0));
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
