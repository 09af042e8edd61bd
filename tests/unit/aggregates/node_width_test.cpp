#include <gtest/gtest.h>

#include <memory>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/base/error.h"
#include "alhazen/simd/targets.h"
#include "support/scratch_folder.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Batches of small trees test the stream.
const StreamOverride kStreams;

using namespace testing;

std::vector<Ray> rays_of(const MakeRay& make_ray, int count) {
    RandomEngine random(61);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) rays.push_back(make_ray(random));
    return rays;
}

/// Compares the list with a tree by single rays and in batches.
void compare(const std::string& name, const PrimitiveTable& table, const WideBvhAggregate& tested,
             const std::vector<Ray>& rays) {
    const auto list = make_aggregate("list", table);
    std::vector<Hit> batch(rays.size()), coherent(rays.size());
    const auto occluded = std::make_unique<bool[]>(rays.size());
    tested.closest_batch(rays, batch, nullptr);
    tested.closest_batch(rays, coherent, nullptr, Coherence::Coherent);
    tested.occluded_batch(rays, {occluded.get(), rays.size()}, nullptr);
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Answer answer = ask(*list, rays[i]);
        hits += answer.found;
        ASSERT_EQ(difference(answer, ask(tested, rays[i])), "")
            << name << ", ray " << i << ": " << show(rays[i]);
        ASSERT_TRUE(same(batch[i], answer.closest)) << name << ", ray " << i;
        ASSERT_TRUE(same(coherent[i], answer.closest)) << name << ", ray " << i;
        ASSERT_EQ(occluded[i], answer.occluded) << name << ", ray " << i;
    }
    EXPECT_GT(hits, 10) << name;
}

class NodeWidth : public ::testing::TestWithParam<std::uint32_t> {
  protected:
    const BuildOptions options_{.width = GetParam()};
};
INSTANTIATE_TEST_SUITE_P(All, NodeWidth, ::testing::Values(4, 8, 16));

TEST_P(NodeWidth, GivesTheHitsOfTheListOnEveryInstructionSet) {
    const std::pair<std::string, PrimitiveTable> tables[] = {
        {"triangles", random_triangles(700, 1, 0.2, 62)},
        {"a few triangles", random_triangles(5, 1, 1, 63)},
        {"mixture", random_mixture(300, 1, 0.3, 64)}};
    const std::vector<Ray> rays = rays_of(random_rays(1), 500);
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride use(target);
        for (const auto& [name, table] : tables) {
            compare(name + " on " + target, table, WideBvhAggregate(table, options_), rays);
        }
    }
}

TEST_P(NodeWidth, HasNodesOfThatManyChildren) {
    const PrimitiveTable table = random_triangles(5000, 1, 0.05, 65);
    const WideBvhAggregate tree(table, options_);
    const WideBvh& nodes = tree.layout().tree;
    EXPECT_EQ(nodes.width, GetParam());
    with_nodes(nodes, [&](const auto& all) {
        EXPECT_FALSE(all.empty());
        std::uint32_t most = 0;
        for (const auto& node : all) most = std::max(most, node.child_count());
        EXPECT_EQ(most, GetParam());
    });
}

TEST_P(NodeWidth, StaysWhenTheTreeIsRefitted) {
    WideBvhAggregate tree(random_spheres(300, 1, 0.1, 67), options_);
    PrimitiveTable moved = random_spheres(300, 2, 0.3, 68);
    (void)tree.refit(moved);
    EXPECT_EQ(tree.layout().tree.width, GetParam());
    compare("refitted", moved, tree, rays_of(random_rays(1), 300));
}

TEST(NodeWidths, AreStoredWithTheTree) {
    const ScratchFolder folder;
    const PrimitiveTable table = random_mixture(200, 1, 0.3, 66);
    for (const std::uint32_t width : {4u, 8u, 16u}) {
        WideBvhAggregate(table, {.width = width}).save(folder.path() / "tree");
        const auto loaded = WideBvhAggregate::load(table, folder.path() / "tree");
        EXPECT_EQ(loaded->layout().tree.width, width);
        compare("loaded", table, *loaded, rays_of(random_rays(1), 200));
    }
}

TEST(NodeWidths, OthersAreRefused) {
    for (const std::uint32_t width : {0u, 1u, 7u, 32u}) {
        EXPECT_THROW(WideBvhAggregate(random_triangles(9, 1, 1, 69), BuildOptions{.width = width}),
                     Error);
    }
}

TEST(AnyHitOrder, PutsWhatBlocksMostFirst) {
    // A wall that hardly any ray passes, and a few grains in equally large boxes.
    TableBuilder builder;
    for (int i = 0; i < 8; ++i) {
        const double x = 10.0 * i;
        builder.add_triangle({x, 0, 0}, {x + 0.1, 0.1, 0}, {x, 0.1, 0.1});
        builder.add_triangle({x + 6, 6, 6}, {x + 6, 5.9, 6}, {x + 5.9, 6, 6});
    }
    builder.add_sphere({-10, 3, 3}, 3);
    const WideBvhAggregate tree(builder.finish());
    const auto& nodes = tree.layout().tree.nodes;
    ASSERT_FALSE(nodes.empty());
    const NodeRef first = nodes[tree.layout().tree.root.index()].child[0];
    ASSERT_TRUE(first.is_leaf());
    EXPECT_EQ(static_cast<LeafType>(first.kind()), LeafType::Spheres);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
