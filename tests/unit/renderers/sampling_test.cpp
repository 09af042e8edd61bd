#include <gtest/gtest.h>

#include "alhazen/renderers/core/samplers.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using PixelSample = PointSampler::PixelSample;

TEST(PixelSampling, TheSingleSampleFollowsTheConvention) {
    EXPECT_EQ(PointSampler(PixelSample::Center, 4, 2).at(0, 0), (Vec2{0.125, 0.75}));
    EXPECT_EQ(PointSampler(PixelSample::LowerLeftCorner, 4, 2).at(1, 1), (Vec2{0.25, 0.0}));
    EXPECT_EQ(PointSampler(PixelSample::FrameCorners, 5, 3).at(4, 0), (Vec2{1.0, 1.0}));
    EXPECT_EQ(PointSampler(PixelSample::FrameCorners, 5, 3).at(0, 2), (Vec2{0.0, 0.0}));
}

TEST(PixelSampling, JitteredSamplesFillTheirStrataOfThePixel) {
    testing::SceneMaker maker;
    maker.add(Sphere{});
    const Scene scene = maker.compile();
    RenderJob job{scene, scene.cameras[0].camera, 16, 5, false};
    std::array<int, 16> strata{};
    const JitteredSampler sampler(job, 8, 8);
    ASSERT_EQ(sampler.count(), 16);
    for (int s = 0; s < 16; ++s) {
        const Vec2 p = sampler.at(3, 1, s);
        const double x = p.x * 8 - 3;
        const double y = p.y * 8 - 6;
        ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1) << s;
        ++strata[static_cast<std::size_t>(4 * static_cast<int>(y * 4) + static_cast<int>(x * 4))];
    }
    for (const int count : strata) EXPECT_EQ(count, 1);
    for (int count = 2; count < 40; ++count) {
        job.samples_per_pixel = count;
        const JitteredSampler of_count(job, 1, 1);
        for (int s = 0; s < count; ++s) {
            const Vec2 p = of_count.at(0, 0, s);
            ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << s << " of " << count;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
