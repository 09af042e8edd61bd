// Crossings of Steiner patches: against those by their implicit quartic or cubic, pieces of the
// Roman surface and of a sphere, tangent rays, planar patches, bad input.

#include "alhazen/shapes/patches/steiner_patch.h"

#include "alhazen/shapes/core/first_hit.h"
#include "alhazen/shapes/quadrics/sphere.h"
#include "simple_patches.h"
#include "support/any_ray.h"
#include "support/random_shapes.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::crossings;
using testing::Random;
using testing::random_steiner;
using testing::roman_piece;
using testing::sphere_piece;
using testing::whole_line;

TEST(SteinerPatch, CrossingsAreThoseByTheQuartic) {
    Random random(1);
    const testing::QuarticComparison counts = testing::compare_with_quartic(random, 100, 500);
    EXPECT_GT(counts.found, 25000);
    EXPECT_LT(counts.delicate, counts.rays / 100);
    EXPECT_LE(counts.missed, 5);
}

TEST(SteinerPatch, TheQuarticVanishesOnThePatch) {
    Random random(2);
    for (int k = 0; k < 50; ++k) {
        const SteinerPatch patch = random_steiner(random);
        const SteinerImplicit implicit(patch);
        ASSERT_EQ(implicit.degree(), 4);
        for (int i = 0; i < 50; ++i) {
            const double v = random.uniform(0, 1), u = random.uniform(0, 1 - v);
            const Vec3 p = patch.surface({}, {0, u, v, 0}).point;
            EXPECT_LT(std::abs(implicit.value(p)), 1e-14) << k;
        }
    }
}

TEST(SteinerPatch, TheQuarticOfTheRomanSurfaceIsThatOfTheRomanSurface) {
    const SteinerImplicit implicit(roman_piece({1, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}));
    const auto known = [](const Vec3& p) {
        return p.x * p.x * p.y * p.y + p.y * p.y * p.z * p.z + p.z * p.z * p.x * p.x -
               p.x * p.y * p.z;
    };
    const Vec3 somewhere{0.3, -0.2, 0.4};
    const double factor = implicit.value(somewhere) / known(somewhere);
    Random random(3);
    for (int i = 0; i < 100; ++i) {
        const Vec3 p = random.in_cube(0.5);
        EXPECT_NEAR(implicit.value(p), factor * known(p), 1e-12 * std::abs(factor));
    }
}

TEST(SteinerPatch, PointsAreAtTheirCrossings) {
    // Among them lines in the plane of a flat patch, along an edge at which a derivative is zero.
    Random random(31);
    int compared = 0;
    for (int k = 0; k < 800; ++k) {
        const auto patch = testing::random_shape<SteinerPatch>({random, true});
        for (int i = 0; i < 200; ++i) {
            const Ray ray = whole_line(random.on_lattice(5, 0.25), random.lattice_direction());
            ShapeHit hits[SteinerPatch::kMaxHits];
            const int count = patch.intersect(ray, hits);
            for (int j = 0; j < count; ++j) {
                const Vec3 point = patch.surface(ray, hits[j]).point;
                ASSERT_LT(length(point - ray.at(hits[j].t)), 4e-13) << k << " " << i;
            }
            compared += count;
        }
    }
    EXPECT_GT(compared, 300);
}

TEST(SteinerPatch, ASurfaceWithABasePointIsACubic) {
    Random random(4);
    int found = 0;
    for (int k = 0; k < 20; ++k) {
        // All four coordinates vanish at (r, u, v) = (1, 1, -1).
        SteinerPatch patch;
        patch.weights = {1, 1, 1, 2, 2, 4};
        for (int i = 0; i < 5; ++i) patch.points.push_back(random.in_cube(1));
        const std::vector<Vec3>& p = patch.points;
        patch.points.push_back(0.25 * (4.0 * p[3] + 4.0 * p[4] - p[0] - 2.0 * p[1] - p[2]));
        patch.prepare();
        const SteinerImplicit implicit(patch);
        ASSERT_EQ(implicit.degree(), 3);
        for (int i = 0; i < 500; ++i) {
            const Ray ray = whole_line(random.in_cube(1), random.unit_vector());
            ShapeHit hits[4], others[4];
            const int count = patch.intersect(ray, hits), other = implicit.crossings(ray, others);
            if (testing::is_delicate(hits, count) || testing::is_delicate(others, other)) continue;
            ASSERT_EQ(count, other) << k << " " << i;
            for (int j = 0; j < count; ++j) EXPECT_NEAR(hits[j].t, others[j].t, 1e-10);
            found += count;
        }
    }
    EXPECT_GT(found, 1000);
}

