#include "alhazen/accel/cells/cell_grid.h"

#include <gtest/gtest.h>

#include <set>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Interval of a line inside a box shrunk by `margin`; may be empty.
Interval inside(const Box3& box, const Ray& ray, double margin) {
    Interval t{ray.t_min, ray.t_max};
    for (int k = 0; k < 3; ++k) {
        const double lo = box.lo[k] + margin, hi = box.hi[k] - margin;
        if (ray.direction[k] == 0.0) {
            if (ray.origin[k] < lo || ray.origin[k] > hi) return {};
            continue;
        }
        const double a = (lo - ray.origin[k]) / ray.direction[k];
        const double b = (hi - ray.origin[k]) / ray.direction[k];
        t = intersection(t, {std::min(a, b), std::max(a, b)});
    }
    return t;
}

TEST(CellGrid, AWalkGoesThroughAllCellsThatTheRayPiercesAndNoOthersInOrder) {
    const Box3 box{{-1, -2, 0}, {1, 1, 0.5}};
    const CellGrid grid(box, 200, 64);
    EXPECT_GT(grid.size(), 100u);
    EXPECT_LT(grid.size(), 400u);
    RandomStream random(1);
    std::size_t pierced = 0;
    for (int i = 0; i < 2000; ++i) {
        Ray ray;
        for (int k = 0; k < 3; ++k) {
            const double aim = random.uniform(box.lo[k], box.hi[k]);
            const bool across = random.below(4) == 0;
            ray.origin[k] = across ? aim : random.uniform(-3, 3);
            ray.direction[k] = aim - ray.origin[k];
        }
        if (ray.direction == Vec3{}) continue;
        std::set<std::size_t> walked;
        double last = ray.t_min;
        for (CellWalk walk(grid, ray, ray.t_max); !walk.outside(); walk.step()) {
            EXPECT_TRUE(walked.insert(grid.number(walk.cell())).second) << "twice, ray " << i;
            EXPECT_GE(walk.entry(), last);
            last = walk.entry();
            EXPECT_FALSE(inside(grid.cell_box(walk.cell()), ray, -1e-12).empty()) << "ray " << i;
        }
        for (int z = 0; z < grid.cells[2]; ++z) {
            for (int y = 0; y < grid.cells[1]; ++y) {
                for (int x = 0; x < grid.cells[0]; ++x) {
                    if (inside(grid.cell_box({x, y, z}), ray, 1e-12).empty()) continue;
                    ++pierced;
                    EXPECT_EQ(walked.count(grid.number({x, y, z})), 1u) << "ray " << i;
                }
            }
        }
    }
    EXPECT_GT(pierced, 2000u);
}

TEST(CellGrid, FlatBoxesHaveOneLayerAndPointsOneCell) {
    const CellGrid flat(Box3{{0, 0, 5}, {1, 1, 5}}, 100, 64);
    EXPECT_EQ(flat.cells, (std::array<int, 3>{10, 10, 1}));
    const CellGrid point(Box3{{3, 4, 5}, {3, 4, 5}}, 100, 64);
    EXPECT_GE(point.size(), 1u);
    EXPECT_TRUE(std::isfinite(point.per_cell_size.x));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
