#include "alhazen/shapes/quadrics/sphere.h"

#include <gtest/gtest.h>

#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Quad;
using testing::QuadVec;
using testing::Random;

struct ExactRoots {
    bool hit;
    double t_near, t_far;
    double half_chord;  ///< in lengths
};

ExactRoots exact_roots(const Sphere& sphere, const Ray& ray) {
    const QuadVec f = QuadVec(ray.origin) - QuadVec(sphere.center);
    const QuadVec d(ray.direction);
    const Quad a = dot(d, d), b = dot(f, d), radius = sphere.radius;
    const Quad discriminant = b * b - a * (dot(f, f) - radius * radius);
    if (discriminant < 0) return {false, 0, 0, 0};
    const Quad root = testing::square_root(discriminant);
    return {true, static_cast<double>((-b - root) / a), static_cast<double>((-b + root) / a),
            static_cast<double>(root / testing::square_root(a))};
}

double ulp(double x) {
    return std::nextafter(std::abs(x), 1e300) - std::abs(x);
}

TEST(Sphere, HitsAreWhereTheFormulaSays) {
    const Sphere sphere{.center = {1, 2, 3}, .radius = 2};
    ShapeHit hits[2];
    ASSERT_EQ(sphere.intersect({{1, 2, -7}, {0, 0, 2}}, hits), 2);
    EXPECT_EQ(hits[0].t, 4.0);
    EXPECT_EQ(hits[1].t, 6.0);
    ASSERT_EQ(sphere.intersect({{1, 2, 3}, {0, -1, 0}}, hits), 1);
    EXPECT_EQ(hits[0].t, 2.0);
    EXPECT_EQ(sphere.intersect({{1, 2, -7}, {0, 0, -1}}, hits), 0);
    EXPECT_EQ(sphere.intersect({{1, 4.001, -7}, {0, 0, 1}}, hits), 0);
}

TEST(Sphere, TangentLinesCrossTwiceOrNever) {
    const Sphere sphere{.center = {0, 0, 0}, .radius = 1};
    ShapeHit hits[2];
    for (const double y : {1.0, -1.0, std::nextafter(1.0, 0.0), std::nextafter(1.0, 2.0)}) {
        for (const double x : {-5.0, -0.0, 1e-30, 3.0}) {
            const int n = sphere.intersect(line({x, y, 0}, {1, 0, -0.0}), hits);
            EXPECT_TRUE(n == 0 || n == 2) << x << " " << y;
            for (int k = 0; k < n; ++k) EXPECT_NEAR(hits[k].t, -x, 1e-7);
        }
    }
}

TEST(Sphere, RootsAgreeWithQuadruplePrecision) {
    Random random(21);
    int hit = 0;
    for (int i = 0; i < 100000; ++i) {
        const Sphere sphere{.center = random.in_cube(5), .radius = random.log_uniform(0.01, 10)};
        const Vec3 target = sphere.center + sphere.radius * random.in_cube(1.1);
        const Vec3 direction = random.log_uniform(0.1, 10) * random.unit_vector();
        const Ray ray = line(target - random.uniform(-20, 20) * direction, direction);
        const ExactRoots exact = exact_roots(sphere, ray);
        ShapeHit hits[2];
        const int n = sphere.intersect(ray, hits);
        // Rounding of origin - centre and of the discriminant, over half the chord.
        const double reach = length(ray.origin) + length(sphere.center) + sphere.radius;
        const double unsure = 8 * 0x1p-53 * reach * reach;
        if (!exact.hit || exact.half_chord * exact.half_chord < 10 * unsure) continue;
        ASSERT_EQ(n, 2) << "seed 21, case " << i;
        const double bound = (8 * 0x1p-53 * reach + unsure / exact.half_chord) / length(direction);
        ASSERT_NEAR(hits[0].t, exact.t_near, bound) << "seed 21, case " << i;
        ASSERT_NEAR(hits[1].t, exact.t_far, bound) << "seed 21, case " << i;
        ++hit;
    }
    EXPECT_GT(hit, 50000);
}

