#include "alhazen/shapes/quadrics/ellipsoid.h"

#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

TEST(Ellipsoid, IsCrossedAtItsSemiAxes) {
    const Ellipsoid e = prepared(Ellipsoid{
        .center = {1, 2, 3}, .axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}, .axis_c = {0, 0, 3}});
    testing::expect_near(crossings(e, {0, 2, 3}, {1, 0, 0}), {-1, 3});
    testing::expect_near(crossings(e, {1, 0, 3}, {0, 2, 0}), {0.5, 1.5});
    testing::expect_near(crossings(e, {1, 2, 0}, {0, 0, -1}), {-6, 0});
    // At x = 1 from the centre the sections are sqrt(3) / 2 as large.
    testing::expect_near(crossings(e, {2, 2, 3}, {0, 1, 0}), {-std::sqrt(0.75), std::sqrt(0.75)});
    EXPECT_TRUE(crossings(e, {1, 3.0000001, 3}, {1, 0, 0}).empty());
    // A tangent has no crossing, or two at one point.
    EXPECT_TRUE(crossings(e, {0, 3, 3}, {1, 0, 0}).size() % 2 == 0);
}

TEST(Ellipsoid, OfObliqueAxesHasTheVolumeOfTheirDeterminant) {
    const Ellipsoid e =
        prepared(Ellipsoid{.axis_a = {1, 0.5, 0}, .axis_b = {-0.3, 1, 0.2}, .axis_c = {0.4, 0, 2}});
    const double volume = dot(e.axis_a, cross(e.axis_b, e.axis_c));
    EXPECT_NEAR(testing::volume_by_rays(e), 4.0 / 3.0 * kPi * volume, 2e-3 * volume);
    // The ends of the semi-axes lie on the surface.
    for (const Vec3& axis : {e.axis_a, e.axis_b, e.axis_c}) {
        testing::expect_near(crossings(e, {}, axis), {-1, 1});
    }
}

TEST(Ellipsoid, NormalsPointAlongTheGradient) {
    const Ellipsoid e =
        prepared(Ellipsoid{.axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}, .axis_c = {0, 0, 1}});
    // At the surface point (sqrt 2, 1 / sqrt 2, 0) the gradient is (x / 4, y, z).
    const Vec3 p{std::sqrt(2.0), std::sqrt(0.5), 0};
    const Vec3 n = testing::first_normal(e, 3 * p, -p);
    const Vec3 expected = normalize(Vec3{p.x / 4, p.y, 0});
    EXPECT_NEAR(length(n - expected), 0, 1e-12);
}

TEST(Ellipsoid, FlatOnesAreRefused) {
    EXPECT_EQ(testing::errors_of(Ellipsoid{.axis_c = {0, 0, 0}}), 1u);
    EXPECT_EQ(testing::errors_of(Ellipsoid{.axis_c = {1, 1, 0}}), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
