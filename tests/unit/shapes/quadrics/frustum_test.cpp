// Cylinder and cone, which share a kernel.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "alhazen/shapes/quadrics/cone.h"
#include "alhazen/shapes/quadrics/cylinder.h"
#include "frustum_oracle.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::ExactFrustum;
using testing::line;
using testing::Random;

constexpr double kPiTest = 3.14159265358979323846;

Cylinder prepared(Cylinder c) {
    c.prepare();
    return c;
}
Cone prepared(Cone c) {
    c.prepare();
    return c;
}

Cone random_cone(Random& random) {
    const Vec3 base = random.in_cube(3);
    const int kind = random.below(3);
    return prepared(Cone{.base = base,
                         .top = base + random.log_uniform(0.1, 10) * random.unit_vector(),
                         .base_radius = kind == 0 ? 0.0 : random.log_uniform(0.1, 10),
                         .top_radius = kind == 1 ? 0.0 : random.log_uniform(0.1, 10)});
}

TEST(Cylinder, HitsAreWhereTheFormulaSays) {
    const Cylinder c = prepared(Cylinder{.base = {0, 0, 0}, .top = {0, 0, 4}, .radius = 2});
    ShapeHit hits[2];
    ASSERT_EQ(c.intersect({{-5, 0, 1}, {1, 0, 0}}, hits), 2);
    EXPECT_EQ(hits[0].t, 3.0);
    EXPECT_EQ(hits[1].t, 7.0);
    const ShapeSurface side = c.surface({{-5, 0, 1}, {1, 0, 0}}, hits[0]);
    EXPECT_EQ(side.normal, (Vec3{-1, 0, 0}));
    EXPECT_EQ(side.uv, (Vec2{0.5, 0.25}));
    ASSERT_EQ(c.intersect({{1, 0, -5}, {0, 0, 1}}, hits), 2);
    EXPECT_EQ(hits[0].t, 5.0);
    EXPECT_EQ(hits[0].part, 1u);
    EXPECT_EQ(hits[1].t, 9.0);
    EXPECT_EQ(hits[1].part, 2u);
    const ShapeSurface cap = c.surface({{1, 0, -5}, {0, 0, 1}}, hits[1]);
    EXPECT_EQ(cap.normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(cap.point, (Vec3{1, 0, 4}));
    EXPECT_EQ(cap.uv, (Vec2{0, 0.5}));
}

TEST(Cylinder, SpecialLinesOfTheSolidCrossTwiceOrNever) {
    const Cylinder c = prepared(Cylinder{.base = {0, 0, 0}, .top = {0, 0, 2}, .radius = 1});
    for (const double zero : {0.0, -0.0}) {
        ShapeHit hits[2];
        EXPECT_EQ(c.intersect(line({-3, 0, 0}, {1, zero, zero}), hits), 0);      // in a cap
        EXPECT_EQ(c.intersect(line({-3, 0, 2}, {1, zero, zero}), hits), 2);      // in the other
        EXPECT_EQ(c.intersect(line({1, 0, -3}, {zero, zero, 1}), hits), 0);      // on the side
        EXPECT_EQ(c.intersect(line({0, -1, 5}, {zero, zero, -1}), hits), 0);     // on the side
        EXPECT_EQ(c.intersect(line({0, 0, 5}, {zero, zero, -1}), hits), 2);      // on the axis
        EXPECT_EQ(c.intersect(line({-3, 1, 1}, {1, zero, zero}), hits) % 2, 0);  // tangent
        EXPECT_EQ(c.intersect(line({-2, 0, -1}, {1, zero, 1}), hits) % 2, 0);    // through a rim
        EXPECT_EQ(c.intersect(line({2, 0, -1}, {-1, zero, 1}), hits), 2);        // rim, then inside
    }
}

TEST(Cylinder, OpenEndsLetLinesThrough) {
    const Cylinder c =
        prepared(Cylinder{.base = {0, 0, 0}, .top = {0, 0, 2}, .radius = 1, .capped = false});
    EXPECT_FALSE(c.closed());
    ShapeHit hits[2];
    EXPECT_EQ(c.intersect(line({0.5, 0, -3}, {0, 0, 1}), hits), 0);
    EXPECT_EQ(c.intersect(line({0.5, 0, 3}, {0.5, 0, -1}), hits), 0);
    ASSERT_EQ(c.intersect(line({-0.5, 0, 3}, {0.75, 0, -1}), hits), 1);
    EXPECT_EQ(hits[0].t, 2.0);
    EXPECT_EQ(c.intersect(line({-5, 0, 1}, {1, 0, 0}), hits), 2);
    // Stacked open cylinders share a circle, which belongs to the upper one.
    EXPECT_EQ(c.intersect(line({-5, 0, 2}, {1, 0, 0}), hits), 0);
    EXPECT_EQ(c.intersect(line({-5, 0, 0}, {1, 0, 0}), hits), 2);
}

TEST(Cone, HitsAreWhereTheFormulaSays) {
    const Cone c =
        prepared(Cone{.base = {0, 0, 0}, .top = {0, 0, 2}, .base_radius = 2, .top_radius = 0});
    ShapeHit hits[2];
    ASSERT_EQ(c.intersect({{-5, 0, 1}, {1, 0, 0}}, hits), 2);
    EXPECT_DOUBLE_EQ(hits[0].t, 4.0);
    EXPECT_DOUBLE_EQ(hits[1].t, 6.0);
    const ShapeSurface s = c.surface({{-5, 0, 1}, {1, 0, 0}}, hits[1]);
    EXPECT_NEAR(length(s.normal - Vec3{std::sqrt(0.5), 0, std::sqrt(0.5)}), 0.0, 1e-15);
    ASSERT_EQ(c.intersect({{0, 1, 9}, {0, 0, -1}}, hits), 2);
    EXPECT_DOUBLE_EQ(hits[0].t, 8.0);
    EXPECT_EQ(hits[0].part, 0u);
    EXPECT_DOUBLE_EQ(hits[1].t, 9.0);
    EXPECT_EQ(hits[1].part, 1u);
    // The nappe above the apex does not exist.
    EXPECT_EQ(c.intersect({{-5, 0, 3}, {1, 0, 0}}, hits), 0);
    EXPECT_EQ(c.intersect(line({-5, 0, 2.5}, {1, 0, 0.001}), hits), 0);
}

TEST(Cone, LinesThroughTheApexAndAlongGeneratorsCrossTwiceOrNever) {
    Random random(41);
    for (int i = 0; i < 200000; ++i) {
        const bool lattice = random.coin();
        const double height = lattice ? 1 + random.below(2) : random.uniform(0.1, 3);
        const double radius = lattice ? 1 + random.below(2) : random.uniform(0.1, 3);
        const bool apex_at_base = random.coin();
        const Cone c = prepared(Cone{.base = {0, 0, 0},
                                     .top = {0, 0, height},
                                     .base_radius = apex_at_base ? 0 : radius,
                                     .top_radius = apex_at_base ? radius : 0});
        const Vec3 apex{0, 0, apex_at_base ? 0.0 : height};
        Vec3 d = lattice ? random.lattice_direction() : random.unit_vector();
        if (i % 3 == 0) d = Vec3{radius, 0, apex_at_base ? height : -height};  // a generator
        Vec3 through = apex;
        if (i % 5 == 0) through.y += random.sign() * 0.5;
        const Ray ray = line(through - static_cast<double>(random.below(5)) * d, d);
        ShapeHit hits[2];
        ASSERT_EQ(c.intersect(ray, hits) % 2, 0) << "seed 41, case " << i;
    }
}

TEST(Cone, AxisParallelRaysHitTheSideAtItsHeight) {
    Random random(42);
    const Cone c =
        prepared(Cone{.base = {0, 0, 0}, .top = {0, 0, 3}, .base_radius = 2, .top_radius = 0.5});
    for (int i = 0; i < 10000; ++i) {
        const double r = std::sqrt(random.uniform()) * 1.999;
        const double angle = random.uniform(0, 6.28);
        ShapeHit hits[2];
        const Ray ray{{r * std::cos(angle), r * std::sin(angle), 10}, {-0.0, 0.0, -1}};
        ASSERT_EQ(c.intersect(ray, hits), 2) << "seed 42, case " << i;
        ASSERT_NEAR(hits[0].t, r < 0.5 ? 7.0 : 7.0 + (r - 0.5) * 2.0, 1e-14) << i;
        ASSERT_NEAR(hits[1].t, 10.0, 1e-14) << i;
    }
}

TEST(Frustum, HitsAgreeWithQuadruplePrecision) {
    Random random(43);
    int hit = 0;
    for (int i = 0; i < 100000; ++i) {
        const Cone c = random_cone(random);
        const ExactFrustum exact(c.base, c.top, c.base_radius, c.top_radius);
        const Vec3 d = random.unit_vector();
        const Box3 box = c.box();
        const Vec3 s = box.size();
        const Vec3 target =
            box.lo + Vec3{s.x * random.uniform(), s.y * random.uniform(), s.z * random.uniform()};
        const double distance = i % 2 == 0 ? random.uniform(-20, 20) : 1e6 * c.frustum.half_height;
        const Ray ray = line(target - distance * d, d);
        const ExactFrustum::Span span = exact.span(ray);
        ShapeHit hits[2];
        const int n = c.intersect(ray, hits);
        // From far away 1e-10 of the distance is lost: near-tangent lines may hit or miss.
        const double lost = 1e-15 * (std::abs(distance) + 50);
        if (!span.clear || std::abs(span.exit - span.entry) < 1e8 * lost) continue;
        ASSERT_EQ(n, span.hit ? 2 : 0) << "seed 43, case " << i;
        if (n == 0) continue;
        ++hit;
        // A clearance of 1e-6 in the discriminant: the root magnifies errors by up to 1e3.
        ASSERT_NEAR(hits[0].t, span.entry, 1e4 * lost) << "seed 43, case " << i;
        ASSERT_NEAR(hits[1].t, span.exit, 1e4 * lost) << "seed 43, case " << i;
    }
    EXPECT_GT(hit, 20000);
}

TEST(Frustum, ErrorBoundsTheDistanceFromTheExactSurface) {
    Random random(44);
    double worst = 0;
    for (int i = 0; i < 100000; ++i) {
        Cone c = random_cone(random);
        const ExactFrustum exact(c.base, c.top, c.base_radius, c.top_radius);
        const Vec3 d = random.unit_vector();
        const Vec3 target = c.frustum.center + c.frustum.half_height * random.in_cube(1);
        const Ray ray = line(target - random.log_uniform(0.1, 1e6) * d, d);
        ShapeHit hits[2];
        const int n = c.intersect(ray, hits);
        for (int k = 0; k < n; ++k) {
            const ShapeSurface s = c.surface(ray, hits[k]);
            const double off = exact.distance(s.point, hits[k].part);
            const double bound = dot(abs(s.normal), s.error);
            ASSERT_LE(off, bound) << "seed 44, case " << i << " part " << hits[k].part;
            worst = std::max(worst, off / bound);
        }
    }
    EXPECT_GT(worst, 0.02) << "the bound is needlessly loose";
}

TEST(Frustum, VolumesByRaysAreThoseOfTheFormulas) {
    Random random(45);
    for (const double top_radius : {1.5, 0.5, 0.0}) {
        const Cone c = prepared(Cone{
            .base = {1, 2, 3}, .top = {2, 1, 5}, .base_radius = 1.5, .top_radius = top_radius});
        const Box3 box = c.box();
        constexpr int kSide = 300;
        double sum = 0;
        for (int i = 0; i < kSide * kSide; ++i) {
            const double x = box.lo.x + box.size().x * (i % kSide + random.uniform()) / kSide;
            const double y = box.lo.y + box.size().y * (i / kSide + random.uniform()) / kSide;
            ShapeHit hits[2];
            if (c.intersect(line({x, y, -1}, {0, 0, 1}), hits) == 2) sum += hits[1].t - hits[0].t;
        }
        const double volume = sum / (kSide * kSide) * box.size().x * box.size().y;
        const double exact =
            kPiTest / 3 * std::sqrt(6.0) * (1.5 * 1.5 + 1.5 * top_radius + top_radius * top_radius);
        EXPECT_NEAR(volume, exact, 1e-3 * exact);
    }
}

TEST(Frustum, BoxesTouchTheSolid) {
    Random random(46);
    for (int i = 0; i < 200; ++i) {
        const Cone c = random_cone(random);
        const Vec3 x = perpendicular(c.frustum.axis), y = cross(c.frustum.axis, x);
        Box3 rims;
        for (int k = 0; k < 4096; ++k) {
            const double angle = 2 * kPiTest * k / 4096;
            const Vec3 out = std::cos(angle) * x + std::sin(angle) * y;
            rims.include(c.base + c.base_radius * out);
            rims.include(c.top + c.top_radius * out);
        }
        // The samples miss the farthest point of a rim by up to radius * (step / 2)^2 / 2.
        const double slack = 1e-6 * std::max(c.base_radius, c.top_radius) + 1e-13;
        const Box3 box = c.box();
        for (int k = 0; k < 3; ++k) {
            ASSERT_NEAR(box.lo[k], rims.lo[k], slack) << "seed 46, case " << i;
            ASSERT_NEAR(box.hi[k], rims.hi[k], slack) << "seed 46, case " << i;
            ASSERT_LE(box.lo[k], rims.lo[k]) << "seed 46, case " << i;
            ASSERT_GE(box.hi[k], rims.hi[k]) << "seed 46, case " << i;
        }
    }
}

TEST(Frustum, CrossingsOfVeryFlatOnesAreInTheirBox) {
    Random random(48);
    int count = 0;
    for (int i = 0; i < 4000; ++i) {
        const double height = random.log_uniform(1e-9, 1e-7), radius = random.log_uniform(1e5, 3e6);
        const Vec3 base = random.coin() ? random.in_cube(1) : Vec3{};
        const Vec3 axis = random.coin() ? Vec3{0, 0, 1} : random.unit_vector();
        const Cone c = prepared(Cone{.base = base,
                                     .top = base + height * axis,
                                     .base_radius = radius,
                                     .top_radius = random.coin() ? 0.0 : radius * random.uniform(),
                                     .capped = random.coin()});
        const Vec3 x = perpendicular(axis), y = cross(axis, x);
        const Box3 box = c.box();
        for (int k = 0; k < 50; ++k) {
            const auto across = [&](double reach) {
                return reach * (random.uniform(-1, 1) * x + random.uniform(-1, 1) * y);
            };
            const Vec3 from = c.base + across(radius * random.log_uniform(0.01, 1e4)) +
                              height * random.log_uniform(1e9, 1e15) * random.sign() * axis;
            const Vec3 to = c.base + across(radius * random.uniform(0.5, 1.5)) +
                            height * random.uniform(-0.2, 1.2) * axis;
            const Ray ray = line(from, to - from);
            ShapeHit hits[2];
            const int found = c.intersect(ray, hits);
            for (int h = 0; h < found; ++h) {
                const Vec3 p = ray.at(hits[h].t);
                const double slack = 1e-13 * (radius + length(from));
                ++count;
                for (int a = 0; a < 3; ++a) {
                    ASSERT_GE(p[a], box.lo[a] - slack) << "seed 48, case " << i << ' ' << k;
                    ASSERT_LE(p[a], box.hi[a] + slack) << "seed 48, case " << i << ' ' << k;
                }
            }
        }
    }
    EXPECT_GT(count, 100000);
}

TEST(Frustum, BadFieldsAreReported) {
    const auto errors = [](const auto& shape) {
        Diagnostics diagnostics;
        shape.validate({}, diagnostics);
        return diagnostics.error_count();
    };
    EXPECT_EQ(errors(Cylinder{.radius = 0}), 1u);
    EXPECT_EQ(errors(Cylinder{.base = {1, 1, 1}, .top = {1, 1, 1}}), 1u);
    EXPECT_EQ(errors(Cone{.base_radius = 0, .top_radius = 0}), 1u);
    EXPECT_EQ(errors(Cone{.base_radius = -1, .top_radius = 1}), 1u);
    EXPECT_EQ(errors(Cone{.base_radius = 0, .top_radius = 1}), 0u);
}

TEST(Frustum, TheSideOfAFlatConeIsNoCylinder) {
    // r = 10^4 (1 - z / 2): 10010 - t = 2500 + 250 t at z = 0.004.
    const Frustum flat({0, 0, 0}, {0, 0, 2}, 1e4, 0);
    ASSERT_TRUE(flat.is_flat());
    Ray ray;
    ray.origin = {10010, 0, 1.5};
    ray.direction = {-1, 0, -0.05};
    std::array<ShapeHit, 4> hits;
    ASSERT_EQ(flat.intersect(ray, false, hits.data()), 1);
    EXPECT_NEAR(hits[0].t, 7510.0 / 251.0, 1e-9);
    ray.origin = {10010, 0, 1};
    ray.direction = {-1, 0, 0.01};
    // 10010 - t = 1e4 (1 - (1 + t / 100) / 2) = 5000 - 50 t has no t >= 0; the far side has.
    const int far = flat.intersect(ray, false, hits.data());
    for (int k = 0; k < far; ++k) {
        const Vec3 q = ray.origin + hits[std::size_t(k)].t * ray.direction;
        EXPECT_NEAR(std::hypot(q.x, q.y), 1e4 * (1 - q.z / 2), 1e-6);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
