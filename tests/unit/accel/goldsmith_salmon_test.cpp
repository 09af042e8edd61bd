#include "alhazen/accel/bounds/goldsmith_salmon.h"

#include <gtest/gtest.h>

#include "alhazen/accel/bounds/insertion_tree.h"
#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// A box whose half surface area is `area`.
BoxBound bound_of_half_area(double area) {
    return {{{{0, (area - 1) / 2}, {0, 1}, {0, 1}}}};
}

TEST(GoldsmithSalmon, TheExampleOfTheBookCosts7Point8) {
    // A root of area 10 with four children; of these B (5) has two, D (4) three and F (3) two.
    BoundTree<BoxBound> tree;
    const auto add = [&](double area, std::uint32_t count) {
        tree.nodes.push_back({bound_of_half_area(area), 0, count});
    };
    add(10, 4);
    add(5, 2);
    add(4, 3);
    add(3, 2);
    for (int i = 0; i < 8; ++i) add(1, 0);
    EXPECT_NEAR(goldsmith_salmon_cost(tree), 7.8, 1e-6);
}

TEST(GoldsmithSalmon, TheIncreaseOfEveryInsertionIsThatOfTheWholeCost) {
    for (const Boxes& boxes : {random_boxes(300, 0.3, 1), lattice_boxes(300, 6, 2)}) {
        InsertionTree tree(boxes.size());
        double sum = 0;
        for (std::uint32_t i = 0; i < boxes.size(); ++i) {
            sum += tree.insert(i, BoxBound::of(boxes, i));
            ASSERT_NEAR(tree.cost(), sum, 1e-9 * (1 + sum)) << "after " << i + 1;
        }
    }
}

/// Checks that every primitive is in one leaf and every bound encloses its children.
void check(const BoundTree<BoxBound>& tree, const Boxes& boxes) {
    std::vector<int> seen(boxes.size(), 0);
    for (const auto& node : tree.nodes) {
        if (node.is_leaf()) ++seen[node.first];
        for (std::uint32_t i = 0; i < node.count; ++i) {
            BoxBound both = node.bound;
            both.include(tree.nodes[node.first + i].bound);
            ASSERT_EQ(both.range, node.bound.range);
        }
    }
    for (const int times : seen) ASSERT_EQ(times, 1);
}

TEST(GoldsmithSalmon, TreesHoldEveryPrimitiveOnceAfterReinsertionToo) {
    for (const Boxes& boxes : {random_boxes(500, 0.2, 3), lattice_boxes(500, 5, 4)}) {
        for (const int passes : {0, 1, 3}) {
            const GoldsmithSalmon made = GoldsmithSalmon::build(boxes, {.reinsert = passes});
            check(made.tree(), boxes);
        }
    }
}

TEST(GoldsmithSalmon, MoreOrdersAndReinsertionDoNotCostMore) {
    const Boxes boxes = random_boxes(1000, 0.1, 5);
    const auto cost = [&](GoldsmithSalmon::Config config) {
        return goldsmith_salmon_cost(GoldsmithSalmon::build(boxes, config).tree());
    };
    const double one = cost({.orders = 1});
    EXPECT_LE(cost({.orders = 10}), one);
    EXPECT_LT(cost({.orders = 1, .reinsert = 3}), one);
}

TEST(GoldsmithSalmon, TenThousandIdenticalBoxesMakeAShallowTree) {
    std::vector<Box3> same(10000, Box3{{0, 0, 0}, {1, 1, 1}});
    const GoldsmithSalmon made = GoldsmithSalmon::build(Boxes(same), {});
    std::vector<int> depth(made.tree().nodes.size(), 0);
    for (std::size_t n = 0; n < depth.size(); ++n) {
        const auto& node = made.tree().nodes[n];
        for (std::uint32_t i = 0; i < node.count; ++i) depth[node.first + i] = depth[n] + 1;
    }
    EXPECT_LT(*std::max_element(depth.begin(), depth.end()), 40);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
