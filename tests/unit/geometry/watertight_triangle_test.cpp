#include "alhazen/geometry/watertight_triangle.h"

#include <gtest/gtest.h>

#include "support/quad.h"
#include "support/random.h"
#include "support/sphere_mesh.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::line;
using testing::Quad;
using testing::QuadVec;
using testing::Random;
using testing::SphereMesh;

int crossings(const SphereMesh& mesh, const Ray& ray) {
    const RayShear shear(ray.direction);
    int count = 0;
    ShapeHit hit;
    for (const auto& [a, b, c] : mesh.triangles) {
        count += intersect_triangle(ray, shear, mesh.positions[a], mesh.positions[b],
                                    mesh.positions[c], hit);
    }
    return count;
}

/// A vertex, the midpoint of an edge, or any point on an edge.
Vec3 random_target(const SphereMesh& mesh, Random& random) {
    const auto& triangle = mesh.triangles[random.below(static_cast<int>(mesh.triangles.size()))];
    const Vec3& a = mesh.positions[triangle[0]];
    const Vec3& b = mesh.positions[triangle[1]];
    switch (random.below(3)) {
        case 0:
            return a;
        case 1:
            return 0.5 * a + 0.5 * b;
        default:
            return a + random.uniform() * (b - a);
    }
}

TEST(WatertightTriangle, RaysFromInsideAimedAtVerticesAndEdgesAlwaysHitOnce) {
    const SphereMesh mesh(2);
    Random random(101);
    for (int i = 0; i < 150000; ++i) {
        const Vec3 target = random_target(mesh, random);
        const Vec3 origin = random.in_cube(0.4);
        const Ray ray{origin, target - origin};
        ASSERT_EQ(crossings(mesh, ray), 1) << "seed 101, case " << i;
    }
}

TEST(WatertightTriangle, LinesThroughVerticesAndEdgesCrossAnEvenNumberOfTimes) {
    const SphereMesh mesh(2);
    Random random(102);
    for (int i = 0; i < 100000; ++i) {
        // From up to 1e4 radii away, or through two of these points, which grazes or follows edges.
        const Vec3 target = random_target(mesh, random);
        Vec3 origin = target + random.log_uniform(0.01, 1e4) * random.unit_vector();
        if (i % 3 == 0) origin = random_target(mesh, random);
        if (origin == target) continue;
        const int count = crossings(mesh, line(origin, target - origin));
        ASSERT_EQ(count % 2, 0) << "seed 102, case " << i;
    }
}

TEST(WatertightTriangle, LatticeRaysOnALatticeMeshCrossAnEvenNumberOfTimes) {
    // Vertices at multiples of 1/4, so that rays intersect vertices, edges and faces exactly.
    const SphereMesh mesh(2, false);
    Random random(103);
    int crossed = 0;
    for (int i = 0; i < 100000; ++i) {
        const Ray ray = line(random.on_lattice(2, 0.125), random.lattice_direction());
        const int count = crossings(mesh, ray);
        ASSERT_EQ(count % 2, 0) << "seed 103, case " << i;
        crossed += count > 0;
        // A ray from a point strictly inside crosses the surface an odd number of times.
        const Vec3 o = random.on_lattice(0.25, 0.125);
        ASSERT_EQ(crossings(mesh, {o, ray.direction}) % 2, 1) << "seed 103, case " << i;
    }
    EXPECT_GT(crossed, 5000);
}

TEST(WatertightTriangle, HitsAreWhereQuadruplePrecisionPutsThem) {
    Random random(104);
    int hit_count = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 a = random.in_cube(2), b = random.in_cube(2), c = random.in_cube(2);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        const Vec3 d = random.log_uniform(0.1, 10) * random.unit_vector();
        const Vec3 target = a + u * (b - a) + v * (c - a);
        const Ray ray = line(target - random.uniform(-5, 5) * d, d);
        const QuadVec e1 = QuadVec(b) - QuadVec(a), e2 = QuadVec(c) - QuadVec(a), dir(d);
        const QuadVec to_origin = QuadVec(ray.origin) - QuadVec(a);
        const Quad det = dot(dir, cross(e2, e1));
        if (testing::magnitude(det) < Quad(0.1) * length(dir)) continue;
        const Quad exact_t = dot(to_origin, cross(e1, e2)) / det;
        const Quad exact_u = dot(dir, cross(e2, to_origin)) / det;
        const Quad exact_v = dot(dir, cross(to_origin, e1)) / det;
        const Quad margin = 1e-12;
        if (exact_u < margin || exact_v < margin || exact_u + exact_v > 1 - margin) continue;
        ShapeHit hit;
        ASSERT_TRUE(intersect_triangle(ray, RayShear(d), a, b, c, hit)) << "seed 104, case " << i;
        ASSERT_NEAR(hit.t, static_cast<double>(exact_t), 1e-11 / length(d)) << "case " << i;
        ASSERT_NEAR(hit.u, static_cast<double>(exact_u), 1e-11) << "seed 104, case " << i;
        ASSERT_NEAR(hit.v, static_cast<double>(exact_v), 1e-11) << "seed 104, case " << i;
        ++hit_count;
    }
    EXPECT_GT(hit_count, 50000);
}

