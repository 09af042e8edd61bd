#include "alhazen/accel/cells/bsp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/accel/cells/convex_cell.h"
#include "unit/accel/random_boxes.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

TEST(ConvexCell, ACubeCutAcrossItsDiagonalHasAHexagon) {
    const ConvexCell cube(Box3{{0, 0, 0}, {1, 1, 1}});
    EXPECT_DOUBLE_EQ(cube.area(), 6);
    EXPECT_DOUBLE_EQ(cube.volume(), 1);
    const double hexagon = 3 * std::sqrt(3.0) / 4;  // with edges sqrt(1/2)
    const ConvexCell::Areas areas = cube.areas_of_parts({1, 1, 1}, 1.5);
    EXPECT_NEAR(areas.lower, 3 + hexagon, 1e-14);
    EXPECT_NEAR(areas.upper, 3 + hexagon, 1e-14);
    const ConvexCell lower = cube.lower_part({1, 1, 1}, 1.5);
    EXPECT_NEAR(lower.area(), 3 + hexagon, 1e-14);
    EXPECT_NEAR(lower.volume(), 0.5, 1e-14);
    EXPECT_EQ(lower.extent({1, 1, 1}), (Interval{0, 1.5}));
}

TEST(ConvexCell, AreasAreThoseOfThePartsAndVolumesSum) {
    RandomStream random(5);
    for (int i = 0; i < 500; ++i) {
        ConvexCell cell(Box3{{-1, -0.5, 0}, {1, 0.75, 1}});
        for (int cut = 0; cut < 8; ++cut) {
            Vec3 normal;
            for (int k = 0; k < 3; ++k) normal[k] = random.uniform(-1, 1);
            normal = normalize(normal);
            const Interval range = cell.extent(normal);
            const double offset = random.uniform(range.lo, range.hi);
            const ConvexCell lower = cell.lower_part(normal, offset);
            const ConvexCell upper = cell.upper_part(normal, offset);
            const ConvexCell::Areas areas = cell.areas_of_parts(normal, offset);
            EXPECT_NEAR(areas.lower, lower.area(), 1e-12) << i << ", cut " << cut;
            EXPECT_NEAR(areas.upper, upper.area(), 1e-12) << i << ", cut " << cut;
            EXPECT_NEAR(lower.volume() + upper.volume(), cell.volume(), 1e-13) << i;
            cell = lower.volume() > upper.volume() ? lower : upper;
        }
    }
}

/// Long thin triangles in random directions.
class Sticks final : public BoundsSource {
  public:
    explicit Sticks(int count) {
        RandomStream random(6);
        const auto point = [&](double reach) {
            const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
            return Vec3{x, y, random.uniform(-reach, reach)};
        };
        for (int i = 0; i < count; ++i) {
            const Vec3 a = point(1);
            sticks_.push_back({a, point(1), a + point(0.003)});
        }
    }
    [[nodiscard]] std::size_t size() const override { return sticks_.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override {
        Box3 box;
        for (const Vec3& p : sticks_[i]) box.include(p);
        return box;
    }
    [[nodiscard]] Interval extent(std::size_t i, const Vec3& axis) const override {
        Interval range;
        for (const Vec3& p : sticks_[i]) range.include(dot(axis, p));
        return range;
    }
    [[nodiscard]] std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const override {
        return sticks_[i];
    }

  private:
    std::vector<std::array<Vec3, 3>> sticks_;
};

/// Calls leaf(node, cell) for every leaf below `node`.
template <class Leaf>
void for_leaves(const Bsp& tree, std::uint32_t node, const ConvexCell& cell, const Leaf& leaf) {
    const Bsp::Node& n = tree.nodes()[node];
    if (n.is_leaf()) return leaf(n, cell);
    const Vec3& normal = tree.normals()[n.normal];
    for_leaves(tree, node + 1, cell.lower_part(normal, n.offset), leaf);
    for_leaves(tree, n.index, cell.upper_part(normal, n.offset), leaf);
}

TEST(Bsp, TheCellsOfLeavesFillTheRoot) {
    for (const bool polygons : {false, true}) {
        const Bsp tree = Bsp::build(Sticks(200), {.directions = polygons ? 3 : 13,
                                                  .polygons = polygons,
                                                  .axis_cost = 1,
                                                  .traversal_cost = 1});
        ASSERT_GT(tree.nodes().size(), 30u);
        const ConvexCell root(tree.box());
        double volume = 0;
        for_leaves(tree, 0, root,
                   [&](const Bsp::Node&, const ConvexCell& cell) { volume += cell.volume(); });
        EXPECT_NEAR(volume, root.volume(), 1e-10 * root.volume());
    }
}

TEST(Bsp, ThePlanesLeadEveryPointOfAPrimitiveToALeafThatHasIt) {
    const Sticks sticks(120);
    for (const int directions : {3, 7, 13}) {
        const Bsp tree =
            Bsp::build(sticks, {.directions = directions, .polygons = directions == 3});
        RandomStream random(7);
        for (std::uint32_t i = 0; i < sticks.size(); ++i) {
            const auto [a, b, c] = *sticks.triangle(i);
            for (int s = 0; s < 20; ++s) {
                const double u = random.uniform(), v = (1 - u) * random.uniform();
                const Vec3 p = a + u * (b - a) + v * (c - a);
                std::uint32_t node = 0;
                while (!tree.nodes()[node].is_leaf()) {
                    const Bsp::Node& n = tree.nodes()[node];
                    node = dot(tree.normals()[n.normal], p) < n.offset ? node + 1 : n.index;
                }
                const Bsp::Node& leaf = tree.nodes()[node];
                const auto first = tree.entries().begin() + leaf.index;
                EXPECT_NE(std::find(first, first + leaf.count, i), first + leaf.count)
                    << "primitive " << i << " with " << directions << " directions";
            }
        }
    }
}

TEST(Bsp, SlantedThingsAreParedByPlanesOfTheirOwn) {
    // Triangles in parallel diagonal planes, which no axis-aligned plane separates.
    class Slices final : public BoundsSource {
      public:
        [[nodiscard]] std::size_t size() const override { return 64; }
        [[nodiscard]] std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const override {
            const double d = 3.0 + 0.01 * static_cast<double>(i);
            return std::array<Vec3, 3>{{{d, 0, 0}, {0, d, 0}, {0, 0, d}}};
        }
        [[nodiscard]] Box3 box(std::size_t i) const override {
            Box3 box;
            const std::array<Vec3, 3> corners = *triangle(i);
            for (const Vec3& p : corners) box.include(p);
            return box;
        }
    };
    const Slices slices;
    const auto entries = [&](const Bsp::Config& config) {
        return Bsp::build(slices, config).entries().size();
    };
    EXPECT_EQ(entries({.directions = 3, .polygons = true, .traversal_cost = 1}), 64u);
    EXPECT_EQ(entries({.directions = 13, .traversal_cost = 1}), 64u);
    EXPECT_GT(entries({.directions = 3, .axis_cost = 1}), 100u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
