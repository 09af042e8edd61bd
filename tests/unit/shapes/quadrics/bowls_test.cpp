// Paraboloid and both hyperboloids.

#include "alhazen/shapes/quadrics/hyperboloid.h"
#include "alhazen/shapes/quadrics/paraboloid.h"
#include "alhazen/shapes/quadrics/two_sheet_hyperboloid.h"
#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

TEST(Paraboloid, WidensWithTheRootOfTheHeight) {
    const Paraboloid p =
        prepared(Paraboloid{.rim = {0, 0, 4}, .axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}});
    testing::expect_near(crossings(p, {0, 0, 1}, {1, 0, 0}), {-1, 1});
    testing::expect_near(crossings(p, {0, 0, 1}, {0, 1, 0}), {-0.5, 0.5});
    testing::expect_near(crossings(p, {0, 0, -1}, {0, 0, 1}), {1, 5});
    testing::expect_near(crossings(p, {1, 0, -1}, {0, 0, 1}), {2, 5});
    EXPECT_TRUE(crossings(p, {0, 0, -0.001}, {1, 0, 0}).empty());
    EXPECT_NEAR(testing::volume_by_rays(p), 0.5 * kPi * 2 * 4, 3e-2);
    EXPECT_NEAR(testing::first_normal(p, {0, 0, -1}, {0, 0, 1}).z, -1, 1e-12);
}

TEST(Hyperboloid, IsNarrowestInTheMiddle) {
    const Hyperboloid h = prepared(Hyperboloid{.waist = 0.6});
    testing::expect_near(crossings(h, {0, 0, 0}, {1, 0, 0}), {-0.6, 0.6});
    const double half = std::sqrt(0.36 + 0.64 * 0.25);
    testing::expect_near(crossings(h, {0, 0, 0.5}, {0, 1, 0}), {-half, half});
    testing::expect_near(crossings(h, {0, 0, -4}, {0, 0, 1}), {3, 5});
    EXPECT_NEAR(testing::volume_by_rays(h), 2 * kPi * (0.36 + 0.64 / 3), 1e-2);
    // Leaves the bowl above the waist and enters it again.
    EXPECT_EQ(crossings(h, {0.8, 0, -2}, {0, 0, 1}).size(), 4u);
}

TEST(Hyperboloid, LinesThatLieInItCrossEvenlyOften) {
    const Hyperboloid h = prepared(Hyperboloid{.waist = 0.6});
    for (int i = 0; i < 360; ++i) {
        // x^2 + y^2 = 0.36 + 0.64 z^2 holds for (0.6, 0.8 z, z) at all z.
        const double a = kPi * i / 180, c = std::cos(a), s = std::sin(a);
        const auto turned = [&](const Vec3& v) {
            return Vec3{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
        };
        const auto t = crossings(h, turned({0.6, 0, 0}), turned({0, 0.8, 1}));
        EXPECT_EQ(t.size() % 2, 0u) << i;
        for (const double at : t) EXPECT_LE(std::abs(at), 1 + 1e-12);
    }
}

TEST(TwoSheetHyperboloid, IsTwoBowlsWithAGap) {
    const double w = 0.25;
    const TwoSheetHyperboloid h = prepared(TwoSheetHyperboloid{.gap = w});
    testing::expect_near(crossings(h, {0, 0, 0}, {0, 0, 1}), {-1, -w, w, 1});
    EXPECT_TRUE(crossings(h, {0, 0, 0}, {1, 0, 0}).empty());
    const double half = std::sqrt((0.25 - w * w) / (1 - w * w));
    testing::expect_near(crossings(h, {0, 0, 0.5}, {1, 0, 0}), {-half, half});
    const double volume = 2 * kPi / (1 - w * w) * (1.0 / 3 - w * w + 2 * w * w * w / 3);
    EXPECT_NEAR(testing::volume_by_rays(h), volume, 5e-3 * volume);
}

TEST(Bowls, FieldsOutOfRangeAreRefused) {
    EXPECT_EQ(testing::errors_of(Hyperboloid{.waist = 1.0}), 1u);
    EXPECT_EQ(testing::errors_of(TwoSheetHyperboloid{.gap = 0.0}), 1u);
    EXPECT_EQ(testing::errors_of(Paraboloid{.rim = {0, 0, 0}}), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
