// Solids from which parts of another transparent material are subtracted: the walls have the
// surface of that material and bound the medium that is there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/light_pictures.h"
#include "unit/renderers/media/layers.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::above_a_light;
using testing::box;
using testing::center;
using testing::expect_light_passed;
using testing::expect_near;
using testing::glowing;
using testing::Layer;
using testing::physical;
using testing::picture_of;
using testing::SceneMaker;

/// A bound of the paths with more than 16 faces, which are left out.
constexpr double kLeftOut = 1e-6;

const Layer kAir{1}, kA{1.5, 0.1, 1}, kB{1.7, 0.3, 1};

/// The same medium by the parameters of glTF.
Material by_roughness(const Layer& layer) {
    Material m = testing::smooth_glass(layer.index);
    const double left = std::exp(-layer.absorption);
    m.metallic_roughness->attenuation_distance = 1;
    m.metallic_roughness->attenuation_color = {left, left, left};
    return m;
}

ObjectIndex solid(SceneMaker& maker, Combine combine) {
    const ObjectIndex object = maker.object("solid");
    maker.description().objects.back().combine = combine;
    return object;
}

/// A block from z = 0 to 3 with a cavity from 1 to 2; `fill`: of the material of its walls.
SceneMaker hollow(const Material& block, const Material& wall, bool fill = false) {
    SceneMaker maker = above_a_light();
    const MaterialId a = maker.material(block), b = maker.material(wall);
    const ObjectIndex cut = solid(maker, Combine::Difference);
    maker.add(box(0, 3), a, {}, cut);
    maker.add(box(1, 2, 2), b, {}, cut);
    maker.add(cut);
    if (fill) maker.add(box(1, 2, 2), b);
    return maker;
}

TEST(CutWalls, ACavityIsEmptyWhateverItsWallsAreMadeOf) {
    for (const auto block : {&physical, &by_roughness}) {
        for (const auto wall : {&physical, &by_roughness}) {
            SceneMaker maker = hollow(block(kA), wall(kB));
            expect_light_passed(maker, {kAir, kA, {1, 0, 1}, kA, kAir}, kLeftOut);
        }
    }
}

TEST(CutWalls, APartThatFillsACavityTouchesItsWalls) {
    SceneMaker maker = hollow(physical(kA), physical(kB), true);
    expect_light_passed(maker, {kAir, kA, kB, kA, kAir}, kLeftOut);
}

TEST(CutWalls, AThinWallBoundsItsVolume) {
    Material sheet = by_roughness(kB);
    sheet.metallic_roughness->thickness.value = 0;
    SceneMaker maker = hollow(physical(kA), sheet);
    expect_light_passed(maker, {kAir, kA, {1, 0, 1}, kA, kAir}, kLeftOut);
}

