#include "alhazen/accel/cells/octree.h"

#include <gtest/gtest.h>

#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// Leaves that the traversals pass through, without those that a ray only touches.
struct Walked {
    std::vector<std::uint32_t> leaves;
    double last;
    bool operator()(std::uint32_t leaf, double exit) {
        if (exit > last + 1e-9) leaves.push_back(leaf);
        last = std::max(last, exit);
        return false;
    }
};

Ray random_ray(RandomStream& random) {
    Ray ray;
    for (int k = 0; k < 3; ++k) {
        const double aim = random.uniform(-1, 1);
        const bool across = random.below(5) == 0;
        ray.origin[k] = across || random.below(6) == 0 ? aim : random.uniform(-4, 4);
        ray.direction[k] =
            across ? (random.below(2) == 0 ? 0.0 : -0.0) : random.uniform(-1, 1) - ray.origin[k];
    }
    if (ray.direction == Vec3{}) ray.direction.y = -1;
    return ray;
}

TEST(Octree, TheFourWalksGoThroughTheSameLeavesInTheSameOrder) {
    const Boxes boxes = random_boxes(400, 0.05, 1);
    const OctreeCells cells(boxes, 7, 1);
    ASSERT_GT(cells.nodes().size(), 1000u);
    RandomStream random(2);
    std::size_t walked = 0;
    for (int i = 0; i < 4000; ++i) {
        const Ray ray = random_ray(random);
        const OctreeRay inside(cells, ray, ray.t_max);
        if (inside.misses()) continue;
        const auto leaves = [&](const auto& walk) {
            Walked visit{{}, inside.enter()};
            walk(visit);
            return visit.leaves;
        };
        const auto located =
            leaves([&](Walked& v) { walk_by_point_location(cells, inside, NoStats{}, v); });
        EXPECT_EQ(located,
                  leaves([&](Walked& v) { walk_by_neighbors(cells, inside, NoStats{}, v); }))
            << "neighbors, ray " << i;
        EXPECT_EQ(located, leaves([&](Walked& v) { walk_smart(cells, inside, NoStats{}, v); }))
            << "smart, ray " << i;
        EXPECT_EQ(located, leaves([&](Walked& v) { walk_parametric(cells, inside, NoStats{}, v); }))
            << "parametric, ray " << i;
        walked += located.size();
    }
    EXPECT_GT(walked, 20000u);
}

TEST(Octree, RaysThatAreThroughInNoTimeAreWalked) {
    const Boxes boxes = random_boxes(50, 0.1, 3);
    std::vector<Box3> tiny;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        tiny.push_back({1e-20 * boxes.box(i).lo, 1e-20 * boxes.box(i).hi});
    }
    const OctreeCells cells(Boxes(tiny), 4, 1);
    for (const double speed : {1.0, 1e150, 1e290, 1e308}) {
        const Ray ray{{-2e-20, 1e-22, 1e-22}, speed * Vec3{1, 0.01, 0.02}};
        const OctreeRay inside(cells, ray, ray.t_max);
        ASSERT_FALSE(inside.misses()) << speed;
        std::size_t leaves = 0;
        walk_smart(cells, inside, NoStats{}, [&](std::uint32_t, double) {
            ++leaves;
            return false;
        });
        EXPECT_GT(leaves, 1u) << speed;
    }
}

TEST(Octree, AHeapOfSlantedPlatesIsCutOutButNotDividedOverAndOver) {
    const OctreeCells heap(SlantedHeap(2000), 12, 1);
    EXPECT_GT(heap.nodes().size(), 9u);
    EXPECT_LT(heap.nodes().size(), 1000u);
    EXPECT_LT(heap.entries().size(), 2000u * 512u);
    // A few primitives in one place are still divided.
    EXPECT_GT(OctreeCells(SlantedHeap(8), 6, 1).nodes().size(), 1000u);
}

TEST(Octree, ThinScenesHaveNoNeedlesOfCells) {
    for (const int axis : {0, 1, 2}) {
        std::vector<Box3> row;
        for (int i = 0; i < 200; ++i) {
            Box3 box{{0, 0, 0}, {0.8, 0.8, 0.8}};
            box.lo[axis] += i;
            box.hi[axis] += i;
            row.push_back(box);
        }
        const OctreeCells cells(Boxes(row), 8, 1);
        EXPECT_LT(cells.nodes().size(), 20'000u);
        EXPECT_LT(cells.entries().size(), 20'000u);
    }
}

TEST(Octree, NeighborsAreFoundInFewerStepsThanPointsFromTheRoot) {
    const OctreeCells cells(random_boxes(2000, 0.02, 3), 8, 1);
    RandomStream random(4);
    TraversalStats located, neighbors;
    const auto nothing = [](std::uint32_t, double) { return false; };
    for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(random);
        const OctreeRay inside(cells, ray, ray.t_max);
        if (inside.misses()) continue;
        walk_by_point_location(cells, inside, CountingStats{&located}, nothing);
        walk_by_neighbors(cells, inside, CountingStats{&neighbors}, nothing);
    }
    EXPECT_LT(neighbors.node_visits, 0.9 * static_cast<double>(located.node_visits));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
