#include "alhazen/illumination/light_tree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <ctime>

#include "alhazen/illumination/illumination.h"
#include "alhazen/illumination/light_tree_lanes.h"
#include "alhazen/simd/targets.h"
#include "support/light_checks.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

Vec3 random_unit(RandomStream& random) {
    const double z = random.uniform(-1, 1), a = random.uniform(0, 2 * kPi);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(a), r * std::sin(a), z};
}

TreeLight random_light(RandomStream& random) {
    TreeLight light;
    const Vec3 at{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0, 9)};
    light.bounds.box.include(at);
    light.bounds.box.include(at + 0.3 * random_unit(random));
    light.bounds.center = light.bounds.box.center();
    light.bounds.axis = random_unit(random);
    light.bounds.cosine_spread = random.below(3) == 0 ? -1.0 : 1.0;
    light.two_sided = random.below(2) == 0;
    light.intensity = random.below(9) == 0 ? 0.0 : std::exp(random.uniform(-3, 3));
    return light;
}

LitPoint random_point(RandomStream& random) {
    return {{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-2, 2)},
            random_unit(random),
            random.below(2) == 0};
}

TEST(LightTree, SixteenChoicesInLanesAreAsOneByOne) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        RandomStream random(5);
        int lit = 0, dark = 0;
        // For points that count light of one side, tests are left out. Lights with cones are chosen
        // one by one.
        for (const std::size_t count : {0u, 1u, 2u, 3u, 17u, 300u, 301u, 302u, 303u}) {
            const bool simple = count % 2 == 1, has_cones = count == 302;
            std::vector<TreeLight> lights(count);
            for (TreeLight& light : lights) {
                light = random_light(random);
                if (has_cones) light.cosine_reach = random.uniform(-1, 1);
                if (count == 17 && random.below(3) == 0) light.cosine_reach = -1.0;
            }
            const LightTree tree(lights);
            EXPECT_EQ(!tree.cones().empty(), has_cones);
            for (int i = 0; i < 500; ++i) {
                constexpr std::size_t kMost = LitPointLanes::kMost;
                std::array<LitPoint, kMost> at;
                std::array<ChosenLight, kMost> chosen;
                LitPointLanes lanes;
                ChoiceLanes choices;
                const std::size_t used = 1 + random.below(kMost);
                for (std::size_t k = 0; k < used; ++k) {
                    at[k] = random_point(random);
                    if (random.below(5) == 0) at[k] = LitPoint::inside_volume(at[k].point);
                    if (simple) at[k] = {at[k].point, random_unit(random)};
                    if (count > 0 && random.below(9) == 0) {
                        at[k].point = lights[random.below(count)].bounds.box.lo;
                    }
                    choices.of[k] = random.below(9) == 0 ? 0.0 : random.uniform(0, 1);
                    lanes.set(k, at[k]);
                }
                choose_lights(tree, lanes, choices, used, chosen.data());
                for (std::size_t k = 0; k < used; ++k) {
                    const ChosenLight alone = tree.choose(at[k], choices.of[k]);
                    ASSERT_EQ(chosen[k].probability, alone.probability) << target << " " << i;
                    ASSERT_EQ(chosen[k].light, alone.light) << target << " " << i;
                    ++(alone.probability > 0.0 ? lit : dark);
                }
            }
        }
        EXPECT_GT(lit, 5000);
        EXPECT_GT(dark, 2000);
    }
}

TEST(LightTree, ProbabilitiesOfAllLightsSumToOne) {
    RandomStream random(1);
    for (const std::size_t count : {1u, 2u, 3u, 17u, 300u}) {
        std::vector<TreeLight> lights(count), lamps(count);
        for (std::size_t k = 0; k < count; ++k) {
            lights[k] = lamps[k] = random_light(random);
            lamps[k].bounds.cosine_spread = lamps[k].cosine_reach = -1.0;
        }
        lights[0].intensity = lamps[0].intensity = 1.0;
        const LightTree tree(lights), tree_of_lamps(lamps);
        for (int i = 0; i < 50; ++i) {
            LitPoint at = random_point(random);
            double sum = 0.0, sum_of_lamps = 0.0;
            for (std::size_t k = 0; k < count; ++k) sum += tree.probability(at, k);
            at.both_sides = true;
            for (std::size_t k = 0; k < count; ++k)
                sum_of_lamps += tree_of_lamps.probability(at, k);
            double sum_in_volume = 0.0;
            const LitPoint inside = LitPoint::inside_volume(at.point);
            for (std::size_t k = 0; k < count; ++k)
                sum_in_volume += tree_of_lamps.probability(inside, k);
            EXPECT_NEAR(sum_in_volume, 1.0, 1e-12);
            // The rest belongs to nodes without a light that reaches the point.
            EXPECT_LE(sum, 1.0 + 1e-12);
            EXPECT_NEAR(sum_of_lamps, 1.0, 1e-12);
        }
    }
}

