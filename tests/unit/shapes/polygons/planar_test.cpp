// Plane, disc and rectangle.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>

#include "alhazen/shapes/polygons/disc.h"
#include "alhazen/shapes/polygons/plane.h"
#include "alhazen/shapes/polygons/rectangle.h"
#include "support/quad.h"
#include "support/random.h"
#include "unit/shapes/line_crossings.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::prepared;
using testing::Quad;
using testing::QuadVec;
using testing::Random;

TEST(Plane, IsHitFromBothSidesAndMissedAlongIt) {
    const Plane plane = prepared(Plane{.point = {0, 0, 2}, .normal = {0, 0, 5}});
    ShapeHit hit;
    ASSERT_EQ(plane.intersect({{1, 1, 0}, {0, 0, 1}}, &hit), 1);
    EXPECT_EQ(hit.t, 2.0);
    ASSERT_EQ(plane.intersect({{1, 1, 6}, {0, 0, -2}}, &hit), 1);
    EXPECT_EQ(hit.t, 2.0);
    EXPECT_EQ(plane.surface({{1, 1, 6}, {0, 0, -2}}, hit).normal, (Vec3{0, 0, 1}));
    for (const double zero : {0.0, -0.0}) {
        EXPECT_EQ(plane.intersect(line({0, 0, 2}, {1, 0, zero}), &hit), 0);
        EXPECT_EQ(plane.intersect(line({0, 0, 3}, {1, 1, zero}), &hit), 0);
    }
}

TEST(Plane, IsUnboundedButForItsNormalAlongAnAxis) {
    const double inf = std::numeric_limits<double>::infinity();
    const Plane level = prepared(Plane{.point = {1, 2, 3}, .normal = {0, 2, 0}});
    EXPECT_EQ(level.box().lo.x, -inf);
    EXPECT_EQ(level.box().hi.z, inf);
    EXPECT_NEAR(level.box().lo.y, 2.0, 1e-14);
    EXPECT_NEAR(level.extent({0, 3, 0}).hi, 6.0, 1e-13);
    EXPECT_EQ(level.extent({0, 3, 1e-9}).hi, inf);
    const Plane tilted = prepared(Plane{.point = {1, 2, 3}, .normal = {1, 2, 3}});
    EXPECT_NEAR(tilted.extent({2, 4, 6}).lo, 28.0, 1e-12);
    EXPECT_EQ(tilted.extent({0, 1, 0}).lo, -inf);
    EXPECT_FALSE(tilted.box().bounded());
}

TEST(Plane, ErrorBoundsTheDistanceFromTheExactPlane) {
    Random random(51);
    for (int i = 0; i < 50000; ++i) {
        const Plane plane = prepared(Plane{.point = random.in_cube(10),
                                           .normal = random.uniform(1, 5) * random.unit_vector()});
        const Vec3 d = random.unit_vector();
        const Ray ray = line(random.in_cube(10) - random.log_uniform(1, 1e4) * d, d);
        ShapeHit hit;
        if (plane.intersect(ray, &hit) == 0) continue;
        const ShapeSurface s = plane.surface(ray, hit);
        const Quad off =
            dot(normalize(QuadVec(plane.normal)), QuadVec(s.point) - QuadVec(plane.point));
        ASSERT_LE(static_cast<double>(testing::magnitude(off)), dot(abs(s.normal), s.error))
            << "seed 51, case " << i;
    }
}

TEST(Disc, IsHitBetweenItsRims) {
    const Disc disc =
        prepared(Disc{.center = {1, 2, 3}, .normal = {0, 0, -4}, .radius = 2, .inner_radius = 1});
    const auto hit_at = [&](double distance) {
        ShapeHit hit;
        return disc.intersect({{1 + distance, 2, 10}, {0, 0, -1}}, &hit) == 1 && hit.t == 7.0;
    };
    EXPECT_TRUE(hit_at(1.5));
    EXPECT_TRUE(hit_at(2));
    EXPECT_TRUE(hit_at(-1));
    EXPECT_FALSE(hit_at(0.999));
    EXPECT_FALSE(hit_at(2.001));
    EXPECT_FALSE(hit_at(0));
    ShapeHit hit;
    EXPECT_EQ(disc.intersect(line({-5, 2, 3}, {1, 0, 0}), &hit), 0);
}

