// Precision::Fast: the hits of the list up to the rounding of float; the same bits alone and in
// batches.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

constexpr std::size_t kRays = 4000;

std::vector<Ray> rays_through(std::uint64_t seed) {
    const MakeRay make_ray = random_rays(1);
    RandomEngine random(seed);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < kRays; ++i) rays.push_back(make_ray(random));
    return rays;
}

std::shared_ptr<const Aggregate> fast_tree(const PrimitiveTable& table) {
    return make_aggregate("wide_bvh", table, {BuildQuality::Default, Precision::Fast});
}

TEST(FastPrecision, NearlyAllHitsAreThoseOfTheList) {
    const PrimitiveTable table = random_mixture(2000, 1, 0.1, 51);
    const auto list = make_aggregate("list", table);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto fast = fast_tree(table);
        std::size_t same = 0, found = 0;
        for (const Ray& ray : rays_through(52)) {
            Hit exact, quick;
            const bool hit = list->closest(ray, exact, nullptr);
            found += hit;
            const bool agrees = fast->closest(ray, quick, nullptr) == hit &&
                                quick.primitive == exact.primitive &&
                                (!hit || (std::abs(quick.t - exact.t) <= 1e-4 * std::abs(exact.t) &&
                                          std::abs(quick.u - exact.u) < 0.01 &&
                                          std::abs(quick.v - exact.v) < 0.01));
            same += agrees && fast->occluded(ray, nullptr) == list->occluded(ray, nullptr);
        }
        EXPECT_GT(found, kRays / 10) << target;
        EXPECT_GE(same, kRays - 20) << target;
    }
}

TEST(FastPrecision, ABatchHasTheBitsOfSingleRays) {
    const auto fast = fast_tree(random_mixture(3000, 1, 0.1, 53));
    const std::vector<Ray> rays = rays_through(54);
    std::vector<Hit> hits(rays.size());
    const auto occluded = std::make_unique<bool[]>(rays.size());
    fast->closest_batch(rays, hits, nullptr);
    fast->occluded_batch(rays, {occluded.get(), rays.size()}, nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit hit;
        ASSERT_EQ(fast->closest(rays[i], hit, nullptr), hits[i].found()) << show(rays[i]);
        ASSERT_EQ(hit.primitive, hits[i].primitive) << show(rays[i]);
        ASSERT_EQ(hit.t, hits[i].t) << show(rays[i]);
        ASSERT_EQ(fast->occluded(rays[i], nullptr), occluded[i]) << show(rays[i]);
    }
}

TEST(FastPrecision, AllHitsAndShadowsStayExact) {
    const PrimitiveTable table = random_triangles(500, 1, 0.3, 55);
    const auto list = make_aggregate("list", table);
    const auto fast = fast_tree(table);
    std::size_t several = 0;
    for (const Ray& ray : rays_through(56)) {
        std::vector<Hit> exact, quick;
        list->all_hits(ray, exact, nullptr);
        fast->all_hits(ray, quick, nullptr);
        ASSERT_EQ(exact.size(), quick.size()) << show(ray);
        several += exact.size() > 1;
        for (std::size_t i = 0; i < exact.size(); ++i) ASSERT_EQ(exact[i].t, quick[i].t);
    }
    EXPECT_GT(several, 100u);
}

TEST(FastPrecision, RaysThatDoNotFitIntoFloatHaveTheHitsOfTheList) {
    for (const double scale : {1.0, 1e-65}) {
        TableBuilder builder;
        RandomEngine random(59);
        for (int i = 0; i < 100; ++i) {
            const Vec3 p = uniform_point(random, scale);
            const auto near = [&] { return p + uniform_point(random, 0.5 * scale); };
            builder.add_triangle(near(), near(), near());
        }
        const PrimitiveTable table = builder.finish();
        const auto list = make_aggregate("list", table);
        const auto fast = fast_tree(table);
        std::size_t found = 0;
        for (int i = 0; i < 1000; ++i) {
            // In an ordinary scene: from too far away, aimed at it or not, or with too small
            // directions.
            const double away = scale == 1.0 && i % 3 != 0 ? 0x1p42 : 2 * scale;
            const double step = scale == 1.0 && i % 3 == 0 ? 0x1p-210 : 1;
            Ray ray{uniform_point(random, away), {}};
            if (away > 2) ray.origin.y = away;
            const Vec3 target = uniform_point(random, scale);
            ray.direction = i % 2 == 0 ? step * (target - ray.origin) : uniform_point(random, step);
            const Answer exact = ask(*list, ray);
            const Answer quick = ask(*fast, ray);
            ASSERT_EQ(difference(exact, quick), "") << show(ray);
            found += exact.found;
        }
        EXPECT_GT(found, 50u) << scale;
    }
}

TEST(FastPrecision, TheListKnowsNoOther) {
    const PrimitiveTable table = random_triangles(50, 1, 0.5, 57);
    const auto list = make_aggregate("list", table);
    const auto same = make_aggregate("list", table, {BuildQuality::Default, Precision::Fast});
    for (const Ray& ray : rays_through(58)) {
        Hit a, b;
        ASSERT_EQ(list->closest(ray, a, nullptr), same->closest(ray, b, nullptr));
        ASSERT_EQ(a.t, b.t);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
