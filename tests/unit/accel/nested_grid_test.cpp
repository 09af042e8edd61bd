#include "alhazen/accel/cells/nested_grid.h"

#include <gtest/gtest.h>

#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// A few boxes far apart and very many in one place: a teapot in a stadium.
Boxes stadium() {
    RandomStream random(3);
    std::vector<Box3> boxes;
    for (int i = 0; i < 2000; ++i) {
        const double reach = i < 100 ? 1000 : 1;
        Box3 box;
        for (int k = 0; k < 3; ++k) {
            box.lo[k] = random.uniform(-reach, reach);
            box.hi[k] = box.lo[k] + 0.02 * reach;
        }
        boxes.push_back(box);
    }
    return Boxes(boxes);
}

std::uint32_t longest_list(const NestedGrid& grid) {
    std::uint32_t most = 0;
    for (const NestedGrid::Cell& cell : grid.cells()) {
        if (cell.count != NestedGrid::Cell::kIsGrid) most = std::max(most, cell.count);
    }
    return most;
}

TEST(NestedGrid, ACellWithMostOfThePrimitivesGetsAGridOfItsOwn) {
    const Boxes boxes = stadium();
    const NestedGrid flat = NestedGrid::build(boxes, {.max_depth = 1});
    const NestedGrid nested = NestedGrid::build(boxes, {});
    EXPECT_EQ(flat.grids().size(), 1u);
    EXPECT_GT(longest_list(flat), 1000u);
    EXPECT_GT(nested.grids().size(), 1u);
    EXPECT_LT(longest_list(nested), 100u);
}

TEST(NestedGrid, PrimitivesUponEachOtherStayAList) {
    const std::vector<Box3> boxes(200, Box3{{0, 0, 0}, {1, 1, 1}});
    const NestedGrid made = NestedGrid::build(Boxes(boxes), {});
    EXPECT_EQ(made.grids().size(), 1u);
    EXPECT_EQ(longest_list(made), 200u);
}

TEST(NestedGrid, AHeapOfSlantedPlatesIsNotDividedOverAndOver) {
    const SlantedHeap heap(500);
    const NestedGrid made = NestedGrid::build(heap, {});
    EXPECT_EQ(made.grids().size(), 1u);
    // One division: each plate with each cell at most.
    EXPECT_LE(heap.tests(), 500 * made.cells().size());
    EXPECT_EQ(longest_list(made), 500u);
}

TEST(NestedGrid, FewPrimitivesAreAListWithoutAGrid) {
    const NestedGrid made = NestedGrid::build(random_boxes(8, 0.1, 4), {});
    EXPECT_TRUE(made.grids().empty());
    EXPECT_EQ(made.entries().size(), 8u);
}

TEST(NestedGrid, BalancedPlanesShareOutWhatEqualOnesDoNot) {
    const Boxes boxes = stadium();
    const NestedGrid equal = NestedGrid::build(boxes, {.max_depth = 1});
    const NestedGrid balanced = NestedGrid::build(boxes, {.max_depth = 1, .balanced = true});
    EXPECT_LT(longest_list(balanced), longest_list(equal) / 2);
    for (const NestedGrid* grid : {&equal, &balanced}) {
        for (std::size_t k = 0; k < 3; ++k) {
            const double* plane = grid->planes().data() + grid->grids()[0].first_plane[k];
            for (std::uint32_t i = 0; i < grid->grids()[0].cells[k]; ++i) {
                EXPECT_LT(plane[i], plane[i + 1]);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
