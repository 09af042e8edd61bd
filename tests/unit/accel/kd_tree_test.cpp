#include "alhazen/accel/cells/kd_tree.h"

#include <gtest/gtest.h>

#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

TEST(KdTree, BothBuildersMakeTheSameTreeBitForBit) {
    const Boxes sets[] = {random_boxes(1, 0.1, 1),   random_boxes(2, 0.1, 2),
                          random_boxes(400, 0.1, 3), random_boxes(300, 0.8, 4),
                          random_boxes(300, 0, 5),   lattice_boxes(400, 8, 6),
                          lattice_boxes(300, 3, 7),  lattice_boxes(100, 1, 8)};
    for (const Boxes& boxes : sets) {
        const KdTree fast = KdTree::build(boxes, {});
        const KdTree oracle = KdTree::build(boxes, {.quadratic = true});
        EXPECT_EQ(fast.nodes(), oracle.nodes()) << boxes.size() << " boxes";
        EXPECT_EQ(fast.entries(), oracle.entries()) << boxes.size() << " boxes";
    }
}

TEST(KdTree, ASplitPaysOnlyWhereItIsCheaper) {
    // Two clusters far apart: the tree separates them at a cost far below that of one leaf.
    std::vector<Box3> boxes;
    for (int i = 0; i < 100; ++i) {
        const double x = i % 2 == 0 ? 0.0 : 100.0;
        const double y = 0.01 * i;
        boxes.push_back({{x, y, y}, {x + 0.1, y + 0.1, y + 0.1}});
    }
    const KdTree tree = KdTree::build(Boxes(boxes), {});
    ASSERT_FALSE(tree.nodes().empty());
    EXPECT_FALSE(tree.nodes().front().is_leaf());
    EXPECT_LT(tree.expected_cost(), 0.1 * 100 * 20);
    const KdTree one = KdTree::build(Boxes({boxes.front()}), {});
    EXPECT_EQ(one.nodes().size(), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