TEST(Disc, TextureRunsAroundAndFromRimToRim) {
    const Disc disc = prepared(Disc{.radius = 3, .inner_radius = 1});
    const auto uv = [&](double x, double y) {
        const Ray ray{{x, y, 1}, {0, 0, -1}};
        ShapeHit hit;
        EXPECT_EQ(disc.intersect(ray, &hit), 1);
        return disc.surface(ray, hit).uv;
    };
    EXPECT_EQ(uv(1, 0), (Vec2{0, 0}));
    EXPECT_EQ(uv(0, 3), (Vec2{0.25, 1}));
    EXPECT_EQ(uv(-2, 0), (Vec2{0.5, 0.5}));
}

TEST(Disc, BoxTouchesItsRim) {
    Random random(52);
    for (int i = 0; i < 200; ++i) {
        const Disc disc = prepared(Disc{.center = random.in_cube(3),
                                        .normal = random.unit_vector(),
                                        .radius = random.log_uniform(0.01, 10)});
        const Vec3 x = perpendicular(disc.unit_normal), y = cross(disc.unit_normal, x);
        Box3 rim;
        for (int k = 0; k < 4096; ++k) {
            const double angle = 6.283185307179586 * k / 4096;
            rim.include(disc.center + disc.radius * (std::cos(angle) * x + std::sin(angle) * y));
        }
        const Box3 box = disc.box();
        for (int k = 0; k < 3; ++k) {
            ASSERT_LE(box.lo[k], rim.lo[k]) << i;
            ASSERT_GE(box.hi[k], rim.hi[k]) << i;
            ASSERT_NEAR(box.lo[k], rim.lo[k], 1e-6 * disc.radius + 1e-13) << i;
            ASSERT_NEAR(box.hi[k], rim.hi[k], 1e-6 * disc.radius + 1e-13) << i;
        }
    }
}

TEST(Rectangle, ParametersSolveForThePoint) {
    Random random(53);
    int hit_count = 0;
    for (int i = 0; i < 50000; ++i) {
        const Rectangle r = prepared(Rectangle{
            .corner = random.in_cube(3), .edge_u = random.in_cube(2), .edge_v = random.in_cube(2)});
        const double u = random.uniform(-0.5, 1.5), v = random.uniform(-0.5, 1.5);
        const double sine =
            length(cross(r.edge_u, r.edge_v)) / (length(r.edge_u) * length(r.edge_v));
        const Vec3 d = random.unit_vector();
        if (sine < 0.05 || std::abs(dot(d, r.unit_normal)) < 0.05) continue;
        const Ray ray = line(r.corner + u * r.edge_u + v * r.edge_v - 4.0 * d, d);
        ShapeHit hit;
        const bool inside = u > 0 && u < 1 && v > 0 && v < 1;
        const double from_edge = std::min(std::min(std::abs(u), std::abs(1 - u)),
                                          std::min(std::abs(v), std::abs(1 - v)));
        if (from_edge < 1e-9 || length(r.edge_u) < 0.01 || length(r.edge_v) < 0.01) continue;
        ASSERT_EQ(r.intersect(ray, &hit), inside ? 1 : 0) << "seed 53, case " << i;
        if (!inside) continue;
        ++hit_count;
        ASSERT_NEAR(hit.t, 4.0, 1e-12) << "seed 53, case " << i;
        ASSERT_NEAR(hit.u, u, 1e-10) << "seed 53, case " << i;
        ASSERT_NEAR(hit.v, v, 1e-10) << "seed 53, case " << i;
    }
    EXPECT_GT(hit_count, 5000);
}

