// Crossings of bilinear patches: against the certified patches, shared edges and corners,
// degenerate patches, rays along rulings and nearly tangent ones, bad input.

#include "alhazen/shapes/patches/bilinear_patch.h"

#include <gtest/gtest.h>

#include "alhazen/geometry/watertight_triangle.h"
#include "alhazen/shapes/patches/forms/exact_forms.h"
#include "simple_patches.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::bilinear;
using testing::crossings;
using testing::Random;
using testing::whole_line;

/// z = x y over [-1, 1]^2.
BilinearPatch saddle() {
    return bilinear({-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, 1});
}

/// A patch of any kind: skew, or with coincident corners, or a parallelogram.
BilinearPatch any_patch(Random& random) {
    Vec3 p[4];
    for (Vec3& x : p) x = random.in_cube(1.0);
    const int kind = random.below(8);
    if (kind == 0) p[1] = p[0];
    if (kind == 1) p[2] = p[0];
    if (kind == 2) p[3] = p[0];
    if (kind == 3) p[3] = p[1] + p[2] - p[0];
    if (kind == 4) p[3].z = p[2].z = p[1].z = p[0].z;
    return bilinear(p[0], p[1], p[2], p[3]);
}

TEST(BilinearPatch, CrossingsAreThoseOfTheCertifiedPatch) {
    Random random(1);
    int compared = 0, pairs = 0;
    for (int k = 0; k < 1000; ++k) {
        const BilinearPatch patch = any_patch(random);
        std::vector<BezierPiece> pieces;
        append_pieces(patch, pieces);
        const PatchTree tree(pieces);
        for (int i = 0; i < 100; ++i) {
            const double u = random.uniform(0, 1), v = random.uniform(0, 1);
            const Ray ray = whole_line(
                tree.pieces().net(0).degree_u == 1 ? point_at(tree.pieces().net(0), u, v) : Vec3{},
                random.unit_vector());
            ShapeHit hits[2];
            const int count = patch.intersect(ray, hits);
            ShapeHits expected;
            tree.intersect(ray, expected);
            // Two crossings as close as rounding are both reported or none.
            if (count == 2 && expected.empty() && hits[1].t - hits[0].t < 1e-11) continue;
            ASSERT_EQ(std::size_t(count), expected.size()) << k << " " << i;
            for (int j = 0; j < count; ++j) {
                const ShapeSurface s = patch.surface(ray, hits[j]);
                const double cosine = std::abs(dot(s.normal, ray.direction));
                EXPECT_LT(length(s.point - ray.at(hits[j].t)), 1e-13) << k << " " << i;
                if (cosine < 1e-3) continue;
                EXPECT_NEAR(hits[j].t, expected[std::size_t(j)].t, 1e-14 / cosine);
                ++compared;
            }
            pairs += count == 2;
        }
    }
    EXPECT_GT(compared, 90000);
    EXPECT_GT(pairs, 10000);
}

TEST(BilinearPatch, ATriangleIsCrossedWhereTheTriangleIs) {
    Random random(2);
    int hits = 0;
    for (int i = 0; i < 100000; ++i) {
        const Vec3 a = random.in_cube(1), b = random.in_cube(1), c = random.in_cube(1);
        const BilinearPatch patch = i % 2 == 0 ? bilinear(a, b, a, c) : bilinear(a, a, b, c);
        Vec3 target = a + random.uniform(0, 1) * (b - a);
        if (i % 3 == 0) target = random.in_cube(1);
        if (i % 7 == 0) target = a;
        const Ray ray = whole_line(target, random.unit_vector());
        ShapeHit hit, found[2];
        const bool expected = intersect_triangle(ray, RayShear(ray.direction), a, b, c, hit);
        const int count = patch.intersect(ray, found);
        // Two crossings within rounding of the apex, or of an edge seen end on, are none.
        ASSERT_EQ(count % 2 == 1, expected) << i;
        if (expected) {
            const Vec3 n = normalize(cross(b - a, c - a));
            const double cosine = std::abs(dot(n, ray.direction));
            EXPECT_NEAR(found[0].t, hit.t, 1e-14 / cosine) << i;
        }
        hits += expected;
    }
    EXPECT_GT(hits, 20000);
}

