/// Nearest points that are known in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/random_shapes.h"
#include "unit/shapes/nearest_on.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::nearest_on;
using testing::Random;

TEST(Nearest, KnownDistancesAreExact) {
    EXPECT_DOUBLE_EQ(nearest_on(Sphere{.radius = 2}, {3, 4, 0}).squared, 9);
    EXPECT_DOUBLE_EQ(nearest_on(Sphere{.radius = 2}, {}).squared, 4);
    EXPECT_DOUBLE_EQ(nearest_on(Cylinder{.top = {0, 0, 8}, .radius = 3}, {0, 0, 4}).squared, 9);
    EXPECT_DOUBLE_EQ(nearest_on(Cylinder{.top = {0, 0, 8}, .radius = 3}, {6, 0, 12}).squared, 25);
    EXPECT_DOUBLE_EQ(nearest_on(Cylinder{.top = {0, 0, 4}, .radius = 9}, {0, 0, 3}).squared, 1);
    EXPECT_DOUBLE_EQ(nearest_on(Torus{.major_radius = 3, .minor_radius = 1}, {}).squared, 4);
    EXPECT_DOUBLE_EQ(nearest_on(Torus{.major_radius = 3, .minor_radius = 1}, {3, 0, 0}).squared, 1);
    EXPECT_DOUBLE_EQ(nearest_on(Disc{.radius = 4, .inner_radius = 3}, {0, 0, 4}).squared, 25);
    EXPECT_DOUBLE_EQ(nearest_on(BoxShape{}, {0.25, 0, 0}).squared, 0.0625);
    EXPECT_DOUBLE_EQ(nearest_on(BoxShape{}, {1, 1, 1}).squared, 0.75);
    const Ellipsoid egg{.axis_a = {1, 0, 0}, .axis_b = {0, 2, 0}, .axis_c = {0, 0, 3}};
    EXPECT_DOUBLE_EQ(nearest_on(egg, {}).squared, 1);
    EXPECT_DOUBLE_EQ(nearest_on(egg, {0, 0, 5}).squared, 4);
    EXPECT_DOUBLE_EQ(nearest_on(Sphere{}, {0, 5, 0}, Affine::scale({1, 2, 3})).squared, 9);
    // A point of the axis of a paraboloid x^2 + y^2 = z is nearest to the apex up to z = 1/2, then
    // to a circle: z - 1/4 is the squared distance.
    const Paraboloid bowl{.axis_a = {1, 0, 0}, .axis_b = {0, 1, 0}, .capped = false};
    EXPECT_DOUBLE_EQ(nearest_on(bowl, {0, 0, 0.375}).squared, 0.140625);
    EXPECT_DOUBLE_EQ(nearest_on(bowl, {0, 0, 0.75}).squared, 0.5);
    EXPECT_DOUBLE_EQ(nearest_on(bowl, {0, 0, -2}).squared, 4);
    // Before and behind the apex of a cone, and within it.
    const Cone cone{.base = {0, 0, 0}, .top = {0, 0, 1}, .base_radius = 1, .top_radius = 0};
    EXPECT_DOUBLE_EQ(nearest_on(cone, {0, 0, 3}).squared, 4);
    EXPECT_NEAR(nearest_on(cone, {0, 0, 0.8}).squared, 0.02, 1e-16);
    EXPECT_DOUBLE_EQ(nearest_on(cone, {2, 0, 1}).squared, 2);
}

TEST(Nearest, RimsAreFoundFromFarAway) {
    const Affine turned = Affine::rotate(normalize(Vec3{1, 2, 3}), 40 * kPi / 180);
    EllipticCylinder pipe{.axis_a = {2, 0, 0}, .axis_b = {0, 1, 0}};
    const Vec3 above{700, 900, -1000};
    Paraboloid bowl;
    const Vec3 aside{-1000, 200, 100};
    double pipe_rim = kInfinity, bowl_rim = kInfinity;
    for (int i = 0; i < 100000; ++i) {
        const double a = i * kPi / 50000;
        const Vec3 p{2 * std::cos(a), std::sin(a), 0}, q{std::cos(a), std::sin(a), 1};
        pipe_rim = std::min(pipe_rim, length(turned.point(p) - above));
        bowl_rim = std::min(bowl_rim, length(turned.point(q) - aside));
    }
    EXPECT_NEAR(std::sqrt(nearest_on(pipe, above, turned).squared), pipe_rim, 1e-6);
    EXPECT_NEAR(std::sqrt(nearest_on(bowl, aside, turned).squared), bowl_rim, 1e-6);
}

/// Points at known distances outside a convex surface, at the ends of its normals.
template <class S>
void check_outside(const S& shape, const Affine& place, const Vec3& on, const Vec3& gradient,
                   const Affine& turned, double largest) {
    const Vec3 normal = normalize(gradient);
    for (const double away : {1e-3, 1.0, 1e3}) {
        const double d =
            std::sqrt(nearest_on(shape, turned.point(on + away * normal), place).squared);
        EXPECT_NEAR(d, away, 4e-15 * (largest + away)) << away << " " << largest;
    }
}

