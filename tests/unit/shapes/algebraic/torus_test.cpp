#include "alhazen/shapes/algebraic/torus.h"

#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::prepared;

TEST(Torus, IsCrossedOnBothSidesOfItsHole) {
    const Torus t = prepared(Torus{.major_radius = 2, .minor_radius = 0.5});
    testing::expect_near(crossings(t, {0, 0, 0}, {1, 0, 0}), {-2.5, -1.5, 1.5, 2.5});
    testing::expect_near(crossings(t, {2, 0, 0}, {0, 0, 1}), {-0.5, 0.5});
    EXPECT_TRUE(crossings(t, {0, 0, 0}, {0, 0, 1}).empty());
    // A line tangent to the tube at its top, and one just below it.
    EXPECT_EQ(crossings(t, {0, 0, 0.5}, {1, 0, 0}).size() % 2, 0u);
    EXPECT_EQ(crossings(t, {0, 0, 0.4999}, {1, 0, 0}).size(), 4u);
    EXPECT_NEAR(testing::volume_by_rays(t), 2 * kPi * kPi * 2 * 0.25, 2e-2);
}

TEST(Torus, PointsLieOnTheTubeAndNormalsPointAwayFromItsCircle) {
    testing::Random random(6);
    for (int i = 0; i < 20000; ++i) {
        const double minor = random.log_uniform(1e-5, 1);
        const Torus t = prepared(Torus{.center = random.in_cube(3),
                                       .axis = random.unit_vector(),
                                       .major_radius = 1,
                                       .minor_radius = minor});
        const Vec3 around = perpendicular(t.unit_axis);
        const Ray ray = testing::line(t.center + around + 0.9 * minor * random.in_cube(0.5) -
                                          4 * random.uniform() * random.unit_vector(),
                                      random.unit_vector());
        ShapeHits hits;
        append_hits(t, ray, hits);
        for (const ShapeHit& hit : hits) {
            const ShapeSurface s = t.surface(ray, hit);
            const Vec3 p = s.point - t.center;
            const Vec3 flat = p - dot(p, t.unit_axis) * t.unit_axis;
            const Vec3 from_circle = p - normalize(flat);
            EXPECT_NEAR(length(from_circle), minor, length(s.error)) << i;
            // A thin tube loses its digits to those of its circle.
            EXPECT_NEAR(dot(s.normal, from_circle) / minor, 1, 1e-12 + 1e-14 / minor) << i;
        }
    }
}

TEST(Torus, FieldsOutOfRangeAreRefused) {
    EXPECT_EQ(testing::errors_of(Torus{.major_radius = 1, .minor_radius = 1.5}), 1u);
    EXPECT_EQ(testing::errors_of(Torus{.minor_radius = 0}), 1u);
    EXPECT_EQ(testing::errors_of(Torus{.axis = {0, 0, 0}}), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
