#include "alhazen/geometry/polygon_sets/set_operations.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "support/polygon_checks.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

std::vector<LatticeLoop> loops(const PolygonSet& set) {
    return loops_of(set);
}

long long area2(const PolygonSet& set) {
    return static_cast<long long>(twice_area(set));
}

TEST(SetOperations, RectanglesThatOverlapAreCutAtTheirCrossings) {
    const PolygonSet a = lattice_rectangle({0, 0}, {10, 10});
    const PolygonSet b = lattice_rectangle({5, 5}, {15, 15});
    const PolygonCut parts = cut(a, b);
    EXPECT_EQ(parts.inside, lattice_rectangle({5, 5}, {10, 10}));
    EXPECT_EQ(loops(parts.outside),
              (std::vector<LatticeLoop>{{{0, 0}, {10, 0}, {10, 5}, {5, 5}, {5, 10}, {0, 10}}}));
    EXPECT_EQ(area2(union_of(a, b)), 350);
    EXPECT_EQ(area2(symmetric_difference(a, b)), 300);
}

TEST(SetOperations, AHoleIsALoopClockwise) {
    const PolygonSet a = lattice_rectangle({0, 0}, {10, 10});
    const PolygonSet b = lattice_rectangle({3, 3}, {6, 6});
    const PolygonSet holed = difference(a, b);
    ASSERT_EQ(holed.loop_count(), 2U);
    EXPECT_EQ(twice_area(holed.loop(1)), -18);
    EXPECT_EQ(union_of(holed, b), a);
    EXPECT_EQ(intersection(holed, a), holed);
    EXPECT_TRUE(intersection(holed, b).empty());
}

TEST(SetOperations, CoincidentEdgesAreOrdinary) {
    const PolygonSet a = lattice_rectangle({0, 0}, {10, 10});
    const PolygonSet right = lattice_rectangle({10, 2}, {20, 7});
    EXPECT_TRUE(intersection(a, right).empty());
    EXPECT_EQ(difference(a, right), a);
    EXPECT_EQ(union_of(a, right).loop_count(), 1U);
    EXPECT_EQ(union_of(a, right).vertex_count(), 8U);
    EXPECT_EQ(intersection(a, a), a);
    EXPECT_EQ(union_of(a, a), a);
    EXPECT_TRUE(difference(a, a).empty());
    const PolygonSet half = lattice_rectangle({0, 0}, {5, 10});
    EXPECT_EQ(difference(a, half), lattice_rectangle({5, 0}, {10, 10}));
}

TEST(SetOperations, PiecesThatTouchInAPointAreLoopsOfTheirOwn) {
    const PolygonSet a = lattice_rectangle({0, 0}, {4, 4});
    const PolygonSet b = lattice_rectangle({4, 4}, {8, 8});
    const PolygonSet both = union_of(a, b);
    EXPECT_EQ(both.loop_count(), 2U);
    EXPECT_TRUE(both.touching());
    EXPECT_EQ(loops_with_holes(both).size(), 2U);
    // A hole with a corner on the outline.
    const PolygonSet outline = lattice_rectangle({0, 0}, {8, 8});
    const PolygonSet holed = difference(outline, polygon_set({{0, 4}, {3, 2}, {3, 6}}));
    ASSERT_EQ(holed.loop_count(), 2U);
    const std::vector<OuterLoop> pieces = loops_with_holes(holed);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_EQ(pieces[0].holes.size(), 1U);
    EXPECT_TRUE(is_canonical(holed));
}

TEST(SetOperations, IslandsInHolesBelongToNoHole) {
    PolygonSet rings;
    for (int i = 0; i < 6; ++i) {
        const PolygonSet ring = lattice_rectangle({i, i}, {20 - i, 20 - i});
        rings = symmetric_difference(rings, ring);
    }
    const std::vector<OuterLoop> pieces = loops_with_holes(rings);
    ASSERT_EQ(pieces.size(), 3U);
    for (const OuterLoop& piece : pieces) {
        EXPECT_EQ(piece.holes.size(), 1U);
    }
}

TEST(SetOperations, PointsAreInsideOnTheBoundaryOrOutside) {
    const PolygonSet holed = difference(lattice_rectangle({0, 0}, {10, 10}),
                                        polygon_set({{2, 5}, {5, 2}, {8, 5}, {5, 8}}));
    EXPECT_EQ(side_of_point(holed, {1, 1}), PointSide::Inside);
    EXPECT_EQ(side_of_point(holed, {5, 5}), PointSide::Outside);
    EXPECT_EQ(side_of_point(holed, {3, 4}), PointSide::Boundary);
    EXPECT_EQ(side_of_point(holed, {5, 8}), PointSide::Boundary);
    EXPECT_EQ(side_of_point(holed, {0, 7}), PointSide::Boundary);
    EXPECT_EQ(side_of_point(holed, {11, 5}), PointSide::Outside);
    EXPECT_TRUE(contains(holed, {9, 5}));
}