TEST(Nearest, SlenderQuadricsLoseNoDigits) {
    Random random(11);
    for (double c = 1e-8; c < 2e8; c *= 10) {
        const Ellipsoid egg{.axis_a = {1, 0, 0}, .axis_b = {0, 1.5, 0}, .axis_c = {0, 0, c}};
        EXPECT_DOUBLE_EQ(nearest_on(egg, {0, 0, 2 * c + 2}).squared, (c + 2) * (c + 2)) << c;
        const EllipticCylinder pipe{.top = {0, 0, c}, .axis_a = {1, 0, 0}, .axis_b = {0, 1.5, 0}};
        for (int i = 0; i < 20; ++i) {
            const Affine turned =
                i == 0 ? Affine{} : Affine::rotate(random.unit_vector(), random.uniform(0, 6));
            const Affine stretched = turned * Affine::scale({1, 1.5, c});
            const Vec3 u = random.unit_vector();
            const Vec3 on{u.x, 1.5 * u.y, c * u.z}, gradient{u.x, u.y / 1.5, u.z / c};
            check_outside(egg, turned, on, gradient, turned, std::max(1.5, c));
            check_outside(Sphere{}, stretched, on, gradient, turned, std::max(1.5, c));
            const double side = std::hypot(u.x, u.y), h = random.uniform(0.1, 0.9);
            const Vec3 v{u.x / side, u.y / side, 0};
            check_outside(pipe, turned, {v.x, 1.5 * v.y, c * h}, {v.x, v.y / 1.5, 0}, turned,
                          std::max(1.5, c));
            // Ends that are slender, whose rims are nearest.
            const EllipticCylinder board{.axis_a = {1, 0, 0}, .axis_b = {0, c, 0}};
            const Vec3 rim{v.x, c * v.y, 1};
            const Vec3 aside = normalize(Vec3{v.x, v.y / c, 0});
            check_outside(board, turned, rim, aside + Vec3{0, 0, h}, turned, std::max(1.5, c));
            check_outside(Disc{.center = {0, 0, 1}}, turned * Affine::scale({1, c, 1}), rim,
                          aside + Vec3{0, 0, h}, turned, std::max(1.5, c));
            if (::testing::Test::HasFailure()) return;
        }
    }
}

// Near an apex the function is small off the surface as well.
TEST(Nearest, PointsBesideAnApexAreOnTheSurface) {
    const Affine stretched = Affine::scale({1, 2, 3});
    const Cone cone{.base = {0, 0, 0}, .top = {0, 0, 1}, .base_radius = 1, .top_radius = 0};
    for (double off = 1e-2; off > 1e-12; off *= 0.1) {
        // Behind the apex, which is nearest.
        const Vec3 behind = off * Vec3{0.1, 0.05, 1};
        EXPECT_NEAR(std::sqrt(nearest_on(cone, Vec3{0, 0, 3} + behind, stretched).squared),
                    length(behind), 2e-15);
        // Far within, as far from the sides at any scale.
        const Vec3 within = off * Vec3{0.05, 0.1, -1};
        EXPECT_NEAR(
            std::sqrt(nearest_on(cone, Vec3{0, 0, 3} + within, stretched).squared),
            off *
                std::sqrt(
                    nearest_on(cone, Vec3{0, 0, 3} + within / off * 0.25, stretched).squared) *
                4,
            4e-15)
            << off;
    }
}

// The multiplier at its pole, and near it.
TEST(Nearest, PointsBesideAnAxisAreAsNearAsOnIt) {
    const Ellipsoid egg{.axis_a = {2, 0, 0}, .axis_b = {0, 2, 0}, .axis_c = {0, 0, 1}};
    const Paraboloid bowl{.capped = false};
    const Cylinder pipe{.top = {0, 0, 4}, .radius = 1, .capped = false};
    for (double off = 1e-3; off > 1e-20; off *= 0.1) {
        for (const Vec3& aside : {Vec3{off, 0, 0}, Vec3{0.6 * off, 0.8 * off, 0}}) {
            const double r = length(aside);
            EXPECT_NEAR(std::sqrt(nearest_on(pipe, Vec3{0, 0, 2} + aside).squared), 1 - r, 2e-15);
            // The circle of z = 1/2 - 1/2 + h is at a right angle to the axis' neighbourhood.
            const double d = std::sqrt(nearest_on(bowl, Vec3{0, 0, 0.75} + aside).squared);
            EXPECT_NEAR(d, std::sqrt(0.5) - r * std::sqrt(0.5), r * r + 2e-15) << off;
            const double e = std::sqrt(nearest_on(egg, aside).squared);
            EXPECT_NEAR(e, 1.0, r * r + 2e-15) << off;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
