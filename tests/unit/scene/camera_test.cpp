#include "alhazen/scene/camera.h"

#include <gtest/gtest.h>

#include <numbers>

namespace alhazen {
namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-15) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Camera, VerticalFieldOfViewIsTheFullAngleBetweenTopAndBottom) {
    const double fov = 40.0 * std::numbers::pi / 180.0;
    const Camera camera = look_along({0, 0, 0}, {0, 0, -2}, {0, 3, 0}, fov, 2.0);
    const Vec3 top = eye_ray(camera, 0.5, 1.0).direction;
    const Vec3 bottom = eye_ray(camera, 0.5, 0.0).direction;
    EXPECT_NEAR(std::acos(dot(top, bottom)), fov, 1e-14);
    expect_near(eye_ray(camera, 0.5, 0.5).direction, {0, 0, -1});
    const Vec3 left = eye_ray(camera, 0.0, 0.5).direction;
    EXPECT_NEAR(left.x / left.z, 2.0 * std::tan(fov / 2), 1e-14);
    EXPECT_LT(left.x, 0.0);
}

TEST(Camera, UpNeedNotBePerpendicularAndMayEvenBeParallel) {
    const PerspectiveCamera leaning = look_along({}, {0, -1, -1}, {0, 1, 0}, 1.0, 1.0);
    EXPECT_NEAR(dot(leaning.up, leaning.look), 0.0, 1e-15);
    const PerspectiveCamera down = look_along({}, {0, -1, 0}, {0, 1, 0}, 1.0, 1.0);
    EXPECT_TRUE(is_finite(down.up));
    EXPECT_GT(length(cross(down.up, down.right)), 0.5);
}

TEST(Camera, ShearedVectorsAreUsedAsTheyAre) {
    const Camera camera = PerspectiveCamera{{1, 2, 3}, {0, 0, -1}, {1, 0.5, 0}, {0.25, 1, 0}};
    const Ray ray = eye_ray(camera, 1.0, 1.0);
    expect_near(ray.direction, normalize(Vec3{0.625, 0.75, -1}));
    EXPECT_EQ(ray.origin, (Vec3{1, 2, 3}));
}

TEST(Camera, OrthographicRaysAreParallelAndSpanTheHeight) {
    const Camera camera = look_along_parallel({0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 4.0, 1.5);
    const Ray a = eye_ray(camera, 0.0, 0.0);
    const Ray b = eye_ray(camera, 1.0, 1.0);
    EXPECT_EQ(a.direction, b.direction);
    expect_near(b.origin - a.origin, {6, 4, 0});
}

TEST(Camera, AnotherAspectRatioKeepsTheVerticalExtent) {
    const Camera camera = look_along({}, {0, 0, -1}, {0, 1, 0}, 1.0, 1.0);
    const Camera wide = with_aspect(camera, 1.0, 2.0);
    EXPECT_EQ(std::get<PerspectiveCamera>(wide).up, std::get<PerspectiveCamera>(camera).up);
    EXPECT_EQ(std::get<PerspectiveCamera>(wide).right,
              2.0 * std::get<PerspectiveCamera>(camera).right);
}

}  // namespace
}  // namespace alhazen