TEST(SetOperations, ExactAreasAddUpForRandomPairsOfEveryKind) {
    RandomPolygons random(22);
    PolygonChecks checks;
    for (int i = 0; i < 4000; ++i) {
        const auto [a, b] = random.pair(i % 10 == 0 ? 24 : 9);
        ASSERT_EQ(polygon_flaw<Residue>(a, b, checks), "") << "pair " << i;
    }
    EXPECT_GT(checks.general, 1000);
    EXPECT_GT(checks.rounded, 1000);
}

TEST(SetOperations, TrianglesCoverTheRegionOnce) {
    RandomPolygons random(23);
    for (int i = 0; i < 2000; ++i) {
        const auto [a, b] = random.pair(12);
        const PolygonSet set = symmetric_difference(a, b);
        Int128 sum = 0;
        for (const LatticeTriangle& t : triangulate(set)) {
            ASSERT_GT(turn(t[0], t[1], t[2]), 0);
            sum += turn(t[0], t[1], t[2]);
        }
        ASSERT_TRUE(sum == twice_area(set)) << "pair " << i;
        std::size_t loop_count = 0;
        for (const OuterLoop& piece : loops_with_holes(set)) {
            loop_count += 1 + piece.holes.size();
        }
        ASSERT_EQ(loop_count, set.loop_count());
    }
}

// Ten thousand of them: polygon_sets_heavy_test.cpp.
TEST(SetOperations, AChainOfOperationsOnOnePolygonLosesNothing) {
    EXPECT_EQ(chain_flaw(300), "");
}

TEST(Mending, SaysWhatWasMended) {
    Mending mending;
    const PolygonSet bow = polygon_set({{0, 0}, {4, 4}, {4, 0}, {0, 4}}, &mending);
    EXPECT_EQ(mending.crossings, 1U);
    EXPECT_EQ(bow.loop_count(), 2U);
    EXPECT_EQ(area2(bow), 16);
    EXPECT_EQ(to_string(mending), "1 crossing, 1 point where outlines touch");
    EXPECT_TRUE(polygon_set({{0, 0}, {5, 5}, {9, 9}}, &mending).empty());
    EXPECT_EQ(mending.flat_loops, 1U);
    EXPECT_TRUE(polygon_set({{1, 1}}, &mending).empty());
    EXPECT_EQ(mending.flat_loops, 1U);
    EXPECT_TRUE(polygon_set(LatticeLoop{}, &mending).empty());
    const PolygonSet clockwise = polygon_set({{0, 0}, {0, 4}, {4, 4}, {4, 4}, {4, 0}}, &mending);
    EXPECT_EQ(clockwise, lattice_rectangle({0, 0}, {4, 4}));
    EXPECT_EQ(to_string(mending), "1 repeated point");
    const PolygonSet spike =
        polygon_set({{0, 0}, {4, 0}, {9, 0}, {4, 0}, {4, 4}, {0, 4}}, &mending);
    EXPECT_EQ(spike, lattice_rectangle({0, 0}, {4, 4}));
    EXPECT_EQ(mending.overlaps, 1U);
}

TEST(Mending, RefusesPointsOffTheLattice) {
    EXPECT_THROW((void)polygon_set({{0, 0}, {kLatticeLimit + 1, 0}, {0, 1}}), Error);
    const std::int32_t far = kLatticeLimit;
    const PolygonSet all = polygon_set({{-far, -far}, {far, -far}, {far, far}, {-far, far}});
    EXPECT_EQ(area2(all), 8LL * far * far);
}

TEST(WeilerAtherton, SaysWhereThePositionIsNotGeneral) {
    const PolygonSet a = lattice_rectangle({0, 0}, {10, 10});
    GeneralPosition position{};
    EXPECT_FALSE(weiler_atherton(a, lattice_rectangle({10, 3}, {20, 6}), &position));
    EXPECT_EQ(position, GeneralPosition::VertexOnBoundary);
    const PolygonSet touching =
        union_of(lattice_rectangle({20, 20}, {30, 30}), lattice_rectangle({30, 30}, {40, 40}));
    EXPECT_FALSE(weiler_atherton(touching, a, &position));
    EXPECT_EQ(position, GeneralPosition::OperandTouchesItself);
    const auto walked = weiler_atherton(a, lattice_rectangle({3, 3}, {6, 20}), &position);
    ASSERT_TRUE(walked.has_value());
    EXPECT_EQ(position, GeneralPosition::Holds);
    EXPECT_EQ(walked->inside, lattice_rectangle({3, 3}, {6, 10}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
