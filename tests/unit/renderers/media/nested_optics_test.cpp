// Exact optics along the normal of a stack of layers, with a bubble, and in air of any index.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"
#include "unit/renderers/media/layers.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_light_passed;
using testing::expect_near;
using testing::SceneMaker;

constexpr double kGlass = 1.5, kWater = 1.333;

Material clear(double index, double absorption) {
    Material m;
    m.index.value = index;
    m.dielectric = Dielectric{{absorption, absorption, absorption}};
    return m;
}

BoxShape cube(double half) {
    return {{-half, -half, -half}, {half, half, half}};
}

/// In air of this index.
SceneMaker above_a_light(double air) {
    SceneMaker maker = testing::above_a_light();
    ShadingConventions& c = maker.description().conventions.shading;
    c.max_depth = 24;
    c.air_index = air;
    return maker;
}

TEST(NestedOptics, ABubbleOfIndexOneReflects) {
    for (const double index : {1.0, 1.0001, 0.9}) {
        SceneMaker maker = above_a_light(1.0);
        maker.add(cube(3), maker.material(clear(kGlass, 0.1)));
        maker.add(cube(2), maker.material(clear(index, 0)));
        expect_light_passed(maker, {{1}, {kGlass, 0.1, 1}, {index}, {kGlass, 0.1, 1}, {1}});
    }
}

TEST(NestedOptics, ABubbleReflectsTheShadowRay) {
    Material matt;
    matt.diffuse.color = {1, 1, 1};
    SceneMaker maker;
    maker.description().conventions.shading.optics = {true, true};
    maker.description().conventions.shading.max_depth = 0;
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
    maker.add(BoxShape{{-9, -9, -1}, {9, 9, 0}}, maker.material(matt));
    maker.add(BoxShape{{-9, -9, 10}, {9, 9, 13}}, maker.material(clear(kGlass, 0.1)));
    maker.add(BoxShape{{-8, -8, 11}, {8, 8, 12}}, maker.material(clear(1, 0)));
    const double left = std::pow(0.96, 4.0) * std::exp(-0.2);
    expect_near(center(maker.compile()), {left, left, left}, 1e-12);
}

/// A solid of two media, their wall at `middle`.
void add_two_media(SceneMaker& maker, double bottom, double middle, double top) {
    const ObjectIndex solid = maker.object("solid");
    maker.description().objects.back().combine = Combine::Union;
    maker.add(testing::box(bottom, middle), maker.material(clear(kGlass, 0.3)), {}, solid);
    maker.add(testing::box(middle, top), maker.material(clear(kGlass, 0.1)), {}, solid);
    maker.add(solid);
}

TEST(NestedOptics, AWallInABubbleOfIndexOneDoesNotReflect) {
    SceneMaker maker = above_a_light(1.0);
    maker.description().conventions.shading.max_depth = 32;
    add_two_media(maker, -1, 0, 1);
    maker.add(testing::box(-0.5, 0.5), maker.material(clear(1, 0)));
    expect_light_passed(maker, {{1}, {kGlass, 0.1, 0.5}, {1}, {kGlass, 0.3, 0.5}, {1}});
}

TEST(NestedOptics, AVolumeLeftInsideABubbleOfIndexOneDoesNotReflect) {
    SceneMaker maker = above_a_light(1.0);
    maker.add(testing::box(0, 2), maker.material(clear(kGlass, 0.1)));
    maker.add(testing::box(-1, 1), maker.material(clear(1, 0)));
    expect_light_passed(maker, {{1}, {kGlass, 0.1, 1}, {1}});
}

TEST(NestedOptics, ShadowRaysPassAWallInABubbleOfIndexOneUnweakened) {
    Material matt;
    matt.diffuse.color = {1, 1, 1};
    SceneMaker maker;
    maker.description().conventions.shading.optics = {true, true};
    maker.description().conventions.shading.max_depth = 0;
    maker.light(DirectionalLight{.to_light = {0, 0, 1}, .color = {1, 1, 1}});
    maker.add(BoxShape{{-9, -9, -1}, {9, 9, 0}}, maker.material(matt));
    add_two_media(maker, 10, 11, 12);
    maker.add(testing::box(10.5, 11.5), maker.material(clear(1, 0)));
    const double left = std::pow(0.96, 4.0) * std::exp(-0.2);
    expect_near(center(maker.compile()), {left, left, left}, 1e-12);
}

TEST(NestedOptics, PhysicalMaterialsReflectByTheIndexOfTheAir) {
    for (const double air : {1.0, 1.0003, kWater, kGlass, 1.7}) {
        SceneMaker maker = above_a_light(air);
        maker.add(cube(3), maker.material(clear(kGlass, 0.1)));
        expect_light_passed(maker, {{air}, {kGlass, 0.1, 6}, {air}});
    }
    SceneMaker maker = above_a_light(kWater);
    maker.add(cube(3), maker.material(clear(1, 0)));
    expect_light_passed(maker, {{kWater}, {1}, {kWater}});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
