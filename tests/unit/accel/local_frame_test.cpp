#include "alhazen/accel/wide_bvh/nodes/local_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(LocalFrame, PutsAnySceneIntoTheUnitCubeAndRoundsOutward) {
    testing::Random random(3);
    for (const double size : {1e-140, 1e-6, 1.0, 3e7, 1e140}) {
        for (const double shift : {0.0, 1.0, -1e6}) {
            const Box3 all{{shift * size, -size, 2 * size}, {shift * size + size, size, 3 * size}};
            const LocalFrame frame(all);
            const FloatBox whole = frame.local(all);
            for (int k = 0; k < 3; ++k) {
                EXPECT_GE(whole.lo[k], -1.0f);
                EXPECT_LE(whole.hi[k], 1.0f);
            }
            for (int i = 0; i < 1000; ++i) {
                const double t = random.uniform(-1, 1);
                const Vec3 p = all.lo + 0.5 * (1 + t) * (all.hi - all.lo);
                const Vec3 q = frame.local(p);
                const FloatBox point = frame.local(Box3{p, p});
                for (int k = 0; k < 3; ++k) {
                    EXPECT_LE(static_cast<double>(point.lo[k]), q[k]);
                    EXPECT_GE(static_cast<double>(point.hi[k]), q[k]);
                    EXPECT_LE(point.hi[k] - point.lo[k], 0x1p-23f);
                }
            }
        }
    }
}

TEST(LocalFrame, HoldsTheFloatsOfAnySceneExactly) {
    testing::Random random(5);
    for (const Vec3 offset : {Vec3{0, 0, 0}, Vec3{2.4, 15.23, -1.34}, Vec3{1e6, -3.3e5, 7e-3},
                              Vec3{0.71, 1.9, 4.1}, Vec3{-1.01, 1.07, 1.13}}) {
        for (const Vec3 size : {Vec3{1, 1, 1}, Vec3{0.01, 2, 0.3}, Vec3{1.7, 1e-4, 1e-9}}) {
            std::vector<Vec3> points;
            Box3 all;
            for (int i = 0; i < 1000; ++i) {
                Vec3 p;
                for (int k = 0; k < 3; ++k) {
                    const double x = offset[k] + size[k] * random.uniform(-1, 1);
                    p[k] = static_cast<double>(static_cast<float>(x));
                }
                points.push_back(p);
                all.include(p);
            }
            const LocalFrame frame(all);
            for (const Vec3& p : points) {
                const Vec3 q = frame.local(p);
                ASSERT_EQ(frame.world(q), p);
                for (int k = 0; k < 3; ++k) {
                    ASSERT_EQ(static_cast<double>(static_cast<float>(q[k])), q[k]);
                }
            }
        }
    }
}

TEST(LocalFrame, RoundsInTheDirectionAskedForByLessThanOneStep) {
    testing::Random random(4);
    constexpr float kInf = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 200000; ++i) {
        const double x = std::ldexp(random.uniform(-1, 1) + 1e-9, random.below(340) - 170);
        const float down = round_down(x), up = round_up(x);
        ASSERT_TRUE(static_cast<double>(down) <= x && x <= static_cast<double>(up)) << x;
        ASSERT_TRUE(up == down || std::nextafter(down, kInf) == up) << x;
    }
    EXPECT_EQ(round_down(0.0), 0.0f);
    EXPECT_LT(round_down(-1e-300), 0.0f);
    EXPECT_EQ(round_up(1e300), kInf);
    EXPECT_EQ(round_down(1e300), std::numeric_limits<float>::max());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
