/// Samples of single emitters: by area or by solid angle.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "alhazen/illumination/emitter.h"
#include "alhazen/illumination/spherical_polygons.h"
#include "alhazen/sampling/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

// Where the solid angle is certain to be small it is not computed; the bits are the same.
TEST(Emitters, FarOnesAreSampledAsTheirSolidAngleSays) {
    RandomStream random(11);
    int far = 0, near = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto vector = [&](double size) {
            return size * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        };
        Emitter e;
        e.form = i % 2 == 0 ? EmitterForm::Triangle : EmitterForm::Rectangle;
        e.two_sided = i % 3 == 0;
        e.radiance = {1, 1, 1};
        const double size = std::exp(random.uniform(-7, 3));
        const Vec3 x = vector(size);
        Vec3 y = vector(size);
        if (e.form == EmitterForm::Rectangle) y = cross(x, y) / length(x);
        e.world_from_own.linear = {x, y, normalize(cross(x, y))};
        e.world_from_own.translation = vector(2.0);
        if (!make_ready(e)) continue;
        Emitter unknown = e;
        unknown.far_squared = std::numeric_limits<double>::infinity();
        const double distance = std::sqrt(e.far_squared) * std::exp(random.uniform(-1, 1));
        const Vec3 from = e.world_from_own.translation + distance * normalize(vector(1.0));
        const Vec2 u{random.uniform(0, 1), random.uniform(0, 1)};
        const EmitterSample a = sample(e, from, u), b = sample(unknown, from, u);
        ASSERT_EQ(a.density, b.density) << i;
        ASSERT_EQ(a.to_light, b.to_light) << i;
        ASSERT_EQ(a.distance, b.distance) << i;
        const EmitterHit hit{a.to_light, a.distance, e.world_from_own.linear.z_axis, a.parameters};
        ASSERT_EQ(density(e, from, hit), density(unknown, from, hit)) << i;
        ++(is_sampled_by_area(e, from) ? far : near);
    }
    EXPECT_GT(far, 5000);
    EXPECT_GT(near, 5000);
}

// The mean of 1 / density is the solid angle, whichever way is preferred.
TEST(Emitters, ThoseThatPreferAreaHaveTheSameSolidAngle) {
    RandomStream random(12);
    int by_area = 0;
    for (int i = 0; i < 2000; ++i) {
        const auto vector = [&] {
            return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        };
        Emitter e;
        e.form = i % 2 == 0 ? EmitterForm::Triangle : EmitterForm::Rectangle;
        e.two_sided = true;
        e.radiance = {1, 1, 1};
        const Vec3 x = vector();
        Vec3 y = vector();
        if (e.form == EmitterForm::Rectangle) y = cross(x, y) / length(x);
        e.world_from_own.linear = {x, y, normalize(cross(x, y))};
        ASSERT_TRUE(make_ready(e));
        const double edges = length(x) + length(y);
        const Vec3 away = normalize(vector());
        if (std::abs(dot(away, e.world_from_own.linear.z_axis)) < 0.01) continue;
        const Vec3 from = (edges * random.uniform(4, 16)) * away;
        const double solid_angle =
            e.form == EmitterForm::Triangle
                ? SphericalTriangle(-from, x - from, y - from).solid_angle()
                : SphericalRectangle(-from, RectangleSides::of(x, y)).solid_angle();
        prefer_area(e);
        EXPECT_EQ(is_sampled_by_area(e, from) ||
                  solid_angle<kLeastSolidAngle, length(from)> 8.0 * edges ||
                  solid_angle < kLeastSolidAngle);
        by_area += is_sampled_by_area(e, from) && solid_angle > 1.1 * kLeastSolidAngle;
        constexpr int kGrid = 16;
        double sum = 0.0;
        for (int k = 0; k < kGrid * kGrid; ++k) {
            const Vec2 u{(k % kGrid + 0.5) / kGrid, (k / kGrid + 0.5) / kGrid};
            const EmitterSample s = sample(e, from, u);
            const EmitterHit hit{s.to_light, s.distance, e.world_from_own.linear.z_axis,
                                 s.parameters};
            EXPECT_NEAR(density(e, from, hit), s.density, 1e-9 * s.density) << i;
            sum += 1.0 / s.density;
        }
        EXPECT_NEAR(sum / (kGrid * kGrid), solid_angle, 1e-3 * solid_angle) << i;
    }
    EXPECT_GT(by_area, 200);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
