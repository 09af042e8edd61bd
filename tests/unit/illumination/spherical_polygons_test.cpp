#include "alhazen/illumination/spherical_polygons.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "alhazen/illumination/emitter.h"
#include "alhazen/math/constants.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

SphericalRectangle rectangle(const Vec3& corner, const Vec3& edge_u, const Vec3& edge_v) {
    return {corner, RectangleSides::of(edge_u, edge_v)};
}

using namespace alhazen::testing;

TEST(SphericalPolygons, AnOctantAndACubeHaveTheirSolidAngles) {
    EXPECT_NEAR(SphericalTriangle({2, 0, 0}, {0, 3, 0}, {0, 0, 0.1}).solid_angle(), kPi / 2, 1e-14);
    EXPECT_NEAR(rectangle({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}).solid_angle(), 4 * kPi / 6, 1e-14);
    EXPECT_EQ(SphericalTriangle({1, 0, 0}, {2, 0, 0}, {3, 0, 0}).solid_angle(), 0.0);
    EXPECT_EQ(rectangle({1, 0, 0}, {1, 0, 0}, {0, 1, 0}).solid_angle(), 0.0);
}

TEST(SphericalPolygons, ARectangleIsTwoTriangles) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 x = random.unit_vector();
        const Vec3 y = perpendicular(x),
                   corner = random.log_uniform(0.05, 5) * random.unit_vector();
        const Vec3 u = random.log_uniform(0.1, 3) * x, v = random.log_uniform(0.1, 3) * y;
        const double two = SphericalTriangle(corner, corner + u, corner + u + v).solid_angle() +
                           SphericalTriangle(corner, corner + u + v, corner + v).solid_angle();
        const double one = rectangle(corner, u, v).solid_angle();
        EXPECT_NEAR(one, two, 1e-13) << i;
    }
}

/// The solid angle of the rectangle from x0 to x1 and y0 to y1 at a height.
long double solid_angle(double x0, double x1, double y0, double y1, long double height) {
    const auto from_foot = [&](long double x, long double y) {
        const long double distance = std::sqrt(x * x + y * y + height * height);
        return std::atan2(x * y, height * distance);
    };
    return from_foot(x1, y1) - from_foot(x0, y1) - from_foot(x1, y0) + from_foot(x0, y0);
}

TEST(SphericalPolygons, SolidAnglesOfRectanglesAreExactFromEverywhere) {
    Random random(4);
    double largest = 0;
    for (int i = 0; i < 20000; ++i) {
        // Seen from far and near, nearly edge on, and from points that almost touch it.
        const double height = random.log_uniform(1e-8, 100);
        const double width = random.log_uniform(1e-3, 3), depth = random.log_uniform(1e-3, 3);
        const double x = -width * random.uniform(-2, 3), y = -depth * random.uniform(-2, 3);
        const SphericalRectangle seen({x, y, -height},
                                      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, width, depth});
        const long double exact = solid_angle(x, x + width, y, y + depth, height);
        EXPECT_NEAR(seen.solid_angle(), static_cast<double>(exact), 4e-15) << i;
        largest = std::max(largest, seen.solid_angle());
    }
    EXPECT_GT(largest, 2 * kPi - 1e-3);
}

TEST(SphericalPolygons, TheFirstNumberIsTheShareOfARectangleBeforeTheDraw) {
    Random random(7);
    for (int i = 0; i < 20000; ++i) {
        const double height = random.log_uniform(1e-3, 10);
        const double width = random.log_uniform(0.1, 3), depth = random.log_uniform(0.1, 3);
        const double x = -width * random.uniform(-1, 2), y = -depth * random.uniform(-1, 2);
        const SphericalRectangle seen({x, y, -height},
                                      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, width, depth});
        if (!(seen.solid_angle() > kLeastSolidAngle)) continue;
        const Vec2 u{random.uniform(0, 1), random.uniform(0, 1)};
        const Vec3 drawn = seen.point(u);
        const long double before = solid_angle(x, drawn.x, y, y + depth, height);
        EXPECT_NEAR(static_cast<double>(before / seen.solid_angle()), u.x, 1e-7) << i;
        // The second is that of the height over the plane of the first.
        const auto rise = [&](double at) {
            return at / std::sqrt(drawn.x * drawn.x + height * height + at * at);
        };
        const double share = (rise(drawn.y) - rise(y)) / (rise(y + depth) - rise(y));
        EXPECT_NEAR(share, u.y, 1e-7) << i;
        EXPECT_EQ(drawn.z, -height);
    }
}

/// Samples from points near and far, facing the emitter and edge-on, lie on the emitter at the
/// reported place.
void expect_on_emitter(EmitterForm form, std::uint64_t seed) {
    Random random(seed);
    int drawn = 0;
    for (int i = 0; i < 20000; ++i) {
        Emitter e;
        e.form = form;
        e.two_sided = true;
        const double size = random.log_uniform(1e-3, 1e3);
        const Vec3 x = random.unit_vector();
        const Vec3 y = form == EmitterForm::Rectangle ? perpendicular(x) : random.unit_vector();
        e.world_from_own.translation = size * random.unit_vector();
        e.world_from_own.linear = {size * x, size * random.log_uniform(0.01, 1) * y,
                                   normalize(cross(x, y))};
        if (!make_ready(e)) continue;
        const Vec3 on = e.world_from_own.point({random.log_uniform(0.01, 2), 0.3, 0});
        const Vec3 from = on + size * random.log_uniform(1e-6, 100) * random.unit_vector();
        const auto unit = [&] { return random.log_uniform(1e-4, 1) * 0.999999; };
        const EmitterSample s = sample(e, from, {unit(), unit()});
        if (!(s.density > 0.0)) continue;
        ++drawn;
        ASSERT_TRUE(std::isfinite(s.density) && std::isfinite(s.distance)) << i;
        ASSERT_NEAR(length(s.to_light), 1.0, 1e-12);
        const Vec3 own = inverse(e.world_from_own.linear) *
                         (from + s.distance * s.to_light - e.world_from_own.translation);
        const double slack = 1e-5;
        EXPECT_NEAR(own.z, 0.0, slack * (size + s.distance)) << i;
        EXPECT_GT(own.x, -slack) << i;
        EXPECT_GT(own.y, -slack) << i;
        EXPECT_LT(form == EmitterForm::Triangle ? own.x + own.y : std::max(own.x, own.y),
                  1.0 + slack)
            << i;
        const EmitterHit hit{s.to_light, s.distance, e.world_from_own.linear.z_axis, s.parameters};
        EXPECT_NEAR(density(e, from, hit) / s.density, 1.0, 1e-9) << i;
        if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GT(drawn, 19000);
}

TEST(SphericalPolygons, DrawsFromAnywhereLieOnTheTriangle) {
    expect_on_emitter(EmitterForm::Triangle, 2);
}

TEST(SphericalPolygons, DrawsFromAnywhereLieOnTheRectangle) {
    expect_on_emitter(EmitterForm::Rectangle, 3);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
