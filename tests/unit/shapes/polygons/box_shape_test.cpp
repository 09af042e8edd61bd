#include "alhazen/shapes/polygons/box_shape.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/quad.h"
#include "support/random.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Quad;
using testing::Random;

const BoxShape kCube{.lo = {0, 0, 0}, .hi = {1, 1, 1}};

TEST(BoxShape, HitsNameTheFaceThatWasCrossed) {
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 origin{0.25, 0.25, 0.25}, direction{0.0, -0.0, 0.0};
        origin[axis] = -1;
        direction[axis] = 2;
        ShapeHit hits[2];
        ASSERT_EQ(kCube.intersect(line(origin, direction), hits), 2);
        EXPECT_EQ(hits[0].t, 0.5);
        EXPECT_EQ(hits[1].t, 1.0);
        EXPECT_EQ(hits[0].part, 2u * axis);
        EXPECT_EQ(hits[1].part, 2u * axis + 1);
        Vec3 outward{};
        outward[axis] = -1;
        EXPECT_EQ(kCube.surface(line(origin, direction), hits[0]).normal, outward);
        EXPECT_EQ(kCube.surface(line(origin, direction), hits[1]).normal, -outward);
    }
}

// `keeps_face`: in the upper face inside, in the lower one outside.
TEST(BoxShape, OfTwoOppositeFacesOneHoldsItsRaysWhateverTheSignOfZero) {
    for (const double zero : {0.0, -0.0}) {
        for (const double face : {0.0, -0.0, 1.0}) {
            ShapeHit hits[2];
            const int expected = face > 0.5 ? 2 : 0;
            EXPECT_EQ(kCube.intersect(line({-1, face, 0.5}, {1, zero, zero}), hits), expected);
            EXPECT_EQ(kCube.intersect(line({-1, face, 0.5}, {1, zero, 0.1}), hits), expected);
            EXPECT_EQ(kCube.intersect(line({0.5, 0.5, face}, {1, 1, zero}), hits), expected);
        }
    }
}

TEST(BoxShape, LinesThroughEdgesAndCornersCrossTwiceOrNever) {
    Random random(31);
    for (int i = 0; i < 100000; ++i) {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = random.below(2);
        if (random.coin()) p[random.below(3)] = random.uniform();
        const Vec3 d = random.coin() ? random.lattice_direction() : random.unit_vector();
        const Ray ray = line(p - static_cast<double>(random.below(4)) * d, d);
        ShapeHit hits[2];
        ASSERT_EQ(kCube.intersect(ray, hits) % 2, 0) << "seed 31, case " << i;
    }
}

TEST(BoxShape, HitsAgreeWithQuadruplePrecision) {
    Random random(32);
    int hit = 0;
    for (int i = 0; i < 50000; ++i) {
        const Vec3 lo = random.in_cube(3);
        const BoxShape box{.lo = lo,
                           .hi = lo + Vec3{random.uniform(0.1, 3), random.uniform(0.1, 3), 1}};
        const Vec3 d = random.unit_vector();
        const Ray ray = line(lo + random.in_cube(2) - random.uniform(-5, 5) * d, d);
        Quad entry = -1e30, exit = 1e30;
        for (int k = 0; k < 3; ++k) {
            const Quad o = ray.origin[k], inverse = Quad(1) / ray.direction[k];
            const Quad a = (box.lo[k] - o) * inverse, b = (box.hi[k] - o) * inverse;
            entry = std::max(entry, std::min(a, b));
            exit = std::min(exit, std::max(a, b));
        }
        ShapeHit hits[2];
        const int n = box.intersect(ray, hits);
        if (testing::magnitude(exit - entry) > 1e-12) {
            ASSERT_EQ(n, exit > entry ? 2 : 0) << "seed 32, case " << i;
        }
        if (n == 0) continue;
        ++hit;
        // One subtraction and one division: two half ulps.
        ASSERT_NEAR(hits[0].t, static_cast<double>(entry), std::abs(hits[0].t) * 0x1p-51) << i;
        ASSERT_NEAR(hits[1].t, static_cast<double>(exit), std::abs(hits[1].t) * 0x1p-51) << i;
    }
    EXPECT_GT(hit, 5000);
}

TEST(BoxShape, SurfacePointsLieOnTheFaceExactly) {
    Random random(33);
    const BoxShape box{.lo = {0.1, -0.3, 0.7}, .hi = {1.3, 1.7, 2.9}};
    for (int i = 0; i < 10000; ++i) {
        const Vec3 d = random.unit_vector();
        const Ray ray = line(random.in_cube(2) - 1e5 * d, d);
        ShapeHit hits[2];
        const int n = box.intersect(ray, hits);
        for (int k = 0; k < n; ++k) {
            const int axis = static_cast<int>(hits[k].part / 2);
            const ShapeSurface s = box.surface(ray, hits[k]);
            ASSERT_EQ(s.point[axis], hits[k].part % 2 ? box.hi[axis] : box.lo[axis]) << i;
            ASSERT_TRUE(box.box().contains(s.point)) << i;
            ASSERT_TRUE(s.uv.x >= 0 && s.uv.x <= 1 && s.uv.y >= 0 && s.uv.y <= 1) << i;
        }
    }
}

TEST(BoxShape, TextureCoordinatesRunAlongTheLowerAndHigherAxisOfEachFace) {
    const BoxShape box{.lo = {0, 0, 0}, .hi = {1, 2, 4}};
    const Vec3 inside{0.25, 1.5, 3};  // fractions 0.25, 0.75, 0.75
    const Vec2 expected[] = {{0.25, 0.75}, {0.75, 0.75}, {0.75, 0.75},
                             {0.25, 0.75}, {0.75, 0.75}, {0.25, 0.75}};
    for (std::uint32_t part = 0; part < 6; ++part) {
        Vec3 out{0, 0, 0};
        out[static_cast<int>(part / 2)] = part % 2 ? 1.0 : -1.0;
        const Ray ray{inside, out};
        ShapeHit hits[2];
        ASSERT_EQ(box.intersect(ray, hits), 1) << part;
        ASSERT_EQ(hits[0].part, part);
        const Vec2 uv = box.surface(ray, hits[0]).uv;
        EXPECT_EQ(uv.x, expected[part].x) << part;
        EXPECT_EQ(uv.y, expected[part].y) << part;
    }
}

TEST(BoxShape, FlatAndInvertedBoxesAreReported) {
    Diagnostics diagnostics;
    BoxShape{.lo = {0, 0, 0}, .hi = {1, 0, 1}}.validate({}, diagnostics);
    BoxShape{.lo = {0, 0, 2}, .hi = {1, 1, 1}}.validate({}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 2u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