TEST(WatertightTriangle, DegenerateAndEdgeOnTrianglesAreNeverHit) {
    Random random(105);
    ShapeHit hit;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 a = random.on_lattice(2, 0.5), d = random.lattice_direction();
        const Vec3 b = random.on_lattice(2, 0.5);
        const Ray ray = line(a - d, d);
        ASSERT_FALSE(intersect_triangle(ray, RayShear(d), a, a, b, hit)) << i;
        ASSERT_FALSE(intersect_triangle(ray, RayShear(d), a, b, b, hit)) << i;
        ASSERT_FALSE(intersect_triangle(ray, RayShear(d), a, a, a, hit)) << i;
        // Edge-on: the direction lies in the triangle's plane.
        ASSERT_FALSE(intersect_triangle(ray, RayShear(d), a, b, a + d, hit)) << i;
    }
}

TEST(WatertightTriangle, TheRangeOfTIsRespected) {
    const Vec3 a{0, 0, 3}, b{1, 0, 3}, c{0, 1, 3};
    const Vec3 d{0, 0, 2};
    const auto hits = [&](double t_min, double t_max) {
        ShapeHit hit;
        return intersect_triangle({{0.25, 0.25, 0}, d, t_min, t_max}, RayShear(d), a, b, c, hit);
    };
    EXPECT_TRUE(hits(0, 2));
    EXPECT_TRUE(hits(1.5, 1.5));
    EXPECT_FALSE(hits(0, 1.49));
    EXPECT_FALSE(hits(1.51, 9));
}

TEST(WatertightTriangle, TheProductsOfTinyWeightsDoNotUnderflow) {
    // A small triangle whose plane the ray leaves by only 2^-980 of its length, hit at the midpoint
    // of an edge: the weights are products of three small numbers.
    const double size = 0x1p-36;
    const Vec3 a = size * Vec3{0.5, -0.25, 0}, b = size * Vec3{-0.25, 0, 0.25},
               c = size * Vec3{0.25, 0.5, -0.25};
    const Vec3 direction{-1, 1, 0x1p-980};
    const Ray ray = line(size * Vec3{-0.5, 0.75, 0}, direction);
    ShapeHit hit;
    ASSERT_TRUE(intersect_triangle(ray, RayShear(direction), a, b, c, hit));
    EXPECT_DOUBLE_EQ(hit.t, -0.5 * size);
    EXPECT_DOUBLE_EQ(hit.u, 0.5);
    EXPECT_DOUBLE_EQ(hit.v, 0.5);
}

TEST(WatertightTriangle, AWeightOfTheLeastNumberPutsTheHitWhereItIs) {
    // The ray passes through the second vertex, and by the first at a distance of 2^-1074: the only
    // weight that is not zero is the least number, whose product with a length below 1 is 0.
    const Vec3 a{0, 0, 0x1p-1074}, b{0x1p-127, 0x1p-149, 0}, c{1, 1, -1};
    const Vec3 direction{0.5, -0.5, 0};
    const Ray ray = line({-0.5, 0.5, 0}, direction);
    ShapeHit hit;
    ASSERT_TRUE(intersect_triangle(ray, RayShear(direction), a, b, c, hit));
    EXPECT_DOUBLE_EQ(hit.t, 1);
    EXPECT_DOUBLE_EQ(hit.u, 1);
    EXPECT_DOUBLE_EQ(hit.v, 0);
}

TEST(EdgeSign, IsAntisymmetricAndNeverZeroForDistinctPoints) {
    Random random(106);
    int ties = 0;
    for (int i = 0; i < 200000; ++i) {
        const auto pick = [&] {
            const double scale = random.coin() ? 1.0 : 1.0 / 3.0;  // 1/3 times n is rounded
            return ShearedVertex<double>{scale * (random.below(7) - 3),
                                         scale * (random.below(7) - 3), 0};
        };
        const ShearedVertex<double> a = pick(), b = pick();
        const int sign = resolved_edge_sign(a, b);
        ASSERT_EQ(sign, -resolved_edge_sign(b, a)) << "seed 106, case " << i;
        ASSERT_EQ(sign == 0, a.x == b.x && a.y == b.y) << "seed 106, case " << i;
        const Quad exact = Quad(a.x) * b.y - Quad(a.y) * b.x;
        if (exact == 0) {
            ++ties;
        } else {
            ASSERT_EQ(sign > 0, exact > 0) << "seed 106, case " << i;
        }
    }
    EXPECT_GT(ties, 10000);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
