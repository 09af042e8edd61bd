#include "alhazen/shapes/polygons/half_space.h"

#include <gtest/gtest.h>

#include "alhazen/shapes/core/shape_numerics.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Random;

HalfSpace made(const Vec3& point, const Vec3& normal) {
    HalfSpace h{.point = point, .normal = normal};
    h.prepare();
    return h;
}

TEST(HalfSpace, IsCrossedOnceAndSaysOnWhichSideALineBegins) {
    const HalfSpace below = made({0, 0, 2}, {0, 0, 5});
    ShapeHit hit;
    const Ray up = line({1, 2, -8}, {0, 0, 2});
    ASSERT_EQ(below.intersect(up, &hit), 1);
    EXPECT_EQ(hit.t, 5);
    EXPECT_TRUE(below.inside_at_minus_infinity(up));
    EXPECT_FALSE(below.inside_at_minus_infinity(line({1, 2, -8}, {0, 0, -2})));
    EXPECT_EQ(below.surface(up, hit).normal, (Vec3{0, 0, 1}));
}

TEST(HalfSpace, LinesAlongItsFaceAreInsideOrOutsideForGood) {
    const HalfSpace below = made({0, 0, 2}, {0, 0, 1});
    ShapeHit hit;
    const struct {
        double z;
        bool inside;
    } cases[] = {{1.999, true}, {2.0, true}, {2.001, false}};
    for (const auto& c : cases) {
        const Ray along = line({3, 4, c.z}, {1, -2, 0});
        EXPECT_EQ(below.intersect(along, &hit), 0);
        EXPECT_EQ(below.inside_at_minus_infinity(along), c.inside) << c.z;
    }
    // The other side of the plane does not hold its lines.
    const HalfSpace above = made({0, 0, 2}, {0, 0, -1});
    EXPECT_FALSE(above.inside_at_minus_infinity(line({3, 4, 2}, {1, -2, 0})));
}

TEST(HalfSpace, BeginsInsideWhereTheSignOfTheDistanceSaysSo) {
    Random random(31);
    for (int i = 0; i < 10000; ++i) {
        const HalfSpace h = made(random.in_cube(10), random.unit_vector());
        const Ray ray = line(random.in_cube(20), random.unit_vector());
        const Vec3 early = ray.at(-1e9);
        ASSERT_EQ(h.inside_at_minus_infinity(ray), dot(h.normal, early - h.point) < 0) << i;
    }
}

TEST(HalfSpace, ItsBoxHoldsAllThatIsInside) {
    const Box3 box = made({1, 2, 3}, {0, -2, 0}).box();
    EXPECT_EQ(box.hi.y, kInfinity);
    EXPECT_NEAR(box.lo.y, 2, 1e-12);
    EXPECT_EQ(box.lo.x, -kInfinity);
    EXPECT_EQ(made({1, 2, 3}, {1, 1, 0}).box().lo.x, -kInfinity);
    EXPECT_EQ(made({1, 2, 3}, {1, 1, 0}).extent({-1, -1, 0}).hi, kInfinity);
    EXPECT_NEAR(made({1, 2, 3}, {1, 1, 0}).extent({-1, -1, 0}).lo, -3, 1e-12);
}

TEST(HalfSpace, RefusesWhatHasNoNormal) {
    Diagnostics diagnostics;
    HalfSpace{.normal = {0, 0, 0}}.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
