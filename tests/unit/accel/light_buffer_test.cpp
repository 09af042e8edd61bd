#include "alhazen/accel/light_buffer.h"

#include <gtest/gtest.h>

#include "alhazen/math/random.h"

namespace alhazen {
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

/// A hundred small triangles below z = 0, and above them a large one that the light above stands
/// behind.
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

/// Says that nothing is hit, or all.
struct CountingVisitor {
    static constexpr AsksFor kAsksFor = AsksFor::AnyHit;
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
    EXPECT_EQ(made.lights(), 1u);
    CountingVisitor below;
    made.traverse({{0, 0, -1.5}, {0, 0, 4.5}, 0, 1}, below, NoStats{});
    EXPECT_EQ(below.visits, 1);
    // From above the screen nothing is in the way.
    CountingVisitor above;
    made.traverse({{0, 0, 2}, {0, 0, 1}, 0, 1}, above, NoStats{});
    EXPECT_EQ(above.visits, 0);
    // Where the ray ends before the screen, what is behind that counts.
    const LightBuffer open = LightBuffer::build(scene(true), {.full_cells = false});
    std::size_t longer = 0;
    for (std::size_t c = 0; c < made.cells().size(); ++c) {
        EXPECT_EQ(made.cells()[c].count, open.cells()[c].count);
        longer += made.cells()[c].count > made.cells()[c].lit;
    }
    EXPECT_GT(longer, 50u);
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
    const LightBuffer made = LightBuffer::build(scene(false), {.others = OtherRays::Kind::List});
    const auto visits = [&](const Ray& ray) {
        CountingVisitor visitor;
        made.traverse(ray, visitor, NoStats{});
        return visitor.visits;
    };
    const Vec3 from{0.3, 0.2, -3};
    EXPECT_LT(visits({from, Vec3{0, 0, 3} - from, 0, 1}), 20);
    EXPECT_EQ(visits({from, Vec3{0, 0.001, 3} - from, 0, 1}), 100);  // beside it
    EXPECT_EQ(visits({from, Vec3{0, 0, 3} - from, 0, 1.001}), 100);  // and behind it
    EXPECT_EQ(visits({from, from - Vec3{0, 0, 3}, 0, 1}), 100);      // away from it
}

}  // namespace
}  // namespace alhazen