/// A light seen edge-on from a surface has no weight; in a volume it has the weight of all others.
TEST(LightTree, InAVolumeNoCosineCounts) {
    std::vector<TreeLight> lights(2);
    for (std::size_t k = 0; k < 2; ++k) {
        lights[k].bounds.center = k == 0 ? Vec3{2, 0, 0} : Vec3{0, 0, 2};
        lights[k].bounds.box.include(lights[k].bounds.center);
        lights[k].bounds.cosine_spread = lights[k].cosine_reach = -1.0;
        lights[k].intensity = 1.0;
    }
    const LightTree tree(lights);
    EXPECT_LT(tree.probability({{0, 0, 0}, {0, 0, 1}, true}, 0), 1e-3);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_NEAR(tree.probability(LitPoint::inside_volume({0, 0, 0}), k), 0.5, 1e-6);
    }
}

TEST(LightTree, ADrawHasTheProbabilityOfItsLight) {
    RandomStream random(2);
    std::vector<TreeLight> lights(500);
    for (TreeLight& light : lights) light = random_light(random);
    const LightTree tree(lights);
    int drawn = 0;
    for (int i = 0; i < 2000; ++i) {
        LitPoint at = random_point(random);
        if (i % 3 == 0) at = LitPoint::inside_volume(at.point);
        const ChosenLight chosen = tree.choose(at, random.uniform());
        if (!(chosen.probability > 0.0)) continue;
        ++drawn;
        EXPECT_NEAR(tree.probability(at, chosen.light) / chosen.probability, 1.0, 1e-12);
        EXPECT_GT(lights[chosen.light].intensity, 0.0);
    }
    EXPECT_GT(drawn, 1500);
}

TEST(LightTree, DrawsFollowTheProbabilities) {
    RandomStream random(3);
    std::vector<TreeLight> lights(40);
    for (TreeLight& light : lights) light = random_light(random);
    const LightTree tree(lights);
    const LitPoint at{{0, 0, 0}, {0, 0, 1}, true};
    constexpr int kDraws = 100000;
    std::vector<double> found(41, 0.0);
    for (int i = 0; i < kDraws; ++i) {
        const ChosenLight chosen = tree.choose(at, random.uniform());
        found[chosen.probability > 0.0 ? chosen.light : 40] += 1.0;
    }
    double sum = 0.0, rest = 1.0;
    int freedom = 0;
    for (std::size_t k = 0; k < 40; ++k) {
        const double expected = kDraws * tree.probability(at, k);
        rest -= expected / kDraws;
        if (expected < 5.0) continue;
        sum += (found[k] - expected) * (found[k] - expected) / expected;
        ++freedom;
    }
    EXPECT_NEAR(found[40] / kDraws, rest, 0.01);
    EXPECT_GT(chi_square_tail(sum, freedom), 1e-3);
}

TEST(LightTree, WhatMayLightAPointIsChosenSometimes) {
    RandomStream random(4);
    std::vector<TreeLight> lights(200);
    for (TreeLight& light : lights) {
        light = random_light(random);
        light.bounds.cosine_spread = 1.0;
        light.intensity = 1.0;
    }
    const LightTree tree(lights);
    for (int i = 0; i < 200; ++i) {
        const LitPoint at = random_point(random);
        for (std::size_t k = 0; k < lights.size(); ++k) {
            const EmitterBounds& b = lights[k].bounds;
            const Vec3 to_light = b.box.center() - at.point;
            const double sent = -dot(to_light, b.axis), received = dot(to_light, at.normal);
            const bool lit = (lights[k].two_sided ? std::abs(sent) : sent) > 0.0 &&
                             (at.both_sides || received > 0.0);
            EXPECT_TRUE(!lit || tree.probability(at, k) > 0.0) << i << " " << k;
        }
    }
}

