#include "alhazen/geometry/cones/wavefront_curvature.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/cones/cone_ray.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(WavefrontCurvature, AFlatMirrorKeepsTheCone) {
    EXPECT_DOUBLE_EQ(mirrored_spread(0.2, 0.03, 0.5, {}), 0.03);
    EXPECT_DOUBLE_EQ(mirrored_spread(0.2, -0.03, 0.5, {}), -0.03);
}

TEST(WavefrontCurvature, AFlatSurfaceMovesTheApexByTheIndex) {
    // Straight through: the apex is n' / n times as far.
    const RefractedCone cone = refracted_cone(0.2, 0.02, 1, 1, 1 / 1.5, {});
    EXPECT_DOUBLE_EQ(cone.radius, 0.2);
    EXPECT_DOUBLE_EQ(cone.radius / cone.spread, 10 * 1.5);
    const RefractedCone same = refracted_cone(0.2, 0.02, 0.6, 0.6, 1, {});
    EXPECT_NEAR(same.spread, 0.02, 1e-15);
    EXPECT_NEAR(same.radius, 0.2, 1e-15);
}

TEST(WavefrontCurvature, AMirrorHasItsFocusAtHalfItsRadius) {
    // Parallel light on a convex mirror of radius 4 comes from 2 behind it.
    const double spread = mirrored_spread(0.1, 0.0, 1.0, {0.25, 0.25});
    EXPECT_DOUBLE_EQ(0.1 / spread, 2.0);
    const double concave = mirrored_spread(0.1, 0.0, 1.0, {-0.25, -0.25});
    EXPECT_DOUBLE_EQ(0.1 / concave, -2.0);
}

TEST(WavefrontCurvature, ABallLensFocusesAtItsFocalLength) {
    // n R / (2 (n - 1)) from the centre of the ball.
    const double n = 1.5, R = 2, radius = 0.01;
    const RefractedCone in = refracted_cone(radius, 0, 1, 1, 1 / n, {1 / R, 1 / R});
    const double at_exit = in.radius + 2 * R * in.spread;
    const RefractedCone out = refracted_cone(at_exit, in.spread, 1, 1, n, {-1 / R, -1 / R});
    EXPECT_NEAR(-out.radius / out.spread + R, n * R / (2 * (n - 1)), 1e-12);
}

TEST(WavefrontCurvature, ThePlaneOfIncidenceFollowsCoddington) {
    // 1 / s + 1 / s' = 2 / (rho cos), sagittal 2 cos / rho, rho = 3, s = 5, cos = 0.6.
    const double radius = 0.05, s = 5, c = 0.6, rho = 3;
    const double t = 1 / s + 2 / (rho * c), sagittal = 1 / s + 2 * c / rho;
    EXPECT_NEAR(mirrored_spread(radius, radius / s, c, {1 / rho, 1 / rho}),
                radius * std::sqrt(t * sagittal), 1e-15);
}

TEST(WavefrontCurvature, DullSurfacesWiden) {
    EXPECT_DOUBLE_EQ(widened_spread(0.1, 0.0), 0.1);
    EXPECT_NEAR(widened_spread(0.0, 0.1), std::tan(0.1), 1e-15);
    EXPECT_DOUBLE_EQ(widened_spread(0.5, 2.0), 1.0);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
