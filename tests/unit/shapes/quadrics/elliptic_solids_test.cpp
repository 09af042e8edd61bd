// The elliptic cylinder and the elliptic cone.

#include "alhazen/shapes/quadrics/elliptic_cone.h"
#include "alhazen/shapes/quadrics/elliptic_cylinder.h"
#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

TEST(EllipticCylinder, SideAndEndsAreWhereTheyWereSaidToBe) {
    const EllipticCylinder c = prepared(EllipticCylinder{
        .base = {0, 0, 1}, .top = {0, 0, 4}, .axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}});
    testing::expect_near(crossings(c, {0, 0, 2}, {1, 0, 0}), {-2, 2});
    testing::expect_near(crossings(c, {0, 0, 2}, {0, 1, 0}), {-1, 1});
    testing::expect_near(crossings(c, {1, 0.5, 0}, {0, 0, 1}), {1, 4});
    EXPECT_TRUE(crossings(c, {2.001, 0, 0}, {0, 0, 1}).empty());
    EXPECT_TRUE(crossings(c, {0, 0, 4.001}, {1, 0, 0}).empty());
    EXPECT_NEAR(testing::first_normal(c, {1, 0.5, 9}, {0, 0, -1}).z, 1, 1e-15);
    EXPECT_NEAR(testing::volume_by_rays(c), 6 * kPi, 2e-2);
}

TEST(EllipticCylinder, AnObliqueOneIsShearedAndAnOpenOneHasNoEnds) {
    EllipticCylinder c{.base = {0, 0, 0}, .top = {3, 0, 2}};
    testing::expect_near(crossings(prepared(c), {0, 0, 1}, {1, 0, 0}), {0.5, 2.5});
    EXPECT_NEAR(testing::volume_by_rays(prepared(c)), 2 * kPi, 1e-2);
    c.capped = false;
    EXPECT_EQ(crossings(prepared(c), {0.2, 0, -1}, {0.1, 0, 1}).size(), 1u);
    EXPECT_FALSE(prepared(c).closed());
}

TEST(EllipticCone, NarrowsEvenlyToItsTop) {
    const EllipticCone c = prepared(
        EllipticCone{.top = {0, 0, 2}, .axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}, .top_scale = 0.5});
    testing::expect_near(crossings(c, {0, 0, 1}, {1, 0, 0}), {-1.5, 1.5});
    testing::expect_near(crossings(c, {0, 0, 1}, {0, 1, 0}), {-0.75, 0.75});
    testing::expect_near(crossings(c, {0, 0, -3}, {0, 0, 1}), {3, 5});
    EXPECT_NEAR(testing::volume_by_rays(c), 2 * kPi * 2 * (1 + 0.5 + 0.25) / 3, 2e-2);
}

TEST(EllipticCone, LinesThroughAnApexCrossEvenlyOften) {
    const EllipticCone c = prepared(EllipticCone{.top = {0, 0, 1}, .axis_a = {2, 0, 0}});
    EXPECT_NEAR(testing::volume_by_rays(c), 2 * kPi / 3, 1e-2);
    testing::Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 d = random.coin() ? random.unit_vector() : random.lattice_direction();
        const std::vector<double> t = crossings(c, Vec3{0, 0, 1} - 3 * d, d);
        EXPECT_EQ(t.size() % 2, 0u) << i;
    }
    // Above the apex there is no second nappe.
    EXPECT_TRUE(crossings(c, {0, 0, 1.5}, {1, 0, 0}).empty());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