/// The light that a small light sends to a point, without occlusion.
double sent_to(const LitPoint& at, const TreeLight& light) {
    const Vec3 to_light = light.bounds.center - at.point;
    const double distance = length(to_light);
    double sent = -dot(to_light, light.bounds.axis) / distance;
    if (light.two_sided) sent = std::abs(sent);
    if (light.bounds.cosine_spread <= -1.0) sent = 1.0;
    if (!(sent > light.cosine_reach)) return 0.0;
    double received = dot(to_light, at.normal) / distance;
    if (at.both_sides) received = std::abs(received);
    if (at.in_volume) received = 1.0;
    return std::max(0.0, light.intensity * sent * received / (distance * distance));
}

/// Dim lights beside bright ones that are behind the surface or shine elsewhere, far from the
/// origin, seen from any distance.
TEST(LightTree, DimLightsAreChosenSometimes) {
    RandomStream random(6);
    int lit = 0;
    for (int i = 0; i < 400; ++i) {
        const Vec3 origin = (i % 3 == 0 ? 1e7 : 1.0) * random_unit(random);
        const double size = std::exp(random.uniform(-9, 9)), dimness = i % 2 == 0 ? 1e-9 : 1.0;
        std::vector<TreeLight> lights(60);
        for (TreeLight& light : lights) {
            const bool dim = random.below(5) == 0;
            const Vec3 place = (dim ? 1.0 : 0.01) * random_unit(random);
            light.bounds.center = origin + size * place;
            light.bounds.box.include(light.bounds.center);
            light.bounds.axis = dim ? random_unit(random) : Vec3{0, 0, 1};
            light.intensity = dim ? dimness * std::exp(random.uniform(-16, 0)) : 1e3;
            if (i % 4 == 0) light.cosine_reach = random.uniform(0, 0.9);
            light.two_sided = i % 5 == 0;
        }
        const LightTree tree(lights);
        for (int k = 0; k < 40; ++k) {
            const double distance = size * std::exp(random.uniform(-12, 30));
            LitPoint at{origin + distance * random_unit(random), random_unit(random), k % 7 == 0};
            if (k % 5 == 0) {
                const double beside = size * std::exp(random.uniform(-16, -6));
                at.point = lights[random.below(60)].bounds.center + beside * random_unit(random);
            }
            if (k % 11 == 0) at = LitPoint::inside_volume(at.point);
            if (k % 3 == 0) {
                // A light is a little above the horizon.
                const Vec3 to_light = lights[random.below(60)].bounds.center - at.point;
                const Vec3 along = normalize(to_light);
                at.normal = normalize(normalize(cross(along, random_unit(random))) + 1e-9 * along);
            }
            for (std::size_t j = 0; j < lights.size(); ++j) {
                if (!(sent_to(at, lights[j]) > 0.0)) continue;
                ++lit;
                ASSERT_GT(tree.probability(at, j), 0.0) << i << " " << k << " " << j;
            }
        }
    }
    EXPECT_GT(lit, 100000);
}

TEST(LightTree, OfTwoSmallLightsEachIsChosenByItsLight) {
    RandomStream random(11);
    int compared = 0;
    for (int i = 0; i < 2000; ++i) {
        std::vector<TreeLight> lights(2);
        for (TreeLight& light : lights) {
            light.bounds.center = 5.0 * random_unit(random);
            light.bounds.box.include(light.bounds.center);
            light.bounds.axis = random_unit(random);
            light.bounds.cosine_spread = random.below(4) == 0 ? -1.0 : 1.0;
            light.two_sided = random.below(2) == 0;
            light.intensity = std::exp(random.uniform(-3, 3));
        }
        LitPoint at{random.uniform(0, 30) * random_unit(random), random_unit(random), i % 3 == 0};
        if (i % 7 == 0) at = LitPoint::inside_volume(at.point);
        const LightTree tree(lights);
        const double first = sent_to(at, lights[0]), second = sent_to(at, lights[1]);
        // Not edge-on.
        const auto share = [&](const TreeLight& light, double light_sent) {
            return light_sent / light.intensity * length_squared(light.bounds.center - at.point);
        };
        if (share(lights[0], first) < 0.05 || share(lights[1], second) < 0.05) continue;
        ++compared;
        EXPECT_NEAR(tree.probability(at, 0), first / (first + second), 2e-3) << i;
    }
    EXPECT_GT(compared, 200);
}

