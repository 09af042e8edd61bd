#include "alhazen/accel/directions/light_buffer.h"

#include <gtest/gtest.h>

#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// Triangles and a light.
class LitTriangles final : public BoundsSource {
  public:
    std::vector<std::array<Vec3, 3>> triangles;
    std::vector<RayEnd> ends;

    [[nodiscard]] std::size_t size() const override { return triangles.size(); }
    [[nodiscard]] Box3 box(std::size_t i) const override {
        Box3 box;
        for (const Vec3& p : triangles[i]) box.include(p);
        return box;
    }
    [[nodiscard]] std::optional<std::array<Vec3, 3>> triangle(std::size_t i) const override {
        return triangles[i];
    }
    [[nodiscard]] bool blocks_light(std::size_t) const override { return true; }
    [[nodiscard]] std::span<const RayEnd> ray_ends() const override { return ends; }
};

/// A hundred small triangles below z = 0; `with_screen` adds a large one between them and the
/// light.
LitTriangles scene(bool with_screen) {
    LitTriangles made;
    RandomStream random(1);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-2, -1)};
        made.triangles.push_back({p, p + Vec3{0.2, 0, 0}, p + Vec3{0, 0.2, 0.1}});
    }
    if (with_screen) made.triangles.push_back({{{-9, -9, 1}, {9, -9, 1}, {0, 9, 1}}});
    made.ends = {{{0, 0, 3}, false}, {{0, 0, 1}, true}};
    return made;
}

/// Counts visits and reports no hits, or only hits.
struct CountingVisitor {
    [[nodiscard]] static AsksFor asks_for() { return AsksFor::AnyHit; }
    bool blocks = false;
    int visits = 0;
    [[nodiscard]] double t_max() const { return 1; }
    bool visit(std::uint32_t) {
        ++visits;
        return blocks;
    }
};

TEST(LightBuffer, AListEndsAtTheTriangleThatFillsItsCell) {
    const LightBuffer made = LightBuffer::build(scene(true), {.shadow_cache = false});
    EXPECT_EQ(made.lights().size(), 1u);
    CountingVisitor below{true, 0};
    made.traverse({{0, 0, -1.5}, {0, 0, 4.5}, 0, 1}, below, NoStats{});
    EXPECT_EQ(below.visits, 1);
    // From above the screen nothing is visited.
    CountingVisitor above;
    made.traverse({{0, 0, 2}, {0, 0, 1}, 0, 1}, above, NoStats{});
    EXPECT_EQ(above.visits, 0);
    // When the ray ends before the screen, the triangles behind it are visited.
    const LightBuffer open = LightBuffer::build(scene(true), {.full_cells = false});
    std::size_t shorter = 0;
    for (std::size_t c = 0; c < made.cells().size(); ++c) {
        EXPECT_LE(made.cells()[c].count, open.cells()[c].count);
        shorter += made.cells()[c].count < open.cells()[c].count;
    }
    EXPECT_GT(shorter, 50u);
}

TEST(LightBuffer, FromFarAwayTheSceneIsDividedAsFinely) {
    const auto mean_list = [](double distance) {
        LitTriangles made = scene(false);
        made.ends = {{{distance, 0.3 * distance, 0.8 * distance}, false}};
        const LightBuffer buffer = LightBuffer::build(made, {});
        return static_cast<double>(buffer.entries().size()) /
               static_cast<double>(buffer.cells().size());
    };
    EXPECT_LT(mean_list(4), 3);
    EXPECT_LT(mean_list(300), 1.2 * mean_list(4));
}

TEST(LightBuffer, WhatLiesInOnePlaceHasFewCells) {
    constexpr std::size_t kCount = 1000;
    LitTriangles made;
    made.triangles.assign(kCount, {{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}});
    made.ends = {{{0, 0, 3}, false}};
    const LightBuffer buffer = LightBuffer::build(made, {.full_cells = false});
    // 16 cells for each were 8 000 000 entries.
    EXPECT_LT(buffer.entries().size(), 1100 * kCount);
    EXPECT_GT(buffer.entries().size(), 100 * kCount);
}

TEST(DirectionWindows, WhateverIsSeenInABoxLiesInItsCells) {
    RandomStream random(2);
    const auto point = [&](double reach) {
        return Vec3{random.uniform(-reach, reach), random.uniform(-reach, reach),
                    random.uniform(-reach, reach)};
    };
    int outside = 0;
    for (int i = 0; i < 200; ++i) {
        DirectionWindows windows;
        std::vector<Box3> boxes(5);
        const Vec3 offset = point(3);
        for (Box3& box : boxes) {
            box.include(offset + point(1));
            box.include(box.lo + point(i % 2 == 0 ? 0.5 : 0.0));
            windows.include(box);
        }
        windows.divide(0.02, 50);
        for (const Box3& box : boxes) {
            for (int k = 0; k < 20; ++k) {
                Vec3 p;
                for (int a = 0; a < 3; ++a) p[a] = random.uniform(box.lo[a], box.hi[a]);
                const std::size_t cell = windows.cell_of(p);
                ASSERT_NE(cell, DirectionWindows::kNone);
                bool found = false;
                for (int face = 0; face < 6; ++face) {
                    const auto slopes = DirectionWindows::slopes_of(box, face);
                    if (!slopes) continue;
                    const auto [columns, rows] = windows.cells_of(*slopes, face)->ends;
                    for (int row = rows[0]; row <= rows[1]; ++row) {
                        for (int column = columns[0]; column <= columns[1]; ++column) {
                            if (windows.number(face, column, row) != cell) continue;
                            found = true;
                            const auto at = windows.slopes_of_cell(face, column, row);
                            EXPECT_LE(DirectionWindows::depth_of(box, face, at),
                                      (1 + 1e-12) * max_component(abs(p)));
                        }
                    }
                }
                EXPECT_TRUE(found) << "scene " << i;
            }
        }
        outside += windows.cell_of(-(offset + 0.1 * point(1))) == DirectionWindows::kNone;
    }
    EXPECT_GT(outside, 50);
}

TEST(LightBuffer, TheLastOccluderIsTestedFirst) {
    const LightBuffer made = LightBuffer::build(scene(true), {});
    TraversalStats stats;
    for (int i = 0; i < 10; ++i) {
        CountingVisitor visitor{true, 0};
        made.traverse({{0.01 * i, 0, -1.5}, {-0.01 * i, 0, 4.5}, 0, 1}, visitor,
                      CountingStats{&stats});
        EXPECT_EQ(visitor.visits, 1);
    }
    EXPECT_EQ(stats.cache_lookups, 10u);
    EXPECT_EQ(stats.cache_hits, 9u);
}

TEST(LightBuffer, OnlyRaysToTheLightAreLookedUp) {
    const LightBuffer made =
        LightBuffer::build(scene(false), {.others = FallbackAccelerator::Kind::List});
    const auto visits = [&](const Ray& ray) {
        CountingVisitor visitor;
        made.traverse(ray, visitor, NoStats{});
        return visitor.visits;
    };
    const Vec3 from{0.3, 0.2, -3};
    EXPECT_LT(visits({from, Vec3{0, 0, 3} - from, 0, 1}), 20);
    EXPECT_EQ(visits({from, Vec3{0, 0.001, 3} - from, 0, 1}), 100);  // past the screen's edge
    EXPECT_EQ(visits({from, Vec3{0, 0, 3} - from, 0, 1.001}), 100);  // behind the light
    EXPECT_EQ(visits({from, from - Vec3{0, 0, 3}, 0, 1}), 100);      // away from the light
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
