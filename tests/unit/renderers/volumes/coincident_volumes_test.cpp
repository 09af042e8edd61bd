// Faces of volumes that coincide with each other or with an opaque surface are one boundary,
// whichever part is named first.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/light_pictures.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

/// Whose paths scatter that often at most: boundaries of clear volumes count.
std::string eye_paths(int depth) {
    return "path_tracing:depth=" + std::to_string(depth);
}
std::vector<std::string> renderers(int depth, const std::string& name) {
    return to_compare({eye_paths(depth), "bidirectional:depth=" + std::to_string(depth),
                       "vcm:photons=100,radius=0.06,pilot=off,depth=" + std::to_string(depth)},
                      name);
}
constexpr int kFew = 6, kMany = 64;

/// A camera that looks obliquely down at the region below a light.
SceneMaker below_a_lamp() {
    SceneMaker maker;
    maker.description().cameras[0].camera =
        look_along({0, -3.5, 2}, {0, 3.5, -1.4}, {0, 0, 1}, 0.6, 1.0);
    maker.add(rectangle({-1.5, -1.5, 2}, {0, 3, 0}, {3, 0, 0}), maker.material(shining({2, 2, 2})));
    return maker;
}
/// Adds a light in the left one of two volumes that touch: light passes the common face to points
/// in the right one.
void add_lamp_inside(SceneMaker& maker) {
    maker.add(ball({-0.3, -0.1, 0.5}, 0.25), maker.material(shining({3, 2.5, 2})));
}
void add_floor(SceneMaker& maker) {
    maker.add(rectangle({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), maker.material(matt({0.6, 0.5, 0.4})));
}
Material clear(double index, const Rgb& absorption) {
    return fog(absorption, {}, 0.0, index);
}

/// A t of 22 degrees of freedom beyond 5.7 is seen in one of 10^5 draws. Errors are at most `most`
/// of the picture.
void expect_light_of(const Blocks& truth, const Scene& scene, const std::string& renderer,
                     int samples, double most, const std::string& name) {
    constexpr double kMost = 5.7;
    const Blocks found = blocks_of(scene, renderer, samples);
    double whole = 0.0;
    for (const double mean : truth.mean) whole += mean / 4;
    const double bias = renderer.starts_with("vcm") ? 0.005 * whole : 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double error = std::hypot(found.error[i], truth.error[i]);
        EXPECT_LE(error, most * std::max(whole, truth.mean[i])) << name << ", " << renderer;
        EXPECT_LE(std::abs(found.mean[i] - truth.mean[i]), kMost * error + bias)
            << name << ", block " << i << ", " << renderer << ": " << found.mean[i] << ", expected "
            << truth.mean[i] << " +- " << error;
    }
}

double sum_of(const Rgb& c) {
    return c.r + c.g + c.b;
}
/// Expects equal paths of the same volumes in another order, up to rounding.
void expect_same_paths(const Scene& a, const Scene& b, const std::string& renderer,
                       const std::string& name) {
    const Film first = picture_of(a, renderer, 8, 16), second = picture_of(b, renderer, 8, 16);
    const double whole = sum_of(mean_of(first));
    for (int i = 0; i < 64; ++i) {
        const double difference = sum_of(first.at(i % 8, i / 8)) - sum_of(second.at(i % 8, i / 8));
        EXPECT_NEAR(difference, 0.0, 1e-6 * whole) << name << ", " << renderer << ", pixel " << i;
    }
}

TEST(CoincidentVolumes, TwoHalvesAreTheWhole) {
    struct Case {
        std::string name;
        Material material;
        int depth, samples;
        double most;
    };
    const std::vector<Case> cases{
        {"fog", fog({0.2, 0.5, 0.9}, {1.2, 1.6, 2}, 0.3), kFew, 120, 0.0105},
        {"milk", fog({0.2, 0.5, 0.9}, {1.2, 1.6, 2}, 0.3, 1.2), kFew, 112, 0.0155},
        {"ink", clear(1.3, {0.5, 1, 2}), kMany, 96, 0.0105}};
    for (const auto& [name, material, depth, samples, most] : cases) {
        SceneMaker whole = below_a_lamp();
        add_floor(whole);
        add_lamp_inside(whole);
        whole.add(BoxShape{{-0.7, -0.6, 0.1}, {0.8, 0.5, 0.9}}, whole.material(material));
        const Blocks truth = blocks_of(whole.compile(), eye_paths(depth), samples);
        const auto halves = [&, &material = material](bool turned) {
            SceneMaker maker = below_a_lamp();
            add_floor(maker);
            add_lamp_inside(maker);
            std::vector<BoxShape> boxes{{{-0.7, -0.6, 0.1}, {0.15, 0.5, 0.9}},
                                        {{0.15, -0.6, 0.1}, {0.8, 0.5, 0.9}}};
            if (turned) std::swap(boxes[0], boxes[1]);
            for (const BoxShape& box : boxes) maker.add(box, maker.material(material));
            return maker.compile();
        };
        const Scene scene = halves(false), turned = halves(true);
        for (const std::string& renderer : renderers(depth, name)) {
            expect_light_of(truth, scene, renderer, samples, most, name);
            expect_same_paths(scene, turned, renderer, name);
        }
    }
}

