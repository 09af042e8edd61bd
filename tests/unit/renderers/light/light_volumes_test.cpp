#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "alhazen/renderers/volumes/media_finder.h"
#include "support/light_pictures.h"

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

constexpr double kIndex = 1.5;
/// Fresnel's reflectance of glass at normal incidence.
constexpr double kStraight = (kIndex - 1) * (kIndex - 1) / ((kIndex + 1) * (kIndex + 1));
/// As in TheThreeStrategiesAgreeOnThirteenScenes.
constexpr double kMost = 5.7;

Material glass(const Rgb& absorption, double index = kIndex) {
    Material m;
    m.dielectric = Dielectric{absorption};
    m.index.value = index;
    return m;
}

/// A wall of radiance 1 seen by parallel rays along -z.
SceneMaker wall_of_light() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        OrthographicCamera{{0, 0, 5}, {0, 0, -1}, {0.1, 0, 0}, {0, 0.1, 0}};
    maker.add(rectangle({-9, -9, -3}, {18, 0, 0}, {0, 18, 0}), maker.material(shining({1, 1, 1})));
    return maker;
}

/// Through a slab of transmittance t: both sides reflect, again and again.
double through_slab(double t) {
    return (1 - kStraight) * (1 - kStraight) * t / (1 - kStraight * kStraight * t * t);
}