TEST(SteinerPatch, OfASphereHasTheCrossingsOfTheSphere) {
    const SteinerPatch patch = sphere_piece({0, 0}, {1, 0}, {0, 1});
    EXPECT_FALSE(SteinerImplicit(patch).usable());
    const Sphere sphere;
    Random random(5);
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 through = random.in_cube(1.1);
        const Ray ray = whole_line(through, random.unit_vector());
        ShapeHit hits[4], whole[2];
        const int count = patch.intersect(ray, hits);
        const int of_sphere = sphere.intersect(ray, whole);
        // The piece is where x, y >= 0 and x + y - z <= 1.
        std::vector<double> expected;
        bool close = of_sphere == 2 && whole[1].t - whole[0].t < 1e-5;
        for (int k = 0; k < of_sphere; ++k) {
            const Vec3 p = ray.at(whole[k].t);
            const double least = std::min({p.x, p.y, 1.0 - p.x - p.y + p.z});
            close = close || std::abs(least) < 1e-9;
            if (least > 0.0) expected.push_back(whole[k].t);
        }
        if (close) continue;
        ASSERT_EQ(std::size_t(count), expected.size()) << i;
        for (int k = 0; k < count; ++k) {
            EXPECT_NEAR(hits[k].t, expected[std::size_t(k)], 1e-9);
            const Vec3 p = patch.surface(ray, hits[k]).point;
            EXPECT_GT(dot(patch.surface(ray, hits[k]).normal, p), 1.0 - 1e-12);
        }
        found += count;
    }
    EXPECT_GT(found, 1500);
}

TEST(SteinerPatch, ARayTangentToASphereIsCrossedEvenly) {
    const SteinerPatch patch = sphere_piece({-0.4, -0.4}, {0.9, 0}, {0, 0.9});
    Random random(6);
    for (int i = 0; i < testing::cases(5000, 20000); ++i) {
        const double v = random.uniform(0.2, 0.4), u = random.uniform(0.2, 0.4);
        const ShapeSurface s = patch.surface({}, {0, u, v, 0});
        const double angle = random.uniform(0, 2 * kPi);
        const Vec3 direction = normalize(std::cos(angle) * s.dpdu + std::sin(angle) * s.dpdv);
        // Below 1e-11 rounding decides.
        const double gap = random.log_uniform(1e-14, 1e-4);
        const double outside = random.coin() ? 1.0 : -1.0;
        const int count =
            crossings(patch, whole_line(s.point + outside * gap * s.normal, direction));
        if (outside > 0 && gap > 1e-11) {
            ASSERT_EQ(count, 0) << i << " " << gap;
        } else if (gap > 1e-11) {
            ASSERT_EQ(count, 2) << i << " " << gap;
        } else {
            ASSERT_EQ(count % 2, 0) << i << " " << gap;
        }
    }
}

TEST(SteinerPatch, TheRomanSurfaceOfSixteenPiecesIsCrossedEvenly) {
    // The pieces of the projective plane: four octants of four triangles, glued at their edges.
    std::vector<SteinerPatch> pieces;
    for (int k = 0; k < 4; ++k) {
        const Vec3 x{k % 2 == 0 ? 1.0 : -1.0, 0, 0}, y{0, k < 2 ? 1.0 : -1.0, 0}, z{0, 0, 1};
        const Vec3 xy = 0.5 * (x + y), yz = 0.5 * (y + z), zx = 0.5 * (z + x);
        pieces.push_back(roman_piece(x, xy, zx));
        pieces.push_back(roman_piece(y, yz, xy));
        pieces.push_back(roman_piece(z, zx, yz));
        pieces.push_back(roman_piece(xy, yz, zx));
    }
    Random random(7);
    int lines = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray ray = whole_line(random.in_cube(0.5), random.unit_vector());
        int count = 0;
        for (const SteinerPatch& piece : pieces) count += crossings(piece, ray);
        ASSERT_EQ(count % 2, 0) << i;
        ASSERT_LE(count, 4) << i;
        lines += count == 4;
    }
    EXPECT_GT(lines, 100);
}

