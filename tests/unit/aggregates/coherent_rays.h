#pragma once
/// Coherent rays, and the comparison of their batches with the hits of the list.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::testing {

using Rays = std::vector<Ray>;

/// Compares packets directly, even if the aggregate would not choose them.
inline void compare_packets(const WideBvhAggregate& tested, const Rays& rays,
                            const std::vector<Hit>& expected, const std::string& name) {
    const WideBvhScene scene(tested.primitives(), tested.layout());
    std::vector<Hit> hits(rays.size());
    wide_bvh_kernels(8).plain.closest_coherent(scene, rays, hits, nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(same(hits[i], expected[i])) << name << ", packets, ray " << i;
    }
    const auto occluded = std::make_unique<bool[]>(rays.size());
    // Rays that are occluded already stay so.
    for (std::size_t i = 0; i < rays.size(); ++i) occluded[i] = i % 16 == 5;
    wide_bvh_kernels(8).plain.occluded_coherent(scene, rays, {occluded.get(), rays.size()}, nullptr);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(occluded[i], i % 16 == 5 || expected[i].found())
            << name << ", packets for any hit, ray " << i;
    }
}

inline void compare_with(const Aggregate& list, const Aggregate& tested, const Rays& rays,
                         const std::string& name) {
    std::vector<Hit> hits(rays.size());
    tested.closest_batch(rays, hits, nullptr, Coherence::Coherent);
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tested.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr, Coherence::Coherent);
    TraversalStats stats;
    std::vector<Hit> counted(rays.size());
    tested.closest_batch(rays, counted, &stats, Coherence::Coherent);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        Hit expected;
        const bool found = list.closest(rays[i], expected, nullptr);
        ASSERT_TRUE(same(hits[i], expected))
            << name << ", ray " << i << ": " << show(rays[i]) << ": " << show(expected)
            << " became " << show(hits[i]);
        ASSERT_EQ(occluded[i], found) << name << ", ray " << i << ": " << show(rays[i]);
        ASSERT_TRUE(same(counted[i], hits[i])) << name << ", ray " << i;
    }
    const auto* tree = dynamic_cast<const WideBvhAggregate*>(&tested);
    // Unbounded primitives are not in the tree.
    if (tree != nullptr && std::isfinite(tree->box().size().x) && !tree->layout().tree.empty) {
        compare_packets(*tree, rays, hits, name);
    }
}

/// Compares with the list on every instruction set.
inline void compare(const std::string& name, const PrimitiveTable& table, const Rays& rays,
                    bool some_hit = true) {
    const auto list = make_aggregate("list", table);
    std::size_t found = 0;
    for (const Ray& ray : rays) {
        Hit hit;
        found += list->closest(ray, hit, nullptr);
    }
    // Guards against comparing only misses.
    EXPECT_TRUE(!some_hit || found > 0) << name;
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        compare_with(*list, *make_aggregate("wide_bvh", table), rays, name + " on " + target);
    }
}

/// Eye rays through side x side points of a square, `width` wide at distance 1, along `look`.
inline Rays eye_rays(const Vec3& eye, const Vec3& look, double width, int side) {
    const Vec3 u = perpendicular(normalize(look));
    const Vec3 v = normalize(cross(look, u));
    Rays rays;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const double a = width * ((x + 0.5) / side - 0.5), b = width * ((y + 0.5) / side - 0.5);
            rays.push_back(
                {eye, normalize(look) + a * u + b * v, 0, std::numeric_limits<double>::infinity()});
        }
    }
    return rays;
}

/// Shadow rays from points of a small square to a light.
inline Rays shadow_rays(const Vec3& middle, double width, const Vec3& light, int side) {
    Rays rays = eye_rays(middle, {0.2, 0.3, 1}, width, side);
    for (Ray& ray : rays) {
        ray.origin = middle + (ray.direction - Vec3{0.2, 0.3, 1});
        ray.direction = light - ray.origin;
        ray.t_max = 1;
    }
    return rays;
}

}  // namespace alhazen::testing