TEST(Rectangle, BoxIsThatOfTheCorners) {
    Random random(54);
    for (int i = 0; i < 10000; ++i) {
        // A distant corner with an edge back to the origin: the sum is tiny, its rounding error is
        // not.
        const Vec3 corner = random.in_cube(1e6);
        const Rectangle r = prepared(Rectangle{
            .corner = corner, .edge_u = random.in_cube(1) - corner, .edge_v = random.in_cube(5)});
        const Box3 box = r.box();
        for (const Quad u : {0, 1}) {
            for (const Quad v : {0, 1}) {
                const QuadVec p = QuadVec(r.corner) + u * QuadVec(r.edge_u) + v * QuadVec(r.edge_v);
                ASSERT_TRUE(box.lo.x <= p.x && p.x <= box.hi.x && box.lo.y <= p.y &&
                            p.y <= box.hi.y && box.lo.z <= p.z && p.z <= box.hi.z)
                    << "seed 54, case " << i;
            }
        }
        Box3 rounded;
        for (const Vec3& p :
             {corner, corner + r.edge_u, corner + r.edge_v, corner + r.edge_u + r.edge_v}) {
            rounded.include(p);
        }
        ASSERT_LT(max_component(abs(box.lo - rounded.lo)), 1e-8) << i;
        ASSERT_LT(max_component(abs(box.hi - rounded.hi)), 1e-8) << i;
    }
}

TEST(Rectangle, MayBeAsSmallAsALength) {
    // The area of most of them is less than the least length.
    for (const double size : {1.0, 1e-36, 1e-42, 1e-60, 1e-70, 1e60}) {
        for (const Vec3& other : {Vec3{0, 1, 0}, Vec3{1, 1e-9, 0}}) {
            const Rectangle rectangle =
                prepared(Rectangle{{0, 0, 0}, size * Vec3{1, 0, 0}, size * other});
            Diagnostics found;
            rectangle.validate({}, found);
            ASSERT_EQ(found.error_count(), 0u) << size;
            const Vec3 middle = 0.5 * rectangle.edge_u + 0.25 * rectangle.edge_v;
            ShapeHit hit;
            ASSERT_EQ(rectangle.intersect({middle + size * Vec3{0, 0, 2}, {0, 0, -size}}, &hit), 1)
                << size;
            EXPECT_EQ(hit.t, 2.0);
            EXPECT_NEAR(hit.u, 0.5, 1e-6);
            EXPECT_NEAR(hit.v, 0.25, 1e-6);
        }
        Diagnostics found;
        Rectangle{{0, 0, 0}, size * Vec3{1, 0, 0}, size * Vec3{1, 1e-13, 0}}.validate({}, found);
        EXPECT_EQ(found.error_count(), 1u) << size;
    }
}

TEST(PlanarShapes, RaysAlongThemAreNoInvalidOperation) {
    const Plane plane = prepared(Plane{.point = {0, 0, 2}, .normal = {0, 0, 1}});
    const Disc disc = prepared(Disc{.center = {0, 0, 2}, .normal = {0, 0, 1}});
    const Rectangle rectangle =
        prepared(Rectangle{.corner = {-1, -1, 2}, .edge_u = {2, 0, 0}, .edge_v = {0, 2, 0}});
    ShapeHit hit;
    std::feclearexcept(FE_INVALID);
    for (const double z : {1.0, 2.0, 3.0}) {
        for (const Vec3& along : {Vec3{1, 0, 0}, Vec3{0, -1, -0.0}, Vec3{1, 1, 0}}) {
            EXPECT_EQ(plane.intersect(line({0, 0, z}, along), &hit), 0);
            EXPECT_EQ(disc.intersect(line({0, 0, z}, along), &hit), 0);
            EXPECT_EQ(rectangle.intersect(line({0, 0, z}, along), &hit), 0);
        }
    }
    EXPECT_FALSE(std::fetestexcept(FE_INVALID));
}

TEST(PlanarShapes, BadFieldsAreReported) {
    const auto errors = [](const auto& shape) {
        Diagnostics diagnostics;
        shape.validate({}, diagnostics);
        return diagnostics.error_count();
    };
    EXPECT_EQ(errors(Plane{.normal = {0, 0, 0}}), 1u);
    EXPECT_EQ(errors(Disc{.normal = {0, 0, 0}}), 1u);
    EXPECT_EQ(errors(Disc{.radius = 1, .inner_radius = 1}), 1u);
    EXPECT_EQ(errors(Disc{.radius = 1, .inner_radius = -0.5}), 1u);
    EXPECT_EQ(errors(Rectangle{.edge_u = {1, 0, 0}, .edge_v = {2, 0, 0}}), 1u);
    EXPECT_EQ(errors(Rectangle{.edge_u = {0, 0, 0}}), 1u);
    EXPECT_EQ(errors(Rectangle{}), 0u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
