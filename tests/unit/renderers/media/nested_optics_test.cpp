// Exact optics along the normal of a stack of layers, with a bubble, and in air of any index.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "alhazen/renderers/whitted/whitted.h"
#include "support/scene_maker.h"
#include "unit/renderers/one_pixel.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::center;
using testing::expect_near;
using testing::glowing;
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

struct Layer {
    double index, absorption = 0, thickness = 0;
};
/// The share of the light that passes all layers, with the geometric series of the reflections
/// between them; the first and the last layer are the surroundings.
double passed(const std::vector<Layer>& layers) {
    double through = 1.0, back = 0.0;  // of the layers so far; `back`: seen from behind
    for (std::size_t i = 1; i < layers.size(); ++i) {
        const double m = layers[i - 1].index, n = layers[i].index;
        const double r = std::pow((m - n) / (m + n), 2.0);
        const double orders = 1.0 / (1.0 - back * r);
        through *= (1.0 - r) * orders;
        back = r + (1.0 - r) * (1.0 - r) * back * orders;
        const double left = std::exp(-layers[i].absorption * layers[i].thickness);
        through *= left;
        back *= left * left;
    }
    return through;
}

/// Surroundings without light, seen from above the origin, and a light below.
SceneMaker above_a_light(double air) {
    SceneMaker maker;
    ShadingConventions& c = maker.description().conventions.shading;
    c.optics = {true, true};
    c.max_depth = 24;
    c.air_index = air;
    maker.description().cameras[0].camera =
        look_along({0.1, 0.2, 10}, {0, 0, -1}, {0, 1, 0}, 1e-9, 1.0);
    maker.add(Rectangle{{-50, -50, -20}, {100, 0, 0}, {0, 100, 0}},
              maker.material(glowing({1, 1, 1})));
    return maker;
}

void expect_passed(SceneMaker& maker, const std::vector<Layer>& layers) {
    const double t = passed(layers);
    expect_near(center(maker.compile()), {t, t, t}, 1e-9);
}

TEST(NestedOptics, ABubbleOfIndexOneReflects) {
    for (const double index : {1.0, 1.0001, 0.9}) {
        SceneMaker maker = above_a_light(1.0);
        maker.add(cube(3), maker.material(clear(kGlass, 0.1)));
        maker.add(cube(2), maker.material(clear(index, 0)));
        expect_passed(maker, {{1}, {kGlass, 0.1, 1}, {index}, {kGlass, 0.1, 1}, {1}});
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

TEST(NestedOptics, PhysicalMaterialsReflectByTheIndexOfTheAir) {
    for (const double air : {1.0, 1.0003, kWater, kGlass, 1.7}) {
        SceneMaker maker = above_a_light(air);
        maker.add(cube(3), maker.material(clear(kGlass, 0.1)));
        expect_passed(maker, {{air}, {kGlass, 0.1, 6}, {air}});
    }
    SceneMaker maker = above_a_light(kWater);
    maker.add(cube(3), maker.material(clear(1, 0)));
    expect_passed(maker, {{kWater}, {1}, {kWater}});
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
