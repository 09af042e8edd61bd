/// Bounds tighter than boxes: no point of a primitive may be outside.

#include <gtest/gtest.h>

#include "support/scene_maker.h"
#include "unit/aggregates/random_tables.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

Box3 random_cell(RandomEngine& random, double reach) {
    Box3 cell;
    cell.include(uniform_point(random, reach));
    cell.include(cell.lo + uniform(random, 0.01, 0.5) * Vec3{1, 0.5, 2});
    return cell;
}

TEST(PrimitiveBounds, ATriangleOverlapsACellJustWhereItHasAPointInIt) {
    RandomEngine random(1);
    int overlapping = 0, apart = 0;
    for (int i = 0; i < 3000; ++i) {
        TableBuilder builder;
        const Vec3 a = uniform_point(random, 1), b = uniform_point(random, 1),
                   c = uniform_point(random, 1);
        builder.add_triangle(a, b, c);
        const PrimitiveTable table = builder.finish();
        const Box3 cell = random_cell(random, 1);
        // Reference result: the part in the cell, found by clipping.
        const bool has_part = !table.clipped_box(0, cell).empty();
        EXPECT_EQ(table.overlaps(0, cell), has_part) << "triangle " << i;
        overlapping += has_part;
        apart += !has_part && table.BoundsSource::overlaps(0, cell);
        for (int s = 0; s < 50; ++s) {
            double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            const Vec3 p = a + u * (b - a) + v * (c - a);
            if (!cell.contains(p)) continue;
            EXPECT_TRUE(table.overlaps(0, cell)) << "triangle " << i;
            EXPECT_TRUE(table.clipped_box(0, cell).contains(p)) << "triangle " << i;
        }
    }
    EXPECT_GT(overlapping, 200);
    EXPECT_GT(apart, 200);  // the boxes overlap, the triangle is outside
}

TEST(PrimitiveBounds, ASphereOverlapsTheCellsThatItsSurfaceIsIn) {
    TableBuilder builder;
    builder.add_sphere({1, 2, 3}, 2);
    const PrimitiveTable table = builder.finish();
    EXPECT_TRUE(table.overlaps(0, {{2.9, 2, 3}, {3.1, 2.1, 3.1}}));
    EXPECT_FALSE(table.overlaps(0, {{0, 1, 2}, {2, 3, 4}}));        // all inside
    EXPECT_FALSE(table.overlaps(0, {{2.5, 3.5, 4.5}, {3, 4, 5}}));  // in the box's corner
    EXPECT_TRUE(table.overlaps(0, {{-9, -9, -9}, {9, 9, 9}}));
    RandomEngine random(2);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p = Vec3{1, 2, 3} + 2 * normalize(uniform_point(random, 1));
        Box3 cell;
        cell.include(p);
        cell.include(p + uniform_point(random, i % 2 == 0 ? 1e-15 : 1));
        EXPECT_TRUE(table.overlaps(0, cell)) << i;
    }
    const BoundingSphere sphere = table.sphere(0);
    EXPECT_EQ(sphere.center, (Vec3{1, 2, 3}));
    EXPECT_NEAR(sphere.radius, 2, 1e-14);
}

TEST(PrimitiveBounds, OfSolidsThatASphereHoldsTheSphereIsKnown) {
    const auto sphere_of = [](const Affine& placement, bool holds, double stretch) {
        SceneMaker maker;
        maker.material({});
        const ObjectIndex object = maker.object("solid");
        maker.description().objects[static_cast<std::size_t>(object)].combine =
            holds ? Combine::Difference : Combine::Union;
        maker.add(Sphere{{0.5, 0, 0}, 0.7}, MaterialId{0}, {}, object);
        maker.add(BoxShape{{0, 0, 0}, {1, 1, 1}}, MaterialId{0}, {}, object);
        maker.add(object, MaterialId{0}, placement);
        const Scene scene = maker.compile();
        const PrimitiveTable& table = scene.aggregate->primitives();
        const BoundingSphere sphere = table.sphere(0);
        if (holds) {
            // Tolerance: the distance of crossings that count as one.
            EXPECT_NEAR(sphere.radius, 0.7 * stretch, 1e-9);
            EXPECT_NEAR(length(sphere.center - placement.point({0.5, 0, 0})), 0, 1e-9);
        }
        // Rays towards it find nothing outside it.
        RandomEngine random(3);
        int found = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3 from = sphere.center + uniform_point(random, 9 * stretch);
            const Vec3 to = sphere.center + uniform_point(random, stretch);
            const Ray ray{from, to - from};
            std::vector<Hit> hits;
            scene.aggregate->all_hits(ray, hits, nullptr);
            for (const Hit& hit : hits) {
                ++found;
                EXPECT_LE(length(ray.at(hit.t) - sphere.center), (1 + 1e-12) * sphere.radius);
            }
        }
        EXPECT_GT(found, 200);
    };
    const Affine turned = Affine::translate({3, 2, 1}) * Affine::rotate({0.3, 1, 0.2}, 0.7);
    for (const bool holds : {true, false}) {
        sphere_of({}, holds, 1);
        sphere_of(turned, holds, 1);
        sphere_of(turned * Affine::scale({5, 5, 5}), holds, 5);
    }
    // Longer along one axis: a sphere is less tight.
    sphere_of(turned * Affine::scale({1, 0.7, 1.4}), false, 1.4);
}

TEST(PrimitiveBounds, OnlyWhatIsOpaqueAndSeenByAllRaysBlocksLight) {
    TableBuilder builder;
    builder.add_sphere({0, 0, 0}, 1, true);
    builder.add_sphere({0, 0, 0}, 1, false);
    builder.add_sphere({0, 0, 0}, 1, true);
    std::get<ShapeColumn<Sphere>>(builder.table.columns).set_last_visible_to(1);
    const PrimitiveTable table = builder.finish();
    EXPECT_TRUE(table.blocks_light(0));
    EXPECT_FALSE(table.blocks_light(1));
    EXPECT_FALSE(table.blocks_light(2));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
