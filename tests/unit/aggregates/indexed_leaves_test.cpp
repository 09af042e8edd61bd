// Leaves::Indices: the hits of the list on every instruction set, alone and in batches; a fourth of
// the memory; refit and storage as for the others.

#include <gtest/gtest.h>

#include <filesystem>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/simd/targets.h"
#include "support/scratch_folder.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

constexpr BuildOptions kIndexed{BuildQuality::Default, Precision::Robust, Leaves::Indices};

std::vector<Ray> rays_through(std::uint64_t seed, std::size_t count) {
    const MakeRay make_ray = random_rays(1);
    RandomEngine random(seed);
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) rays.push_back(make_ray(random));
    return rays;
}

void expect_hits_of_list(const PrimitiveTable& table, const Aggregate& tree) {
    const auto list = make_aggregate("list", table);
    const std::vector<Ray> rays = rays_through(61, 1500);
    std::vector<Hit> hits(rays.size());
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tree.closest_batch(rays, hits, nullptr);
    tree.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr);
    int found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Answer answer = ask(*list, rays[i]);
        found += answer.found;
        ASSERT_EQ(difference(answer, ask(tree, rays[i])), "") << show(rays[i]);
        ASSERT_EQ(hits[i].found(), answer.found) << show(rays[i]);
        ASSERT_TRUE(!answer.found || same(hits[i], answer.closest)) << show(rays[i]);
        ASSERT_EQ(occluded[i], answer.occluded) << show(rays[i]);
    }
    EXPECT_GT(found, 100);
}

TEST(IndexedLeaves, GiveTheHitsOfTheListOnEveryInstructionSet) {
    const PrimitiveTable table = random_mixture(1500, 1, 0.2, 62);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        SCOPED_TRACE(target);
        expect_hits_of_list(table, *make_aggregate("wide_bvh", table, kIndexed));
    }
}

TEST(IndexedLeaves, TakeAFourthOfTheMemory) {
    const PrimitiveTable table = random_triangles(20000, 1, 0.02, 63);
    const auto usual = make_aggregate("wide_bvh", table);
    const auto indexed = make_aggregate("wide_bvh", table, kIndexed);
    EXPECT_LT(4 * indexed->memory_bytes(), usual->memory_bytes() + usual->memory_bytes() / 4);
}

TEST(IndexedLeaves, AreRefittedLikeTheOthers) {
    const PrimitiveTable table = random_triangles(800, 1, 0.2, 64);
    PrimitiveTable moved = table;
    auto mesh = std::make_shared<TriangleMesh>(*table.meshes[0].mesh);
    for (Vec3& p : mesh->positions) p = {p.y, 0.5 * p.z, p.x};
    moved.meshes[0].mesh = mesh;
    WideBvhAggregate tree(table, kIndexed);
    (void)tree.refit(moved);
    expect_hits_of_list(moved, tree);
}

TEST(IndexedLeaves, AreStoredAndLoaded) {
    const PrimitiveTable table = random_mixture(600, 1, 0.2, 65);
    const ScratchFolder folder;
    const std::filesystem::path file = folder.path() / "leaves.bvh";
    WideBvhAggregate(table, kIndexed).save(file);
    const auto loaded = WideBvhAggregate::load(table, file);
    EXPECT_TRUE(loaded->layout().is_indexed());
    expect_hits_of_list(table, *loaded);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
