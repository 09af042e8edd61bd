// A single ray that begins near the one before it takes the children of nodes by jumps, another by
// their slots, and in a large tree it fetches more: the hits and the work are the same.

#include <gtest/gtest.h>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"
#include "alhazen/simd/targets.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// The nearest hits and the occlusion of rays, asked one by one, and the work.
struct Sequence {
    std::vector<Hit> hits;
    std::vector<bool> occluded;
    TraversalStats nearest, any;
};
/// With a ray from far away before each query, unless the rays are to follow one another.
Sequence ask_one_by_one(const Aggregate& tested, const std::vector<Ray>& rays, bool follow) {
    // Of one leaf, whose rays are all remembered.
    static const auto elsewhere = make_aggregate("wide_bvh", random_triangles(1, 1, 1, 53));
    const auto go_away = [&](TraversalStats* stats) {
        const Ray far{{9, 9, 9}, {1, 0, 0}, 0, 1};
        if (follow) return;
        ASSERT_FALSE(elsewhere->occluded(far, stats));
    };
    Sequence answers;
    TraversalStats skipped;
    for (const Ray& ray : rays) {
        Hit hit, counted;
        go_away(nullptr);
        (void)tested.closest(ray, hit, nullptr);
        answers.hits.push_back(hit);
        go_away(nullptr);
        answers.occluded.push_back(tested.occluded(ray, nullptr));
        go_away(&skipped);
        (void)tested.closest(ray, counted, &answers.nearest);
        go_away(&skipped);
        (void)tested.occluded(ray, &answers.any);
    }
    return answers;
}

TEST(SingleRays, RaysThatFollowOneAnotherDoAndHitWhatOthersDo) {
    const PrimitiveTable table = random_triangles(600, 1, 0.3, 51);
    const auto list = make_aggregate("list", table);
    std::vector<Ray> rays;
    RandomEngine random(52);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 origin = Vec3{1.5, 0.2, -0.1} + uniform_point(random, 1e-3);
        rays.push_back({origin, uniform_point(random, 1) - origin});
    }
    const Sequence expected = ask_one_by_one(*list, rays, true);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tested = make_aggregate("wide_bvh", table);
        const Sequence near = ask_one_by_one(*tested, rays, true);
        const Sequence apart = ask_one_by_one(*tested, rays, false);
        EXPECT_EQ(near.occluded, expected.occluded) << target;
        EXPECT_EQ(apart.occluded, expected.occluded) << target;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            ASSERT_TRUE(same(near.hits[i], expected.hits[i])) << target << ": " << show(rays[i]);
            ASSERT_TRUE(same(apart.hits[i], expected.hits[i])) << target << ": " << show(rays[i]);
        }
        for (const auto work : {&Sequence::nearest, &Sequence::any}) {
            EXPECT_GT((near.*work).node_visits, rays.size()) << target;
            EXPECT_EQ((near.*work).node_visits, (apart.*work).node_visits) << target;
            EXPECT_EQ((near.*work).primitive_tests, (apart.*work).primitive_tests) << target;
        }
    }
}

TEST(SingleRays, RaysThatFollowNoneThroughALargeTreeHitWhatBatchesHit) {
    const PrimitiveTable table = random_spheres(1000000, 1, 0.004, 54);
    std::vector<Ray> rays;
    RandomEngine random(55);
    for (int i = 0; i < 2000; ++i) rays.push_back(random_rays(1)(random));
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        const auto tested = make_aggregate("wide_bvh", table);
        const auto& nodes = dynamic_cast<const WideBvhAggregate&>(*tested).layout().tree.nodes;
        ASSERT_GT(nodes.size() * sizeof(WideNode), std::size_t{6} << 20) << target;
        std::vector<Hit> expected(rays.size());
        tested->closest_batch(rays, expected, nullptr, Coherence::Any);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            Hit hit;
            (void)tested->closest(rays[i], hit, nullptr);
            ASSERT_TRUE(same(hit, expected[i])) << target << ": " << show(rays[i]);
            ASSERT_EQ(tested->occluded(rays[i], nullptr), hit.found())
                << target << ": " << show(rays[i]);
        }
    }
}

/// Triangles, and three through all of them, whose corners are at `half` from the axes.
PrimitiveTable triangles_in_a_room(double half) {
    PrimitiveTable table = random_triangles(600, 1, 0.3, 56);
    auto walls = std::make_shared<TriangleMesh>();
    for (int i = 0; i < 8; ++i) {
        walls->positions.push_back({(i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                                    (i & 4) != 0 ? half : -half});
    }
    // Each has the box of all, so that the builder cannot divide it.
    walls->triangles = {{0, 3, 5}, {7, 1, 2}, {0, 3, 6}};
    table.meshes.push_back({walls, table.meshes.front().material, 0, false});
    table.finish();
    return table;
}

TEST(SingleRays, RaysThatBeginWithTheLargestLeafHitWhatTheListDoes) {
    const PrimitiveTable table = triangles_in_a_room(2);
    const auto list = make_aggregate("list", table);
    std::vector<Ray> rays;
    RandomEngine random(57);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 origin = uniform_point(random, i % 3 == 0 ? 4 : 2);
        rays.push_back({origin, uniform_point(random, 2) - origin, 0, i % 4 == 0 ? 1 : HUGE_VAL});
    }
    const Sequence expected = ask_one_by_one(*list, rays, true);
    for (const std::uint32_t width : {4u, 8u, 16u}) {
        for (const std::string& target : simd_targets()) {
            const SimdTargetOverride use(target);
            BuildOptions options;
            options.width = width;
            const auto tested = make_aggregate("wide_bvh", table, options);
            const auto& tree = dynamic_cast<const WideBvhAggregate&>(*tested);
            WideBvhScene scene(tree.primitives(), tree.layout());
            scene.find_largest_leaf();
            ASSERT_NE(scene.largest_leaf_slot, 0u) << width << " " << target;
            for (const bool follow : {true, false}) {
                const Sequence answers = ask_one_by_one(*tested, rays, follow);
                EXPECT_EQ(answers.occluded, expected.occluded) << width << " " << target;
                for (std::size_t i = 0; i < rays.size(); ++i) {
                    ASSERT_TRUE(same(answers.hits[i], expected.hits[i]))
                        << width << " " << target << ": " << show(rays[i]);
                }
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
