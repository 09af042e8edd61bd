#include "alhazen/geometry/polygon_sets/partition.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/polygon_sets/arrangement.h"
#include "alhazen/geometry/polygon_sets/set_operations.h"
#include "support/random_polygons.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

bool overlap(const PolygonSet& a, const PolygonSet& b) {
    if (!a.bounds().meets(b.bounds())) return false;
    for (const SubEdge& e : exact_arrangement(a, b).sub_edges) {
        if (e.below == (kInFirst | kInSecond) || e.above == (kInFirst | kInSecond)) return true;
    }
    return false;
}

/// The sum of the parts is the whole and no two overlap.
void expect_partition(const PolygonSet& whole, const std::vector<PolygonSet>& parts) {
    Int128 sum = 0;
    for (const PolygonSet& part : parts) sum += twice_area(part);
    EXPECT_TRUE(sum == twice_area(whole)) << static_cast<double>(sum - twice_area(whole));
    for (std::size_t i = 0; i < parts.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            EXPECT_FALSE(overlap(parts[i], parts[k])) << i << " and " << k;
        }
    }
}

/// Parts cut out of the whole one after the other, each rounded alone; what is left comes last.
std::vector<PolygonSet> cut_out(const PolygonSet& whole, std::span<const PolygonSet> shapes) {
    std::vector<PolygonSet> parts;
    PolygonSet rest = whole;
    for (const PolygonSet& shape : shapes) {
        PolygonCut both = cut(rest, shape);
        parts.push_back(both.inside);
        rest = both.outside;
    }
    parts.push_back(rest);
    return parts;
}

TEST(Partition, PartsThatWereCutOutOneAfterTheOtherFitThenWithoutGapAndOverlap) {
    RandomPolygons random(1976);
    int off = 0, moved = 0;
    for (int trial = 0; trial < 400; ++trial) {
        const std::int32_t size = trial % 3 == 0 ? 12 : trial % 3 == 1 ? 1000 : kLatticeLimit;
        const PolygonSet window = lattice_rectangle({-size, -size}, {size, size});
        std::vector<PolygonSet> shapes;
        for (int k = 0; k < 12; ++k) {
            shapes.push_back(k % 2 == 0 ? polygon_set(random.any(size, 7))
                                        : polygon_set(random.star(size, 9)));
        }
        const std::vector<PolygonSet> cut_parts = cut_out(window, shapes);
        Int128 before = 0;
        for (const PolygonSet& part : cut_parts) before += twice_area(part);
        off += before != twice_area(window);
        std::vector<PolygonSet> parts = cut_parts;
        make_partition(window, parts);
        expect_partition(window, parts);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            // A part gains and loses slivers along its edges.
            const double apart = std::abs(
                static_cast<double>(twice_area(symmetric_difference(parts[k], cut_parts[k]))));
            EXPECT_LE(apart, 8.0 * size * (4.0 + double(cut_parts[k].vertex_count())));
            moved += apart > 0;
        }
        std::vector<PolygonSet> again = parts;
        make_partition(window, again);
        EXPECT_EQ(again, parts) << trial;
    }
    EXPECT_GT(off, 100);
    EXPECT_GT(moved, 100);
}

TEST(Partition, GapsGoToTheNeighbourAlongTheMostOfThemOverlapsToTheFirst) {
    const PolygonSet whole = lattice_rectangle({0, 0}, {100, 100});
    std::vector<PolygonSet> parts{lattice_rectangle({0, 0}, {100, 40}),
                                  lattice_rectangle({-10, 30}, {100, 60}),
                                  lattice_rectangle({0, 62}, {100, 120})};
    make_partition(whole, parts);
    expect_partition(whole, parts);
    EXPECT_EQ(parts[0], lattice_rectangle({0, 0}, {100, 40}));
    EXPECT_EQ(parts[1], lattice_rectangle({0, 40}, {100, 62}));
    EXPECT_EQ(parts[2], lattice_rectangle({0, 62}, {100, 100}));
}

TEST(Partition, AHoleInAGapAndAPartThatLosesAllAreNoTrouble) {
    const PolygonSet whole = lattice_rectangle({0, 0}, {100, 100});
    const PolygonSet island = lattice_rectangle({40, 40}, {60, 60});
    std::vector<PolygonSet> parts{
        difference(whole, lattice_rectangle({38, 38}, {62, 62})), island, island, {}};
    make_partition(whole, parts);
    expect_partition(whole, parts);
    EXPECT_EQ(parts[1], island);  // the gap has its longer boundary with the outer part
    EXPECT_TRUE(parts[2].empty());
    EXPECT_TRUE(parts[3].empty());
    std::vector<PolygonSet> one{{}};
    make_partition(whole, one);
    EXPECT_EQ(one[0], whole);
    make_partition(whole, {});  // no part to take the whole
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