TEST(LightTree, EqualLightsInOnePointAreATree) {
    std::vector<TreeLight> lights(5000);
    for (TreeLight& light : lights) {
        light.bounds.center = {1, 2, 3};
        light.bounds.box.include(light.bounds.center);
        light.bounds.cosine_spread = -1.0;
        light.cosine_reach = -1.0;
        light.intensity = 1.0;
    }
    const LightTree tree(lights);
    const LitPoint at{{0, 0, 0}, {0, 0, 1}, false};
    double sum = 0.0;
    for (std::size_t k = 0; k < lights.size(); ++k) sum += tree.probability(at, k);
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_NEAR(tree.choose(at, 0.7).probability, 1.0 / 5000, 1e-4);
}

TEST(LightTree, OfNoLightsChoosesNone) {
    EXPECT_EQ(LightTree(std::vector<TreeLight>(3)).choose({}, 0.5).probability, 0.0);
    EXPECT_EQ(LightTree().choose({}, 0.5).probability, 0.0);
}

/// Small triangles in a layer above a plane, of different sizes and directions.
Scene many_triangles(std::size_t count) {
    RandomStream random(9);
    TriangleMesh mesh;
    const double size = 20.0;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 at{random.uniform(-size, size), random.uniform(-size, size),
                      random.uniform(0.5, 3)};
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + 0.02 * random_unit(random));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    SceneMaker maker;
    Material shining;
    shining.emission.color = {1, 1, 1};
    shining.double_sided = false;
    const MaterialId m = maker.material(shining);
    maker.add(maker.mesh(std::move(mesh)), m);
    return maker.compile("wide_bvh");
}

/// Variance of the unshadowed light of one draw, a mean over points of the plane.
double variance_at_points(const Scene& scene, LightChoice choice) {
    const Illumination lights(scene, {.choice = choice});
    RandomStream random(5);
    double variance = 0.0;
    constexpr int kPoints = 24, kDraws = 4000;
    for (int p = 0; p < kPoints; ++p) {
        const LitPoint at{{random.uniform(-15, 15), random.uniform(-15, 15), 0}, {0, 0, 1}, false};
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kDraws; ++i) {
            const double c = random.uniform(), u = random.uniform(), v = random.uniform();
            const LightDraw draw = lights.draw(at, c, {u, v}, kColorChannels);
            const double cosine = dot(at.normal, draw.to_light);
            const double x =
                draw.density > 0.0 && cosine > 0.0 ? cosine / draw.density * draw.radiance.b : 0.0;
            sum += x;
            squares += x * x;
        }
        variance += squares / kDraws - sum / kDraws * (sum / kDraws);
    }
    return variance / kPoints;
}

TEST(LightTree, IsHundredTimesMoreEfficientThanChoosingEvenly) {
    const Scene scene = many_triangles(100000);
    const double uniform = variance_at_points(scene, LightChoice::Uniform);
    const double power = variance_at_points(scene, LightChoice::Power);
    const double tree = variance_at_points(scene, LightChoice::Tree);
    RecordProperty("uniform_over_tree", std::to_string(uniform / tree));
    std::printf("variance: uniform %g, power %g, tree %g\n", uniform, power, tree);
    EXPECT_GT(uniform, 100.0 * tree);
}

/// A million take 7 s of processor time (docs/design/illumination.md).
TEST(LightTree, TakesManyLights) {
    constexpr std::size_t kLights = 200000;
    const Scene scene = many_triangles(kLights);
    const std::clock_t begin = std::clock();
    const Illumination lights(scene);
    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%zu emitters: %g s of processor time\n", kLights, seconds);
    int lit = 0;
    RandomStream random(8);
    for (int i = 0; i < 1000; ++i) {
        const double c = random.uniform(), u = random.uniform(), v = random.uniform();
        if (lights.draw({{0, 0, 0}, {0, 0, 1}, false}, c, {u, v}, kColorChannels).density > 0.0)
            ++lit;
    }
    EXPECT_GT(lit, 500);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
