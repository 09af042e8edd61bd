#include <gtest/gtest.h>

#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/aggregates/wide_bvh/wide_bvh_aggregate.h"
#include "alhazen/base/error.h"
#include "support/thorough.h"
#include "unit/aggregates/compare_aggregates.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace testing;

/// The same primitives at positions that depend on `seed`, as at different times of an animation.
PrimitiveTable moving(double reach, double wander, std::uint64_t seed, bool collapse_one = false) {
    RandomEngine still(51), random(seed);
    TableBuilder builder;
    for (int i = 0; i < 600; ++i) {
        const Vec3 a = uniform_point(still, 1), b = uniform_point(still, 0.3),
                   c = uniform_point(still, 0.3);
        const Vec3 p = reach * (a + uniform_point(random, wander));
        const Vec3 q = collapse_one && i == 7 ? p : p + reach * b;
        builder.add_triangle(p, q, p + reach * c, i % 3 != 0);
        if (i % 5 == 0) builder.add_sphere(p, 0.05 * reach, i % 2 == 0);
    }
    builder.add_plane({0, 0, -2 * reach}, {0, 0, 1}, false);
    return builder.finish();
}

void compare(const Aggregate& tested, const PrimitiveTable& table, double reach) {
    const auto list = make_aggregate("list", table);
    EXPECT_EQ(list->box(), tested.box());
    RandomEngine random(52);
    const MakeRay rays = random_rays(reach);
    for (int i = 0; i < 2000; ++i) {
        const Ray ray = rays(random);
        ASSERT_EQ(difference(ask(*list, ray), ask(tested, ray)), "") << i << ": " << show(ray);
    }
}

TEST(Refit, GivesTheHitsOfTheListWhateverThingsMoved) {
    for (const BuildQuality quality :
         {BuildQuality::Fast, BuildQuality::Default, BuildQuality::High}) {
        WideBvhAggregate tree(moving(1, 0, 1), {quality});
        for (const double wander : {0.0, 0.01, 0.3, 3.0}) {
            if (!thorough() && (wander == 0.0 || wander == 0.3)) continue;
            const PrimitiveTable moved = moving(1, wander, 2);
            (void)tree.refit(moved);
            compare(tree, moved, 1 + wander);
        }
        const PrimitiveTable huge = moving(1e9, 0.1, 3);
        (void)tree.refit(huge);
        compare(tree, huge, 1e9);
    }
}

TEST(Refit, TheCostTellsWhenBuildingAnewPays) {
    WideBvhAggregate tree(moving(1, 0, 1));
    EXPECT_EQ(tree.refit(moving(1, 0, 1)).growth, 1.0);
    EXPECT_FALSE(tree.refit(moving(1, 0.01, 2)).rebuild_pays());
    EXPECT_TRUE(tree.refit(moving(1, 2, 2)).rebuild_pays());
    EXPECT_EQ(tree.refit(moving(1, 0, 1)).growth, 1.0) << "back where it was";
}

TEST(Refit, ATriangleWhoseVerticesMeetIsNotHitUntilTheyPart) {
    WideBvhAggregate tree(moving(1, 0, 1));
    const PrimitiveTable met = moving(1, 0, 1, true);
    (void)tree.refit(met);
    compare(tree, met, 1);
    (void)tree.refit(moving(1, 0, 1));
    compare(tree, moving(1, 0, 1), 1);
    // A tree built without a primitive cannot include it by refitting.
    WideBvhAggregate without(met);
    EXPECT_THROW((void)without.refit(moving(1, 0, 1)), Error);
    compare(without, met, 1);
}

TEST(Refit, TrianglesThatVanishFarAwayTakeNothingWithThem) {
    for (const double far : {10.0, 1e30, 1e100, std::numeric_limits<double>::infinity()}) {
        const auto scattered = [far](int alive) {
            RandomEngine random(53);
            TableBuilder builder;
            for (int i = 0; i < 400; ++i) {
                const Vec3 a = uniform_point(random, 1), b = a + uniform_point(random, 0.3);
                const Vec3 c = a + uniform_point(random, 0.3);
                const Vec3 gone{far, -far, far};
                if (i % 20 < alive) {
                    builder.add_triangle(a, b, c);
                } else {
                    builder.add_triangle(gone, gone, c);
                }
            }
            return builder.finish();
        };
        for (const int alive : {19, 10, 1}) {
            WideBvhAggregate tree(scattered(20));
            const PrimitiveTable some = scattered(alive);
            EXPECT_TRUE(std::isfinite(tree.refit(some).cost)) << far;
            compare(tree, some, 1);
        }
    }
}

TEST(Refit, RefusesOtherPrimitives) {
    WideBvhAggregate tree(moving(1, 0, 1));
    EXPECT_THROW((void)tree.refit(random_triangles(10, 1, 0.3, 1)), Error);
    EXPECT_THROW((void)tree.refit(TableBuilder{}.finish()), Error);
    WideBvhAggregate nothing(TableBuilder{}.finish());
    EXPECT_FALSE(nothing.refit(TableBuilder{}.finish()).rebuild_pays());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