// A box with displaced corners, each face n x n patches: skew ones.
std::vector<BilinearPatch> closed_mesh(Random& random, int n, double wave) {
    std::vector<BilinearPatch> mesh;
    std::vector<Vec3> points;
    for (int k = 0; k < (n + 1) * (n + 1) * (n + 1); ++k) {
        const int x = k % (n + 1), y = k / (n + 1) % (n + 1), z = k / (n + 1) / (n + 1);
        points.push_back(Vec3{double(x), double(y), double(z)} * (1.0 / n) +
                         wave * random.in_cube(1.0 / n));
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side <= n; side += n) {
            for (int k = 0; k < n * n; ++k) {
                const auto corner = [&](int i, int j) {
                    int at[3];
                    at[axis] = side;
                    at[(axis + 1) % 3] = k % n + i;
                    at[(axis + 2) % 3] = k / n + j;
                    return points[std::size_t(at[0] + (n + 1) * (at[1] + (n + 1) * at[2]))];
                };
                mesh.push_back(bilinear(corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)));
            }
        }
    }
    return mesh;
}

TEST(BilinearPatch, ClosedMeshesAreCrossedEvenly) {
    Random random(3);
    int lines = 0;
    for (const double wave : {0.0, 0.3, 0.9}) {
        const std::vector<BilinearPatch> mesh = closed_mesh(random, 2, wave);
        for (int i = 0; i < 20000; ++i) {
            const BilinearPatch& patch = mesh[std::size_t(random.below(int(mesh.size())))];
            const double s = random.below(4) == 0 ? 0.0 : random.uniform(0, 1);
            Vec3 target = patch.p00 + s * (patch.p10 - patch.p00);
            if (i % 5 == 0) target = patch.p11;
            Vec3 direction = random.unit_vector();
            if (i % 7 == 0) direction = mesh[0].p00 - target;
            if (i % 11 == 0) direction = patch.p01 - patch.p00;
            if (i % 13 == 0) direction[random.below(3)] = 0.0;
            if (direction == Vec3{}) continue;
            const double away = random.below(2) == 0 ? 0.0 : random.log_uniform(1, 1e6);
            const Ray ray = whole_line(target - away * direction, direction);
            int count = 0;
            for (const BilinearPatch& each : mesh) count += crossings(each, ray);
            ASSERT_EQ(count % 2, 0) << wave << " " << i;
            ++lines;
        }
    }
    EXPECT_GT(lines, 59000);
}

TEST(BilinearPatch, ARayThroughASharedEdgeOrCornerCrossesOnePatch) {
    Random random(4);
    testing::expect_no_leaks(random, 100, 500);
}

TEST(BilinearPatch, ADoubleRootIsBothOrNone) {
    // The ray at height h along the diagonal of z = x y: x^2 = h.
    const BilinearPatch patch = saddle();
    for (double h = 1e-1; h > 1e-14; h *= 0.1) {
        // The corners as the ray sees them are rounded.
        const double rounding = 1e-15 / std::sqrt(h);
        const Ray above = whole_line({0, 0, h}, {1, 1, 0}),
                  below = whole_line({0, 0, -h}, {1, 1, 0});
        ShapeHit hits[2];
        ASSERT_EQ(patch.intersect(above, hits), 2) << h;
        EXPECT_NEAR(hits[0].t, -std::sqrt(h), rounding);
        EXPECT_NEAR(hits[1].t, std::sqrt(h), rounding);
        EXPECT_EQ(crossings(patch, below), 0) << h;
    }
    Random random(5);
    for (int i = 0; i < 20000; ++i) {
        const double u = random.uniform(0.1, 0.9), v = random.uniform(0.1, 0.9);
        const ShapeSurface s = patch.surface({}, {0, u, v, 0});
        const double angle = random.uniform(0, 2 * kPi);
        const Vec3 direction = std::cos(angle) * s.dpdu + std::sin(angle) * s.dpdv;
        const double gap = random.log_uniform(1e-16, 1e-2) * (random.coin() ? 1.0 : -1.0);
        const int count = crossings(patch, whole_line(s.point + gap * s.normal, direction));
        // The other root of a ray near a ruling may lie outside.
        if (std::abs(std::sin(2 * angle)) > 0.5) {
            EXPECT_EQ(count % 2, 0) << i;
        }
    }
}

