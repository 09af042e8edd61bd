#include "alhazen/cameras/pixel_cones.h"

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/math/constants.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(PixelCones, HaveTheAreaOfTheirPixels) {
    const Camera camera = look_along({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1.0, 1.5);
    const PixelCones cones(camera, 300, 200, 1);
    double sum = 0;
    for (int j = 0; j < 200; ++j) {
        for (int i = 0; i < 300; ++i) {
            const ConeRay cone = cones.at({(i + 0.5) / 300, (j + 0.5) / 200});
            sum += kPi * cone.spread * cone.spread;
        }
    }
    // The solid angle of the picture.
    const double h = std::tan(0.5), w = 1.5 * h;
    EXPECT_NEAR(sum, 4 * std::asin(std::sin(std::atan(w)) * std::sin(std::atan(h))), 1e-4);
    const RayCone eye = eye_cone(camera, 200, 4);
    EXPECT_EQ(eye.width, 0.0);
    EXPECT_EQ(eye.spread, central_cone(camera, 200, 4).footprint().spread);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