TEST(CoincidentVolumes, WhatTouchesHasNoOrder) {
    struct Case {
        std::string name;
        Material a, b;
        int depth;
        double most;
    };
    const std::vector<Case> cases{
        {"fogs", fog({0.2, 0.5, 0.9}, {1.2, 1.6, 2}, 0.3), fog({0.1, 0.1, 0}, {3, 2, 1}, -0.3),
         kFew, 0.012},
        {"glass and wine", clear(1.5, {0.2, 0.1, 0.2}), clear(1.33, {0.3, 2, 2}), kMany, 0.02}};
    for (const Case& c : cases) {
        const auto touching = [&](bool turned) {
            SceneMaker maker = below_a_lamp();
            add_floor(maker);
            add_lamp_inside(maker);
            const MaterialId a = maker.material(c.a), b = maker.material(c.b);
            const BoxShape left{{-0.7, -0.6, 0.1}, {0.15, 0.5, 0.9}};
            const BoxShape right{{0.15, -0.6, 0.1}, {0.8, 0.5, 0.9}};
            if (!turned) maker.add(left, a);
            maker.add(right, b);
            if (turned) maker.add(left, a);
            return maker.compile();
        };
        const Scene scene = touching(false), turned = touching(true);
        const Blocks truth = blocks_of(scene, eye_paths(c.depth), 64);
        for (const std::string& renderer : renderers(c.depth, c.name)) {
            if (renderer != eye_paths(c.depth))
                expect_light_of(truth, scene, renderer, 64, c.most, c.name);
            expect_same_paths(scene, turned, renderer, c.name);
        }
    }
}

/// Nested volumes with a common face transport light like volumes a small distance apart.
TEST(CoincidentVolumes, FlushVolumesNestInAnyOrder) {
    const std::vector<Material> materials{clear(1.5, {2, 1, 2}), clear(1.33, {0.3, 2, 2}),
                                          clear(1.2, {0.2, 0.1, 0.1})};
    for (const std::size_t count : {2u, 3u}) {
        const auto scene = [&](double apart, bool inner_first) {
            SceneMaker maker = below_a_lamp();
            add_floor(maker);
            for (std::size_t k = 0; k < count; ++k) {
                const std::size_t i = inner_first ? k : count - 1 - k;
                const double more = 0.2 * double(i);
                maker.add(BoxShape{{-0.5 - more, -0.4 - more, 0.3 - apart * double(i)},
                                   {0.5 + more, 0.4 + more, 0.8 + 0.1 * double(i)}},
                          maker.material(materials[i]));
            }
            return maker.compile();
        };
        const Blocks truth = blocks_of(scene(1e-4, false), eye_paths(kMany), 64);
        const Scene flush = scene(0.0, false), inner_first = scene(0.0, true);
        const std::string name = std::to_string(count) + " volumes";
        for (const std::string& renderer : renderers(kMany, name)) {
            expect_light_of(truth, flush, renderer, 64, 0.032, name);
            expect_same_paths(flush, inner_first, renderer, name);
        }
    }
}

/// The table is hit, not passed, also if the glass is the lower primitive.
TEST(CoincidentVolumes, ABlockStandsOnItsTable) {
    for (const auto& [name, material] : std::vector<std::pair<std::string, Material>>{
             {"glass", clear(1.5, {0.2, 0.1, 0.2})}, {"fog", fog({}, {1.2, 1.6, 2}, 0.3)}}) {
        const auto on_table = [&, &material = material](bool block_first) {
            SceneMaker maker = below_a_lamp();
            const BoxShape table{{-4, -4, -0.5}, {4, 4, 0}};
            const MaterialId matt_one = maker.material(matt({0.6, 0.5, 0.4}));
            if (!block_first) maker.add(table, matt_one);
            maker.add(BoxShape{{-0.7, -0.6, 0}, {0.8, 0.5, 0.6}}, maker.material(material));
            if (block_first) maker.add(table, matt_one);
            return maker.compile();
        };
        const Scene scene = on_table(false), block_first = on_table(true);
        const Blocks truth = blocks_of(scene, eye_paths(kMany), 64);
        for (const std::string& renderer : renderers(kMany, name)) {
            if (renderer != eye_paths(kMany))
                expect_light_of(truth, scene, renderer, 64, 0.016, name);
            expect_same_paths(scene, block_first, renderer, name);
        }
        if (thorough() || name == "fog") {
            expect_light_of(truth, block_first, "sppm:photons=8000,radius=0.05", 16, 0.026, name);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
