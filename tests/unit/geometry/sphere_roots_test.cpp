#include "alhazen/geometry/sphere_roots.h"

#include <gtest/gtest.h>

#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Quad;
using testing::QuadVec;
using testing::Random;

SphereRoots<double> solve(const Vec3& d, const Vec3& f, double radius) {
    return sphere_roots<double>(d.x, d.y, d.z, length_squared(d), f.x, f.y, f.z, radius);
}

TEST(SphereRoots, AreRightInClosedForm) {
    const auto far = solve({0, 0, 2}, {0, 0, -10}, 2);
    EXPECT_EQ(far.t_near, 4.0);
    EXPECT_EQ(far.t_far, 6.0);
    const auto center = solve({0, 3, 0}, {0, 0, 0}, 6);
    EXPECT_EQ(center.t_near, -2.0);
    EXPECT_EQ(center.t_far, 2.0);
    const auto on_surface = solve({1, 0, 0}, {-1, 0, 0}, 1);
    EXPECT_EQ(on_surface.t_near, 0.0);
    EXPECT_EQ(on_surface.t_far, 2.0);
    EXPECT_LT(solve({1, 0, 0}, {0, 1.5, 0}, 1).discriminant, 0.0);
}

TEST(SphereRoots, TangentGivesOneValueTwice) {
    for (const double x : {-4.0, -0.0, 0.0, 4.0}) {
        const auto tangent = solve({2, 0, 0}, {x, 1, 0}, 1);
        EXPECT_EQ(tangent.discriminant, 0.0);
        EXPECT_EQ(tangent.t_near, -x / 2);
        EXPECT_EQ(tangent.t_far, -x / 2);
    }
}

TEST(SphereRoots, TheRootNearASurfaceOriginIsRelativelyAccurate) {
    // A ray that starts just off the sphere: the near root must not cancel against the far one.
    Random random(94);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 n = random.unit_vector();
        const double gap = random.log_uniform(1e-6, 1e-2);
        const Vec3 f = (1 + gap) * n;
        const Vec3 d = random.unit_vector();
        if (std::abs(dot(n, d)) < 0.3) continue;
        const auto roots = solve(d, f, 1);
        const Quad a = dot(QuadVec(d), QuadVec(d)), b = dot(QuadVec(f), QuadVec(d));
        const Quad c = dot(QuadVec(f), QuadVec(f)) - 1;
        if (b * b - a * c < Quad(1e-2)) continue;
        const Quad root = testing::square_root(b * b - a * c);
        const double small = static_cast<double>(b > 0 ? -c / (b + root) : c / (root - b));
        const double result = b > 0 ? roots.t_far : roots.t_near;
        // c = |f|^2 - 1 has an absolute error of 2 ulp of 1; the rest is relative.
        ASSERT_NEAR(result, small, 0x1p-50 + 1e-14 * std::abs(small)) << "seed 94, case " << i;
    }
}

TEST(SphereRoots, OfALineThatGrazesFromTheSurfaceAreBothNearItsOrigin) {
    // Longest chord of a line displaced by a few roundings: sqrt(2 r off) on either side.
    Random random(96);
    int crossed = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 n = random.unit_vector();
        const double slope = random.coin() ? 0.0 : random.log_uniform(1e-17, 1e-9);
        const Vec3 d = perpendicular(n) + (random.coin() ? slope : -slope) * n;
        const double radius = random.log_uniform(1e-3, 1e3);
        const auto roots = solve(d, radius * n, radius);
        if (!(roots.discriminant >= 0.0)) continue;
        ++crossed;
        ASSERT_LE(std::abs(roots.t_near), 1e-7 * radius) << "seed 96, case " << i;
        ASSERT_LE(std::abs(roots.t_far), 1e-7 * radius) << "seed 96, case " << i;
    }
    EXPECT_GT(crossed, 30000);
}

TEST(SphereRoots, NeverAscendTheWrongWay) {
    Random random(95);
    for (int i = 0; i < 200000; ++i) {
        const bool lattice = random.coin();
        const Vec3 d = lattice ? random.lattice_direction() : random.unit_vector();
        const Vec3 f = lattice ? random.on_lattice(3, 0.25) : random.in_cube(3);
        const auto roots = solve(d, f, lattice ? 0.25 * (1 + random.below(8)) : 1.5);
        if (!(roots.discriminant >= 0.0)) continue;
        ASSERT_LE(roots.t_near, roots.t_far) << "seed 95, case " << i;
        ASSERT_TRUE(std::isfinite(roots.t_near) && std::isfinite(roots.t_far)) << i;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
