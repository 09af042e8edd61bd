// The truth-table evaluator of small solids has the results of the event heap, bit for bit.

#include "alhazen/csg/csg_truth_table.h"

#include <bit>

#include "alhazen/csg/csg_event_heap.h"
#include "csg_random_trees.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::RandomSolids;
using testing::SceneMaker;
using testing::solid_of;

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void expect_same(const std::vector<Hit>& a, const std::vector<Hit>& b, const std::string& at) {
    testing::expect_same_hits(a, b, at);
    for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
        EXPECT_TRUE(same_bits(a[i].u, b[i].u) && same_bits(a[i].v, b[i].v)) << at << " hit " << i;
    }
}

void compare(const CsgSolid& solid, const Ray& ray, const std::string& at) {
    const CsgTruthTable table(solid);
    const CsgEventHeap heap(solid);
    const CsgRay prepared = solid.prepare(ray);
    std::vector<Hit> of_table, of_heap;
    EXPECT_EQ(table.all(prepared, of_table, nullptr), heap.all(prepared, of_heap, nullptr)) << at;
    expect_same(of_table, of_heap, at);
    Hit first_of_table, first_of_heap;
    const bool found = table.first(prepared, first_of_table, nullptr);
    ASSERT_EQ(found, heap.first(prepared, first_of_heap, nullptr)) << at;
    ASSERT_EQ(found, !of_heap.empty()) << at;
    if (found) expect_same({first_of_table}, {first_of_heap}, at + " first");
    for (const Hit& hit : of_heap) {
        const CsgSides a = table.sides(prepared, hit.t), b = heap.sides(prepared, hit.t);
        EXPECT_EQ(a.before, b.before) << at;
        EXPECT_EQ(a.after, b.after) << at;
    }
}

TEST(CsgTruthTable, FindsWhatTheEventHeapFinds) {
    int small = 0;
    for (std::uint64_t seed = 1; seed <= 200 && !::testing::Test::HasFailure(); ++seed) {
        RandomStream random(seed);
        SceneMaker maker;
        maker.material({});
        RandomSolids solids(maker, random, seed % 2 == 1);
        maker.add(solids.tree(2 + static_cast<int>(seed % 5)));
        const Scene scene = testing::compiled(maker, "event_heap");
        const CsgAggregate* solid = solid_of(scene);
        if (solid == nullptr || !CsgTruthTable::fits(solid->solid())) continue;
        ++small;
        for (int i = 0; i < 60; ++i) {
            const std::string at = "seed " + std::to_string(seed) + " ray " + std::to_string(i);
            Ray ray = solids.ray();
            compare(solid->solid(), ray, at);
            ray.t_min = -std::numeric_limits<double>::infinity();
            compare(solid->solid(), ray, at + " line");
            ray.t_min = random.uniform(-2, 2);
            ray.t_max = ray.t_min + random.uniform(0, 3);
            compare(solid->solid(), ray, at + " limited");
        }
    }
    EXPECT_GT(small, 50);
}

TEST(CsgTruthTable, IsNotForSolidsOfManyLeaves) {
    SceneMaker maker;
    maker.material({});
    RandomStream random(1);
    RandomSolids solids(maker, random, false);
    maker.add(solids.tree(12));
    const Scene scene = testing::compiled(maker, "event_heap");
    const CsgAggregate* solid = solid_of(scene);
    ASSERT_NE(solid, nullptr);
    EXPECT_FALSE(CsgTruthTable::fits(solid->solid()));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