TEST(BilinearPatch, ARayAlongARulingIsCrossedAtMostTwice) {
    const BilinearPatch patch = saddle();
    for (double x = -0.9; x < 1.0; x += 0.1) {
        ShapeHit hits[2];
        const int count = patch.intersect(whole_line({x, -3, -3 * x}, {0, 1, x}), hits);
        ASSERT_LE(count, 2);
        for (int k = 0; k < count; ++k) EXPECT_TRUE(hits[k].t >= 2.0 && hits[k].t <= 4.0);
    }
}

TEST(BilinearPatch, ARayInThePlaneOfAFlatPatchDoesNotCrossIt) {
    const BilinearPatch flat = bilinear({0, 0, 1}, {3, 0, 1}, {0, 2, 1}, {2, 2, 1});
    EXPECT_EQ(crossings(flat, whole_line({1, 1, 1}, {1, 0, 0})), 0);
    EXPECT_EQ(crossings(flat, whole_line({-5, 0.5, 1}, {1, 0.25, 0})), 0);
    EXPECT_EQ(crossings(flat, whole_line({1, 1, 7}, {0, 0, -1})), 1);
}

TEST(BilinearPatch, APatchOfPointsOnALineIsNotCrossed) {
    Random random(6);
    for (int i = 0; i < 10000; ++i) {
        const Vec3 a = random.in_cube(1), d = random.in_cube(1);
        const auto at = [&] { return a + random.uniform(-1, 1) * d; };
        const BilinearPatch patch = bilinear(at(), at(), at(), i % 2 == 0 ? at() : a);
        EXPECT_EQ(crossings(patch, whole_line(at(), random.unit_vector())), 0) << i;
    }
    EXPECT_EQ(crossings(bilinear({1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}),
                        whole_line({1, 1, 0}, {0, 0, 1})),
              0);
}

TEST(BilinearPatch, SizesFarFromOneAreOrdinary) {
    for (const double size : {1e-60, 1e-20, 1e20, 1e60}) {
        const BilinearPatch patch = bilinear(size * Vec3{-1, -1, 1}, size * Vec3{1, -1, -1},
                                             size * Vec3{-1, 1, -1}, size * Vec3{1, 1, 1});
        ShapeHit hits[2];
        ASSERT_EQ(patch.intersect(whole_line(size * Vec3{0, 0, 0.25}, {1, 1, 0}), hits), 2) << size;
        EXPECT_NEAR(hits[1].t / size, 0.5, 1e-15);
    }
}

TEST(BilinearPatch, TheNormalOfACollapsedEdgeIsTheLimit) {
    const BilinearPatch patch = bilinear({0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Vec3 normal = patch.surface({}, {0, 0.5, 0.0, 0}).normal;
    EXPECT_NEAR(std::abs(normal.z), 1.0, 1e-12);
}

TEST(BilinearPatch, FindsAllBadCorners) {
    BilinearPatch patch;
    patch.p10.y = std::numeric_limits<double>::quiet_NaN();
    patch.p11.x = kInfinity;
    patch.p01.z = 1e71;
    Diagnostics findings;
    patch.validate({"a.alhazen", 3, 1}, findings);
    EXPECT_EQ(findings.error_count(), 3u);
    Diagnostics none;
    BilinearPatch{}.validate({}, none);
    EXPECT_EQ(none.error_count(), 0u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
