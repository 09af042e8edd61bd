#include "alhazen/shapes/algebraic/tgc.h"

#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

TEST(Tgc, ARoundOneIsAFrustum) {
    const Tgc t = prepared(Tgc{.height = {0, 0, 2}, .axis_c = {0.5, 0, 0}, .axis_d = {0, 0.5, 0}});
    EXPECT_FALSE(t.quartic);
    testing::expect_near(crossings(t, {0, 0, 1}, {1, 0, 0}), {-0.75, 0.75});
    EXPECT_NEAR(testing::volume_by_rays(t), 2 * kPi * (1 + 0.5 + 0.25) / 3, 1e-2);
}

TEST(Tgc, WhereTheRatiosDifferTheSectionsAreEllipsesAllTheWay) {
    const Tgc t = prepared(Tgc{.axis_c = {2, 0, 0}, .axis_d = {0, 0.5, 0}});
    EXPECT_TRUE(t.quartic);
    for (const double z : {0.25, 0.5, 0.75}) {
        const double a = 1 + z, b = 1 - 0.5 * z;
        testing::expect_near(crossings(t, {0, 0, z}, {1, 0, 0}), {-a, a}, 1e-11);
        testing::expect_near(crossings(t, {0, 0, z}, {0, 1, 0}), {-b, b}, 1e-11);
        const double c = 1 / std::hypot(0.6 / a, 0.8 / b);
        testing::expect_near(crossings(t, {0, 0, z}, {0.6, 0.8, 0}), {-c, c}, 1e-11);
    }
    EXPECT_NEAR(testing::volume_by_rays(t), kPi * 13 / 12, 1e-2);
}

TEST(Tgc, AnEndMayBeALineOrAPoint) {
    // A wedge: the top is the segment y from -1 to 1.
    const Tgc wedge = prepared(Tgc{.axis_c = {0, 0, 0}, .axis_d = {0, 1, 0}});
    testing::expect_near(crossings(wedge, {0, 0, 0.5}, {1, 0, 0}), {-0.5, 0.5}, 1e-11);
    testing::expect_near(crossings(wedge, {0, 0, 0.5}, {0, 1, 0}), {-1, 1}, 1e-11);
    EXPECT_NEAR(testing::volume_by_rays(wedge), kPi / 2, 1e-2);
    const Tgc cone = prepared(Tgc{.axis_c = {0, 0, 0}, .axis_d = {0, 0, 0}});
    EXPECT_NEAR(testing::volume_by_rays(cone), kPi / 3, 1e-2);
    EXPECT_EQ(testing::errors_of(Tgc{.axis_a = {0, 0, 0}, .axis_c = {0, 0, 0}}), 1u);
}

TEST(Tgc, EdgesOfAWedgeAreCrossedEvenlyOften) {
    const Tgc wedge = prepared(Tgc{.axis_c = {0, 0, 0}, .axis_d = {0, 1, 0}});
    testing::Random random(8);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 on_edge{0, random.uniform(-1.2, 1.2), 1};
        const Vec3 d = random.coin() ? random.unit_vector() : random.lattice_direction();
        EXPECT_EQ(crossings(wedge, on_edge - 2 * d, d).size() % 2, 0u) << i;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