TEST(LightVolumes, ASlabOfSixPartsShowsWhatASolidShows) {
    const double thick = 0.5, absorption = 1.2;
    const double expected = through_slab(std::exp(-absorption * thick));
    for (const bool of_parts : {false, true}) {
        SceneMaker maker = wall_of_light();
        const MaterialId slab = maker.material(glass({absorption, absorption, absorption}));
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
    maker.add(ball({0, 0, 0}, radius), maker.material(glass({absorption, absorption, absorption})));
    const Scene scene = maker.compile();
    // What is reflected comes back through the ball, twice reflected. Radiance is denser in glass.
    const double back = kStraight * kStraight * std::pow(t, 4);
    const double expected = kIndex * kIndex * (1 - kStraight) * t / (1 - back);
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
    for (const Material& material : {glass({absorption, absorption, absorption}, 1.0), gltf}) {
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
    expect_same_light(wide, "below a slab", {"path_tracing", "light_tracing", "bidirectional"}, 32,
                      kMost);
    expect_same_light(wide, "below a slab, merged", {"path_tracing", "vcm:photons=5000"}, 8, kMost);
}

/// Half of the eye rays begin in an absorbing block, half next to it.
TEST(LightVolumes, EachRayOfAParallelCameraBeginsInItsOwnVolume) {
    const double absorption = 0.7, way = 1;
    SceneMaker maker = wall_of_light();
    BoxShape block;
    block.lo = {0, -4, 5 - way};
    block.hi = {4, 4, 6};
    maker.add(block, maker.material(glass({absorption, absorption, absorption}, 1.0)));
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

/// A solid of two media side by side, at x below 0 and above.
struct TwoMedia {
    double lo, hi;  ///< ends along z
    std::array<double, 2> absorption;
};

/// Transmittance of a ray along -z. In an overlap the medium is that of the solid entered last, of
/// those entered together that of the one left first.
double through(const std::vector<TwoMedia>& solids, std::size_t side) {
    std::vector<double> ends;
    for (const TwoMedia& s : solids) ends.insert(ends.end(), {s.lo, s.hi});
    std::sort(ends.begin(), ends.end());
    double lost = 0;
    for (std::size_t i = 1; i < ends.size(); ++i) {
        const double z = (ends[i - 1] + ends[i]) / 2;
        const TwoMedia* innermost = nullptr;
        for (const TwoMedia& s : solids) {
            if (z < s.lo || z > s.hi) continue;
            if (innermost == nullptr ||
                std::pair(s.hi, -s.lo) < std::pair(innermost->hi, -innermost->lo)) {
                innermost = &s;
            }
        }
        if (innermost != nullptr) lost += innermost->absorption[side] * (ends[i] - ends[i - 1]);
    }
    return std::exp(-lost);
}

/// Solids of several media one before the other in any order: touching, nested, overlapping, with
/// ends that coincide; of the same materials or of others.
TEST(LightVolumes, SolidsOfSeveralMediaAreLeftEachByItself) {
    const std::array<double, 2> x{1, 0.5}, y{0.1, 0.7}, z{0.4, 0.2};
    const std::vector<TwoMedia> cases[] = {
        {{-1, 0, x}, {0, 1, x}},
        {{-1, 0, x}, {0, 1, y}},
        {{-1, 0.5, x}, {0, 1, x}},
        {{-1, 0.3, y}, {0, 1, x}},
        {{-1, 1, x}, {-0.5, 0.5, x}},
        {{-1, 1, x}, {-0.5, 0.5, y}},
        {{-1, 1, x}, {0, 1, y}},
        {{-1, 1, x}, {-1, 0.5, y}},
        {{-1, 0.3, x}, {0, 1, x}, {-0.5, 0.6, x}},
        {{-1, 0.3, x}, {0, 1, y}, {-0.5, 0.6, z}},
        {{-2, -1, x}, {-1, 0, y}, {0, 1, z}},
    };
    for (const std::vector<TwoMedia>& solids : cases) {
        std::vector<std::size_t> order(solids.size());
        std::iota(order.begin(), order.end(), 0);
        do {
            SceneMaker maker = wall_of_light();
            maker.description().conventions.shading.max_depth = 20;
            maker.description().conventions.shading.optics = {true, true};
            std::map<double, MaterialId> materials;
            for (const std::size_t i : order) {
                const ObjectIndex solid = maker.object("solid");
                maker.description().objects.back().combine = Combine::Union;
                for (const std::size_t side : {0, 1}) {
                    const double a = solids[i].absorption[side];
                    if (materials.count(a) == 0) {
                        materials[a] = maker.material(glass({a, a, a}, 1.0));
                    }
                    maker.add(BoxShape{{side == 0 ? -4.0 : 0.0, -4, solids[i].lo},
                                       {side == 0 ? 0.0 : 4.0, 4, solids[i].hi}},
                              materials[a], {}, solid);
                }
                maker.add(solid);
            }
            const Scene scene = maker.compile();
            const std::string name =
                ::testing::PrintToString(order) + " of case " + std::to_string(&solids - &cases[0]);
            for (const char* renderer :
                 {"path_tracing", "bidirectional", "sppm:photons=10,radius=0.1",
                  "photon_mapping:photons=10,caustics=0", "vcm:photons=10,radius=0.1,pilot=off",
                  "whitted", "distributed"}) {
                const Film film = picture_of(scene, renderer, 4, 4);
                for (const int column : {0, 3}) {
                    EXPECT_NEAR(film.at(column, 0).g, through(solids, column == 0 ? 0 : 1), 1e-9)
                        << renderer << " " << column << ", order " << name;
                }
            }
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

/// A floor below a point light and solids of several media: two that touch, two of the same media
/// that overlap, one in another.
TEST(LightVolumes, PathsFromBothEndsCrossSolidsOfSeveralMediaAlike) {
    SceneMaker maker = floor_from_above(4.0, {0.5, 0.5, 0.5});
    const auto medium = [&](double a) { return maker.material(glass({a, a, a}, 1.0)); };
    const MaterialId a = medium(1), b = medium(0.3), c = medium(0.1), d = medium(0.6);
    const auto add = [&](double lo, double hi, MaterialId left, MaterialId right) {
        const ObjectIndex solid = maker.object("solid");
        maker.description().objects.back().combine = Combine::Union;
        maker.add(BoxShape{{-9, -9, lo}, {0, 9, hi}}, left, {}, solid);
        maker.add(BoxShape{{0, -9, lo}, {9, 9, hi}}, right, {}, solid);
        maker.add(solid);
    };
    add(1.0, 1.4, a, b);
    add(1.2, 1.6, a, b);
    add(1.6, 1.9, c, d);
    add(1.9, 2.6, b, a);
    add(2.1, 2.4, d, c);
    maker.light(PointLight{.position = {0, 0, 3}, .color = {1, 1, 1}});
    const Scene scene = maker.compile();
    expect_same_light(scene, "solids", {"path_tracing", "light_tracing", "bidirectional"}, 32,
                      kMost);
    expect_same_light(scene, "solids, merged", {"path_tracing", "vcm:photons=5000"}, 8, kMost);
}

/// Two touching solids of several glasses of one index are a block, whichever is named first.
TEST(LightVolumes, TouchingSolidsOfSeveralGlassesAreABlock) {
    for (const bool lower_first : {false, true}) {
        SceneMaker maker = wall_of_light();
        maker.description().conventions.shading.max_depth = 20;
        maker.description().conventions.shading.optics = {true, true};
        for (const bool lower : {lower_first, !lower_first}) {
            const ObjectIndex solid = maker.object("solid");
            maker.description().objects.back().combine = Combine::Union;
            const double a = lower ? 1.5 : 0.5, z = lower ? -1 : 0;
            for (const double x : {-4.0, 0.0}) {
                maker.add(BoxShape{{x, -4, z}, {x + 4, 4, z + 1}}, maker.material(glass({a, a, a})),
                          {}, solid);
            }
            maker.add(solid);
        }
        const Scene scene = maker.compile();
        for (const char* renderer : {"path_tracing", "bidirectional", "whitted"}) {
            EXPECT_NEAR(mean_of(picture_of(scene, renderer, 4, 1024)).g,
                        through_slab(std::exp(-2.0)), 0.002)
                << renderer << lower_first;
        }
    }
}

/// Two instances of one object that overlap, in an object that is instanced itself, above a floor:
/// shadow rays meet the upper instance last.
TEST(LightVolumes, InstancesOfASolidOfSeveralMediaAreLeftEachByItself) {
    for (const double shift : {0.5, 1.0, 1.5}) {
        const auto lit_floor = [&](bool covered, bool grouped) {
            SceneMaker maker = floor_from_above(0.2, {1, 1, 1});
            const ObjectIndex solid = maker.object("solid");
            maker.description().objects.back().combine = Combine::Union;
            const MaterialId a = maker.material(glass({1, 1, 1}, 1.0));
            const MaterialId b = maker.material(glass({0.5, 0.5, 0.5}, 1.0));
            maker.add(BoxShape{{-9, -9, 1}, {9, 9, 2}}, a, {}, solid);
            maker.add(BoxShape{{-9, -9, 2}, {9, 9, 3}}, b, {}, solid);
            const ObjectIndex both = grouped ? maker.object("both") : ObjectIndex{0};
            if (covered) {
                maker.add(solid, MaterialId{0}, {}, both);
                maker.add(solid, MaterialId{0}, Affine::translate({0, 0, shift}), both);
                if (grouped) maker.add(both, MaterialId{0}, Affine::translate({0, 0, 0.25}));
            }
            maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
            maker.description().conventions.shading.optics = {true, true};
            return maker.compile();
        };
        // The lower one alone from 1 to 1 + shift, then the upper one.
        const double below = std::min(shift, 1.0) + 0.5 * std::max(shift - 1.0, 0.0);
        const double expected = std::exp(-below - 1.0 - 0.5);
        const Scene clear = lit_floor(false, false);
        for (const bool grouped : {false, true}) {
            const Scene scene = lit_floor(true, grouped);
            for (const char* renderer :
                 {"path_tracing", "sppm:photons=10,radius=0.1",
                  "photon_mapping:photons=10,caustics=0", "whitted", "distributed"}) {
                const double open = mean_of(picture_of(clear, renderer, 2, 4)).g;
                EXPECT_NEAR(mean_of(picture_of(scene, renderer, 2, 4)).g / open, expected, 1e-4)
                    << renderer << " " << shift << grouped;
            }
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
            maker.add(BoxShape{{-4, -4, 2}, {4, 4, 3}}, maker.material(glass({}, 1.0)));
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
    maker.add(ball({0, 0, high}, radius), maker.material(glass({absorption, 0, absorption})));
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
    const double matt_floor = falls * 100 * (lamp / high) * (lamp / high) * (1 - kStraight);
    const Rgb seen = mean_of(picture_of(scene, "light_tracing", 4, 1 << 14));
    EXPECT_NEAR(seen.g, matt_floor, 0.03 * matt_floor);
    EXPECT_NEAR(seen.r / seen.g, t, 0.01 * t);
}

TEST(LightVolumes, TheMediaAroundAPointAreFound) {
    SceneMaker maker;
    maker.add(ball({0, 0, 0}, 2), maker.material(glass({}, 1.3)));
    maker.add(ball({0, 0, 0}, 1), maker.material(glass({}, 1.6)));
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
    maker.add(rectangle({-9, -9, 1}, {18, 0, 0}, {0, 18, 0}), maker.material(glass({}, 1.3)));
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
    Material frosted = glass({0.5, 0.1, 0.9});
    frosted.roughness.value = 0.4;
    const std::vector<std::string> both{"path_tracing:depth=7", "bidirectional:depth=7"};
    expect_same_light(room(glass({0.5, 0.1, 0.9})), "clear glass", both, 32, kMost);
    expect_same_light(room(frosted), "frosted glass", both, 32, kMost);
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
                      24, kMost);
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