TEST(CutWalls, ARayThatStartsInACavityIsInAir) {
    SceneMaker maker = hollow(physical(kA), physical(kB));
    maker.description().cameras[0].camera =
        look_along({0.1, 0.2, 1.5}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
    // Reflections return from the block above, those of the cavity among them.
    const double r = 0.04, way = std::exp(-0.1);
    const double back = r + (1 - r) * (1 - r) * way * way * r / (1 - r * r * way * way);
    const double through = (1 - r) * (1 - r) * way / (1 - r * r * way * way);
    const double t = through / (1 - back * back);
    expect_near(center(maker.compile()), {t, t, t}, 1e-6);
}

TEST(CutWalls, DifferencesOfDifferencesLeaveTheMediumThatIsThere) {
    // a from 0 to 5, without what is left of b from 1 to 4 after c from 2 to 3: a stays there.
    const Layer c{1.3, 0.2, 1};
    SceneMaker maker = above_a_light();
    const ObjectIndex outer = solid(maker, Combine::Difference),
                      inner = solid(maker, Combine::Difference);
    maker.add(box(0, 5), maker.material(physical(kA)), {}, outer);
    maker.add(box(1, 4, 2), maker.material(physical(kB)), {}, inner);
    maker.add(box(2, 3, 1), maker.material(physical(c)), {}, inner);
    maker.add(inner, MaterialId{0}, {}, outer);
    maker.add(outer);
    expect_light_passed(maker, {kAir, kA, {1, 0, 1}, kA, {1, 0, 1}, kA, kAir}, 1e-4);
}

TEST(CutWalls, InstancedSolidsAreCutAndCut) {
    for (const bool subtracted : {false, true}) {
        SceneMaker maker = above_a_light();
        const MaterialId a = maker.material(physical(kA)), b = maker.material(physical(kB)),
                         c = maker.material(physical({1.3, 0.2, 1}));
        // Two users: the solid is instanced, the second time far away.
        const ObjectIndex shell = solid(maker, Combine::Difference),
                          outer = solid(maker, Combine::Difference);
        maker.add(box(0, 3), a, {}, shell);
        maker.add(box(1, 2, 2), b, {}, shell);
        if (subtracted) maker.add(box(-1, 4, 4), c, {}, outer);
        maker.add(shell, MaterialId{0}, {}, outer);
        if (!subtracted) maker.add(box(2.5, 4), c, {}, outer);
        maker.add(outer);
        maker.add(shell, MaterialId{0}, Affine::translate({90, 0, 0}));
        const Layer cut{1.5, 0.1, 0.5}, gap{1, 0, 1}, left{1.3, 0.2, 1};
        if (subtracted) {
            expect_light_passed(maker, {kAir, left, gap, left, gap, left, kAir}, kLeftOut);
        } else {
            expect_light_passed(maker, {kAir, cut, gap, kA, kAir}, kLeftOut);
        }
    }
}

TEST(CutWalls, TheSymmetricDifferenceOfTwoGlassesIsEmptyWhereBothAre) {
    SceneMaker maker = above_a_light();
    const MaterialId a = maker.material(physical(kA)), b = maker.material(physical(kB));
    const ObjectIndex both = solid(maker, Combine::Union);
    for (const bool first : {true, false}) {
        const ObjectIndex one = solid(maker, Combine::Difference);
        maker.add(first ? box(0, 2) : box(1, 3), first ? a : b, {}, one);
        maker.add(first ? box(1, 3) : box(0, 2), first ? b : a, {}, one);
        maker.add(one, MaterialId{0}, {}, both);
    }
    maker.add(both);
    expect_light_passed(maker, {kAir, kB, {1, 0, 1}, kA, kAir}, kLeftOut);
}

/// Pictures of a hollow block, from above, with walls of its own material and of another.
TEST(CutWalls, RenderersSeeTheSameThroughSmoothWallsOfAnyMaterial) {
    const auto scene = [](const Layer& wall, bool fill) {
        SceneMaker maker;
        maker.description().conventions.shading.optics = {true, true};
        maker.description().cameras[0].camera =
            look_along({1, -2, 9}, {-1, 2, -8}, {0, 1, 0}, 0.5, 1.0);
        maker.add(Rectangle{{-2, -2, -1}, {4, 0, 0}, {0, 4, 0}},
                  maker.material(glowing({3, 2, 1})));
        const MaterialId a = maker.material(physical(kA)), b = maker.material(physical(wall)),
                         c = maker.material(physical({1.2, 0.5}));
        const ObjectIndex cut = solid(maker, Combine::Difference);
        maker.add(Sphere{{0, 0, 2}, 2}, a, {}, cut);
        maker.add(Sphere{{0.2, 0, 2}, 1.2}, b, {}, cut);
        maker.add(cut);
        if (fill) maker.add(Sphere{{0.2, 0, 2}, 1.2}, c);
        return maker.compile();
    };
    for (const bool fill : {false, true}) {
        const Scene own = scene(kA, fill), other = scene(kB, fill);
        for (const std::string renderer :
             {"whitted", "distributed", "path_tracing", "bidirectional", "vcm:photons=500"}) {
            const Film first = picture_of(own, renderer, 8, 4);
            const Film second = picture_of(other, renderer, 8, 4);
            double whole = 0.0;
            for (int i = 0; i < 64; ++i) {
                const Rgb x = first.at(i % 8, i / 8), y = second.at(i % 8, i / 8);
                whole += x.r;
                expect_near(x, y, 1e-9 * (1 + x.max()));
            }
            EXPECT_GT(whole, 1.0) << renderer;
        }
    }
}

TEST(CutWalls, AWallKeepsTheColourAndRoughnessOfItsMaterial) {
    Material wall = by_roughness(kB);
    wall.metallic_roughness->base_color.color = {0.5, 0.25, 1};
    SceneMaker maker = hollow(physical(kA), wall);
    const Rgb tinted = center(maker.compile());
    EXPECT_NEAR(tinted.g / tinted.r, 0.25, 0.02);
    EXPECT_NEAR(tinted.b / tinted.r, 4.0, 0.3);
    Material rough = physical(kB);
    rough.roughness.value = 0.5;
    const Scene scene = hollow(physical(kA), rough).compile();
    const Ray ray{{0, 0, 1.5}, {0, 0, -1}};
    Hit hit;
    ASSERT_TRUE(scene.aggregate->closest(ray, hit, {nullptr}));
    const Surface surface = surface_at(*scene.aggregate, ray, hit);
    ASSERT_TRUE(surface.volume);
    EXPECT_EQ(scene.materials[static_cast<std::size_t>(*surface.volume)].index.value, 1.5);
    EXPECT_EQ(scene.material_of(surface).roughness.value, 0.5);
    EXPECT_EQ(scene.material_of(surface).index.value, 1.5);
}

TEST(CutWalls, OpaqueAndEqualMaterialsStateNoVolume) {
    Material stone;
    stone.diffuse.color = {1, 1, 1};
    for (const auto& [block, wall] :
         {std::pair{physical(kA), stone}, std::pair{stone, physical(kB)}}) {
        EXPECT_TRUE(hollow(block, wall).compile().walls.empty());
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
