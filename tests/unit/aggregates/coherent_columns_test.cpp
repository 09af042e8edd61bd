// Coherent rays in columns form the packets of the same rays in an array: the same work.
// That they hit the same is compared with all other coherent rays (coherent_rays.h). Where packets
// in lanes do not pay, shadow rays go by the stream.

#include <gtest/gtest.h>

#include "unit/aggregates/coherent_rays.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

void expect_same_work(const Aggregate& tree, const Rays& rays, const std::string& name) {
    for (const bool all : {true, false}) {
        const FloatColumns columns(rays, all);
        Rays rounded;
        for (std::size_t i = 0; i < rays.size(); ++i) rounded.push_back(columns.rays().ray(i));
        std::vector<Hit> hits(rays.size());
        std::vector<double> t(rays.size());
        const auto occluded = std::make_unique<bool[]>(rays.size());
        const std::span<bool> met(occluded.get(), rays.size());
        TraversalStats array, column, any_array, any_column;
        tree.closest_batch(rounded, hits, &array, Coherence::Coherent);
        tree.closest_columns(columns.rays(), {t}, &column, Coherence::Coherent);
        tree.occluded_batch(rounded, met, &any_array, Coherence::Coherent);
        tree.occluded_columns(columns.rays(), met, &any_column, Coherence::Coherent);
        EXPECT_GT(array.node_visits, 0u) << name;
        EXPECT_EQ(column.node_visits, array.node_visits) << name;
        EXPECT_EQ(column.box_tests, array.box_tests) << name;
        EXPECT_EQ(column.primitive_tests, array.primitive_tests) << name;
        EXPECT_EQ(any_column.node_visits, any_array.node_visits) << name;
        EXPECT_EQ(any_column.primitive_tests, any_array.primitive_tests) << name;
    }
}

TEST(CoherentColumns, TakeTheWorkOfTheSameRaysInAnArray) {
    for (const Vec3& middle : {Vec3{}, Vec3{96, 32, -64}}) {
        RandomEngine random(21);
        TableBuilder builder;
        for (int i = 0; i < 1000; ++i) {
            const Vec3 a = middle + uniform_point(random, 1);
            builder.add_triangle(a, a + uniform_point(random, 0.1), a + uniform_point(random, 0.1));
        }
        const PrimitiveTable table = builder.finish();
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride use(target);
            const auto tree = make_aggregate("wide_bvh", table);
            const Vec3 eye = middle + Vec3{0.1, 0.2, 3};
            expect_same_work(*tree, eye_rays(eye, {0, 0, -1}, 0.6, 16), "eye on " + target);
            expect_same_work(*tree, shadow_rays(middle + Vec3{-1.2, -1.1, -1.3}, 0.3, eye, 16),
                             "shadow on " + target);
        }
    }
}

/// Long thin triangles in all directions.
PrimitiveTable splinters(int count) {
    RandomEngine random(22);
    TableBuilder builder;
    for (int i = 0; i < count; ++i) {
        const Vec3 a = uniform_point(random, 1);
        builder.add_triangle(a, a + uniform_point(random, 0.3), a + uniform_point(random, 0.003));
    }
    return builder.finish();
}

/// The failures that a tree remembers after a batch of any hit.
std::uint32_t failures_of(const WideBvhAggregate& tree, const Rays& rays) {
    PacketFailures failures{0};
    WideBvhScene scene(tree.primitives(), tree.layout());
    scene.failures = &failures;
    const auto occluded = std::make_unique<bool[]>(rays.size());
    wide_bvh_kernels(8).plain.occluded_coherent(scene, rays, {occluded.get(), rays.size()},
                                                nullptr);
    return failures.load();
}

TEST(CoherentColumns, ShadowRaysThatGoOnAloneLeaveThePackets) {
    RandomEngine random(23);
    const PrimitiveTable table = splinters(1200);
    Rays apart;
    for (int i = 0; i < 1100; ++i) {
        const Vec3 from = uniform_point(random, 1);
        apart.push_back({from, Vec3{2, 3, 4} - from, 0, 1});
    }
    compare("shadow rays apart", table, apart);
    const Rays close = shadow_rays({-1.2, -1.1, -1.3}, 0.001, {1.5, 1.3, 1.4}, 32);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tree = make_aggregate("wide_bvh", table);
        const auto& wide = dynamic_cast<const WideBvhAggregate&>(*tree);
        EXPECT_GT(failures_of(wide, apart), 0u) << target;
        EXPECT_EQ(failures_of(wide, close), 0u) << target;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