TEST(SteinerPatch, APlanarPatchIsCrossedOnce) {
    SteinerPatch patch;
    patch.points = {{0, 0, 1}, {0.5, 0, 1}, {1, 0, 1}, {0, 0.5, 1}, {0.5, 0.5, 1}, {0, 1, 1}};
    patch.prepare();
    EXPECT_FALSE(SteinerImplicit(patch).usable());
    ShapeHit hits[4];
    ASSERT_EQ(patch.intersect(whole_line({0.25, 0.5, 3}, {0, 0, -1}), hits), 1);
    EXPECT_NEAR(hits[0].t, 2.0, 1e-15);
    EXPECT_NEAR(hits[0].u, 0.25, 1e-15);
    EXPECT_NEAR(hits[0].v, 0.5, 1e-15);
    EXPECT_EQ(crossings(patch, whole_line({0.7, 0.7, 3}, {0, 0, -1})), 0);
    EXPECT_EQ(crossings(patch, whole_line({0.25, 0.25, 1}, {1, 0.5, 0})), 0);
}

TEST(SteinerPatch, ALineInTheSurfaceHasFourCrossingsAtMost) {
    // A cone over a parabola.
    SteinerPatch patch;
    patch.points = {{0, 0, 0},        {0.5, 0, 0.5}, {1, 0, 1},
                    {0.25, 0.5, 0.5}, {0.5, 0.5, 1}, {0, 1, 1}};
    patch.prepare();
    for (int k = 0; k <= 10; ++k) {
        const Vec3 p = patch.surface({}, {0, 1.0 - 0.1 * k, 0.1 * k, 0}).point;
        EXPECT_LE(crossings(patch, whole_line({0, 0, 0}, p)), 4);
    }
}

TEST(SteinerPatch, TheFirstHitIsTheFirstOfAll) {
    Random random(8);
    for (int k = 0; k < 30; ++k) {
        const SteinerPatch patch = random_steiner(random);
        for (int i = 0; i < 300; ++i) {
            const Ray ray = testing::any_ray(patch.box(), random);
            ShapeHit hits[4], hit;
            const int count = patch.intersect(ray, hits);
            ASSERT_EQ(find_first_hit(patch, ray, hit), count > 0);
            if (count > 0) {
                ASSERT_TRUE(testing::same_bits(hit, hits[0]));
            }
        }
    }
}

TEST(SteinerPatch, DerivativesAndNormalAreThoseOfThePoint) {
    Random random(9);
    for (int k = 0; k < 100; ++k) {
        const SteinerPatch patch = random_steiner(random);
        const double v = random.uniform(0.1, 0.8), u = random.uniform(0.05, 0.9 - v), h = 1e-5;
        const auto at = [&](double x, double y) { return patch.surface({}, {0, x, y, 0}).point; };
        const ShapeSurface s = patch.surface({}, {0, u, v, 0});
        const double size = 1e-7 * (1 + length(s.dpdu) + length(s.dpdv));
        EXPECT_LT(length(s.dpdu - (at(u + h, v) - at(u - h, v)) / (2 * h)), size);
        EXPECT_LT(length(s.dpdv - (at(u, v + h) - at(u, v - h)) / (2 * h)), size);
        EXPECT_NEAR(dot(s.normal, s.dpdu), 0.0, 1e-9);
    }
    // The corner where all three points of a side meet: the limit.
    SteinerPatch pole;
    pole.points = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0}};
    pole.prepare();
    EXPECT_NEAR(std::abs(pole.surface({}, {0, 0.5, 0, 0}).normal.z), 1.0, 1e-9);
}

TEST(SteinerPatch, FindsAllThatIsWrong) {
    const auto findings_of = [](const SteinerPatch& patch) {
        Diagnostics findings;
        patch.validate({"a.alhazen", 3, 1}, findings);
        return findings.error_count();
    };
    SteinerPatch patch = roman_piece({1, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5});
    EXPECT_EQ(findings_of(patch), 0u);
    patch.points[2].y = std::numeric_limits<double>::quiet_NaN();
    patch.weights[3] = 0.0;
    patch.weights[4] = -1.0;
    patch.weights[5] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(findings_of(patch), 4u);
    patch.points.pop_back();
    EXPECT_EQ(findings_of(patch), 6u);  // too few, and not as many weights
    EXPECT_EQ(findings_of(SteinerPatch{}), 1u);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
