#include "alhazen/renderers/core/refraction.h"

#include <gtest/gtest.h>

#include <numbers>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

Vec3 at_angle(double degrees) {
    const double a = degrees * std::numbers::pi / 180.0;
    return {std::sin(a), 0, -std::cos(a)};
}

TEST(Refraction, ObeysSnell) {
    for (double degrees = 0; degrees < 90; degrees += 7.5) {
        Vec3 t;
        ASSERT_TRUE(refract(at_angle(degrees), {0, 0, 1}, 1.0 / 1.5, t));
        EXPECT_NEAR(t.x * 1.5, at_angle(degrees).x, 1e-15);
        EXPECT_NEAR(length(t), 1.0, 1e-15);
        EXPECT_LT(t.z, 0.0);
    }
}

TEST(Refraction, TheCriticalAngleOfCrownGlassIsWhereTotalReflectionBegins) {
    const double critical = std::asin(1.0 / 1.52) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(critical, 41.14, 0.005);
    Vec3 t;
    EXPECT_TRUE(refract(at_angle(critical - 1e-6), {0, 0, 1}, 1.52, t));
    EXPECT_FALSE(refract(at_angle(critical + 1e-6), {0, 0, 1}, 1.52, t));
}

TEST(Refraction, AMirrorKeepsTheTangentAndTurnsTheNormalPart) {
    const Vec3 r = mirror(at_angle(30), {0, 0, 1});
    EXPECT_NEAR(r.x, 0.5, 1e-15);
    EXPECT_NEAR(r.z, std::cos(std::numbers::pi / 6), 1e-15);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