TEST(Sphere, RaysFromFarAwayHitWithoutCancellation) {
    Random random(22);
    const Sphere sphere{.center = {0, 0, 0}, .radius = 1};
    for (int i = 0; i < 100000; ++i) {
        const Vec3 towards = random.unit_vector();
        const Vec3 x = perpendicular(towards);
        const Vec3 y = cross(towards, x);
        // Offsets up to 1 - 1e-6 of the radius: no holes. (At 1e6 radii a coordinate has an error
        // of 1e-10.)
        const double offset = std::sqrt(random.uniform()) * (1 - 1e-6);
        const double angle = random.uniform(0, 6.283);
        const Vec3 side = offset * (std::cos(angle) * x + std::sin(angle) * y);
        const Ray ray{side - 1e6 * towards, towards};
        ShapeHit hits[2];
        ASSERT_EQ(sphere.intersect(ray, hits), 2) << "seed 22, case " << i << ", " << offset;
        const ExactRoots exact = exact_roots(sphere, ray);
        const double bound = 4 * ulp(exact.t_near) + 0x1p-22;
        ASSERT_NEAR(hits[0].t, exact.t_near, bound) << "seed 22, case " << i << ", " << offset;
        ASSERT_NEAR(hits[1].t, exact.t_far, bound) << "seed 22, case " << i << ", " << offset;
    }
}

TEST(Sphere, ErrorBoundsTheDistanceFromTheExactSphere) {
    Random random(23);
    for (int i = 0; i < 100000; ++i) {
        const Sphere sphere{.center = random.in_cube(100), .radius = random.log_uniform(1e-3, 1e3)};
        const Vec3 direction = random.unit_vector();
        const Vec3 target = sphere.center + 0.99 * sphere.radius * random.unit_vector();
        const Ray ray = line(target - random.log_uniform(1e-3, 1e6) * direction, direction);
        ShapeHit hits[2];
        const int n = sphere.intersect(ray, hits);
        for (int k = 0; k < n; ++k) {
            const ShapeSurface s = sphere.surface(ray, hits[k]);
            const Quad radius = sphere.radius;
            const Quad off = length(QuadVec(s.point) - QuadVec(sphere.center)) - radius;
            ASSERT_LE(static_cast<double>(testing::magnitude(off)), dot(abs(s.normal), s.error))
                << "seed 23, case " << i;
        }
    }
}

TEST(Sphere, TextureCoordinatesRunFromPoleToPole) {
    const Sphere sphere{.center = {1, 0, 0}, .radius = 2};
    const auto uv = [&](const Vec3& from) {
        const Ray ray{sphere.center + 5 * from, -from};
        ShapeHit hits[2];
        EXPECT_EQ(sphere.intersect(ray, hits), 2);
        return sphere.surface(ray, hits[0]).uv;
    };
    EXPECT_EQ(uv({1, 0, 0}), (Vec2{0, 0.5}));
    EXPECT_EQ(uv({0, 1, 0}), (Vec2{0.25, 0.5}));
    EXPECT_EQ(uv({-1, 0, 0}).x, 0.5);
    EXPECT_EQ(uv({0, -1, 0}), (Vec2{0.75, 0.5}));
    EXPECT_EQ(uv({0, 0, 1}).y, 1.0);
    EXPECT_EQ(uv({0, 0, -1}).y, 0.0);
}

TEST(Sphere, VolumeByRaysIsThatOfTheFormula) {
    Random random(24);
    const Sphere sphere{.center = {3, -2, 1}, .radius = 1.5};
    const Box3 box = sphere.box();
    // Stratified over the box's face: the error falls faster than with independent samples.
    constexpr int kSide = 300;
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const double x = box.lo.x + box.size().x * (i % kSide + random.uniform()) / kSide;
        const double y = box.lo.y + box.size().y * (i / kSide + random.uniform()) / kSide;
        ShapeHit hits[2];
        if (sphere.intersect(line({x, y, 0}, {0, 0, 1}), hits) == 2) sum += hits[1].t - hits[0].t;
    }
    const double volume = sum / (kSide * kSide) * box.size().x * box.size().y;
    const double exact = 4.0 / 3.0 * 3.14159265358979 * 1.5 * 1.5 * 1.5;
    EXPECT_NEAR(volume, exact, 3e-4 * exact);
}

TEST(Sphere, BadFieldsAreReported) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double radius : {0.0, -1.0, nan, inf, 1e300, 1e-300}) {
        Diagnostics diagnostics;
        Sphere{.radius = radius}.validate({"a.yaml", 3, 1}, diagnostics);
        EXPECT_EQ(diagnostics.error_count(), 1u) << radius;
    }
    Diagnostics diagnostics;
    Sphere{.center = {0, nan, 0}}.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
