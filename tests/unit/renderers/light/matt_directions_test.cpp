// Diffuse directions in lanes, and shared BSDFs.

#include "alhazen/renderers/light_transport/matt_directions.h"

#include <gtest/gtest.h>

#include <array>

#include "alhazen/renderers/light_transport/bsdf_cache.h"
#include "alhazen/sampling/random.h"
#include "alhazen/shading/microfacets/local_directions.h"
#include "alhazen/simd/targets.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace alhazen::testing;

TEST(MattDirections, HaveTheBitsOfThoseOneByOne) {
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        RandomStream random(5);
        for (int batch = 0; batch < 20000; ++batch) {
            std::array<Vec2, kMostMattDirections> u;
            std::array<Vec3, kMostMattDirections> found;
            const std::size_t count = 1 + random.below(kMostMattDirections);
            for (std::size_t i = 0; i < count; ++i) {
                u[i] = {random.uniform(0, 1), random.uniform(0, 1)};
                if (random.below(20) == 0) u[i].y = 0.125 * static_cast<double>(random.below(8));
                if (random.below(20) == 0) u[i].x = 0.0;
            }
            set_matt_directions(std::span(u).first(count), found.data());
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(found[i], cosine_direction(u[i])) << target << " " << u[i].y;
            }
        }
    }
}

TEST(BsdfCache, WhatItKeepsOutlivesWhatReplacesIt) {
    SceneMaker maker;
    Material glass;
    glass.dielectric.emplace();
    glass.index.value = 1.5;
    const MaterialId id = maker.material(glass);
    maker.add(Sphere{{0, 0, 0}, 1}, id);
    const Scene scene = maker.compile();
    BsdfCache cache(scene, true);
    const Bsdf* const first = cache.find(id, {.eta = 0.5});
    ASSERT_NE(first, nullptr);
    const double eta = first->singular({0, 0, 1}, Transport::Radiance).eta;
    const Bsdf* const second = cache.find(id, {.eta = 0.8});
    ASSERT_NE(second, nullptr);
    EXPECT_NE(first, second);
    EXPECT_EQ(first->singular({0, 0, 1}, Transport::Radiance).eta, eta);
    EXPECT_NE(second->singular({0, 0, 1}, Transport::Radiance).eta, eta);
    cache.release();
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
