#include "alhazen/cameras/camera.h"

#include <gtest/gtest.h>

#include <bit>
#include <numbers>
#include <vector>

#include "alhazen/cameras/eye_rays.h"
#include "alhazen/simd/targets.h"

namespace alhazen::ALHAZEN_TEST_FILE {
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

TEST(Camera, RaysSideBySideHaveTheBitsOfEachAlone) {
    const auto same_bits = [](const Vec3& a, const Vec3& b) {
        const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
        return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
    };
    const Camera cameras[] = {
        PerspectiveCamera{{1, 2, 3}, {0.1, 0.2, -1}, {1, 0.5, 0}, {0.25, 1, 0}},
        PerspectiveCamera{{0, 0, 0}, {0, 0, -1e-170}, {1e-170, 0, 0}, {0, 1e-160, 0}},
        OrthographicCamera{{1, 2, 3}, {0.1, 0.2, -1}, {1, 0.5, 0}, {0.25, 1, 0}},
    };
    for (const std::string& target : simd_targets()) {
        const SimdTargetOverride forced(target);
        for (const Camera& camera : cameras) {
            const EyeRays eye(camera);
            for (std::size_t count = 0; count < 40; ++count) {
                std::vector<Vec3> sums;
                for (std::size_t i = 0; i < count; ++i) {
                    sums.push_back(eye.column(0.025 * static_cast<double>(i)) +
                                   eye.row(0.4 + 0.01 * static_cast<double>(count)));
                }
                // The last element must stay unchanged.
                std::vector<Ray> rays(count + 1, Ray{{7, 7, 7}, {7, 7, 7}, 7, 7});
                eye.rays(sums, rays.data());
                for (std::size_t i = 0; i < count; ++i) {
                    const Ray alone = eye_ray(camera, 0.025 * static_cast<double>(i),
                                              0.4 + 0.01 * static_cast<double>(count));
                    ASSERT_TRUE(same_bits(rays[i].origin, alone.origin)) << target;
                    ASSERT_TRUE(same_bits(rays[i].direction, alone.direction)) << target;
                    ASSERT_EQ(rays[i].t_min, alone.t_min);
                    ASSERT_EQ(rays[i].t_max, alone.t_max);
                }
                EXPECT_EQ(rays[count].t_max, 7);
            }
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
