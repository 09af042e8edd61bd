#include "alhazen/verification/verify_exact.h"

#include <gtest/gtest.h>

#include "alhazen/verification/exact_crossings.h"
#include "support/random.h"
#include "support/random_profiles.h"
#include "support/random_shapes.h"
#include "support/scene_maker.h"
#include "support/thorough.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::Random;
using testing::SceneMaker;

std::string first_of(const ExactReport& report) {
    if (report.reported.empty()) return "";
    const Disagreement& d = report.reported.front();
    std::ostringstream text;
    text.precision(17);
    text << d.kind << " " << d.query << " origin " << d.ray.origin.x << " " << d.ray.origin.y << " "
         << d.ray.origin.z << " direction " << d.ray.direction.x << " " << d.ray.direction.y << " "
         << d.ray.direction.z << " found " << d.found << " expected " << d.expected;
    return text.str();
}

TEST(Real128, RootsAreRightToAllItsDigits) {
    for (const double x : {2.0, 3.0, 1e-100, 7.5e120, 0.3}) {
        const Real128 root = square_root(x);
        const Real128 off = (root * root - x) / x;
        EXPECT_LT(std::abs(static_cast<double>(off)), 1e-33) << x;
    }
    EXPECT_EQ(static_cast<double>(square_root(0)), 0);
}

TEST(VerifyExact, ShapesAtRandomPlacesAndSizesAreRight) {
    for (const bool lattice : {false, true}) {
        Random random(lattice ? 3 : 4);
        SceneMaker maker;
        const testing::ShapeSource source{random, lattice};
        for (int i = 0; i < 15; ++i) {
            const Affine placement =
                lattice ? Affine::translate(random.on_lattice(4, 0.5))
                        : Affine::translate(random.in_cube(100)) *
                              Affine::rotate(random.unit_vector(), random.uniform(0, 6)) *
                              Affine::scale({1, random.uniform(0.5, 2), random.uniform(0.1, 5)});
            maker.add(testing::random_shape<Sphere>(source), MaterialId{0}, placement);
            maker.add(testing::random_shape<BoxShape>(source), MaterialId{0}, placement);
            maker.add(testing::random_shape<Cylinder>(source), MaterialId{0}, placement);
            maker.add(testing::random_shape<Cone>(source), MaterialId{0}, placement);
            maker.add(testing::random_shape<HalfSpace>(source), MaterialId{0}, placement);
            maker.add(testing::random_shape<Polyhedron>(source), MaterialId{0}, placement);
        }
        (void)maker.compile();
        const ExactReport report = verify_exact(maker.description(), {.rays = 20000});
        EXPECT_GT(report.solids, 50u);
        EXPECT_EQ(report.unchecked, 0u);
        EXPECT_GT(report.crossings, 10000u);
        EXPECT_EQ(report.disagreements, 0u) << first_of(report);
        EXPECT_LE(report.worst_point, 1.0);
        EXPECT_GT(report.worst_point, 0.0);
        // Most rays must be resolved without displaced lines.
        EXPECT_LT(report.grazing, report.rays / 4);
    }
}

template <class S>
ExactReport verified(int count, std::uint64_t rays, int seed) {
    Random random(static_cast<std::uint64_t>(seed));
    SceneMaker maker;
    for (int i = 0; i < count; ++i) {
        const testing::ShapeSource source{random, i % 2 == 0};
        S shape = testing::random_shape<S>(source);
        while (!shape.closed()) shape = testing::random_shape<S>(source);
        if constexpr (requires { shape.capped; }) shape.capped = true;
        const Affine placement = i % 2 == 0 ? Affine::translate(random.on_lattice(4, 0.5))
                                            : Affine::translate(random.in_cube(20)) *
                                                  Affine::rotate(random.unit_vector(), 0.7) *
                                                  Affine::scale({1, random.uniform(0.5, 2), 1});
        maker.add(shape, MaterialId{0}, placement);
    }
    (void)maker.compile();
    return verify_exact(maker.description(), {.rays = rays});
}

template <class S>
class VerifyExactShape : public ::testing::Test {};
using ShapesWithFormulas =
    ::testing::Types<Ellipsoid, EllipticCylinder, EllipticCone, Tgc, Torus, Paraboloid, Hyperboloid,
                     TwoSheetHyperboloid, Quadric, Algebraic, Superellipsoid, Blob, Prism, Lathe,
                     HeightField>;
TYPED_TEST_SUITE(VerifyExactShape, ShapesWithFormulas);

TYPED_TEST(VerifyExactShape, IsRight) {
    const unsigned count = testing::thorough() ? 10 : 4;
    const ExactReport report = verified<TypeParam>(static_cast<int>(count), 150 * count, 5);
    EXPECT_EQ(report.solids, count);
    EXPECT_EQ(report.unchecked, 0u);
    EXPECT_GT(report.crossings, 50 * count);
    EXPECT_EQ(report.disagreements, 0u) << first_of(report);
    EXPECT_GT(report.worst_point, 0.0);
    EXPECT_LE(report.worst_point, 1.0);
    EXPECT_LT(report.grazing, report.rays / 3);
}

TEST(VerifyExact, SuperellipsoidsWithOneExponentAboveTwoAndOneBelowAreRight) {
    Random random(9);
    SceneMaker maker;
    const unsigned count = testing::thorough() ? 12 : 4;
    for (unsigned i = 0; i < count; ++i) {
        const double star = random.log_uniform(2.05, 6), round = random.log_uniform(0.3, 1.9);
        const Superellipsoid shape{.center = random.on_lattice(4, 0.5),
                                   .east = i % 2 == 0 ? star : round,
                                   .north = i % 2 == 0 ? round : star};
        const Affine placement =
            i % 3 == 0 ? Affine{}
                       : Affine::rotate(random.unit_vector(), 0.7) * Affine::scale({1, 2, 1});
        maker.add(shape, MaterialId{0}, placement);
    }
    (void)maker.compile();
    const ExactReport report = verify_exact(maker.description(), {.rays = 50 * count});
    EXPECT_EQ(report.solids, count);
    EXPECT_EQ(report.unchecked, 0u);
    EXPECT_GT(report.crossings, 25 * count);
    EXPECT_EQ(report.disagreements, 0u) << first_of(report);
    EXPECT_LE(report.worst_point, 1.0);
    EXPECT_LT(report.grazing, report.rays / 3);
}

TEST(VerifyExact, SolidsMadeOfOthersAreRight) {
    Random random(8);
    SceneMaker maker;
    for (int i = 0; i < 12; ++i) {
        const ObjectIndex solid = maker.object("solid");
        auto& object = maker.description().objects.back();
        object.combine = i % 3 == 0   ? Combine::Union
                         : i % 3 == 1 ? Combine::Intersection
                                      : Combine::Difference;
        const double far = i % 3 == 1 ? 0.3 : 1.0;
        maker.add(Cone{{0, 0, -1.5}, {0, 0, 1.5}, 1.5, 1}, MaterialId{0}, {}, solid);
        maker.add(BoxShape{{-1, -1, -1}, {1, 1, 1}}, MaterialId{0},
                  Affine::translate(random.in_cube(far)) *
                      Affine::rotate(random.unit_vector(), random.uniform(0, 6)),
                  solid);
        maker.add(Cylinder{{0, 0, -2}, {0, 0, 2}, 0.5}, MaterialId{0},
                  Affine::rotate(random.unit_vector(), random.uniform(0, 6)), solid);
        maker.add(solid, MaterialId{0}, Affine::translate({4.0 * i, 0, 0}));
    }
    (void)maker.compile();
    const ExactReport report = verify_exact(maker.description(), {.rays = 6000});
    EXPECT_EQ(report.solids, 12u);
    EXPECT_EQ(report.disagreements, 0u) << first_of(report);
    EXPECT_GT(report.crossings, 3000u);
}

TEST(VerifyExact, AMeshIsNotChecked) {
    SceneMaker maker;
    maker.add(maker.mesh(testing::tetrahedron()));
    maker.add(Sphere{});
    (void)maker.compile();
    EXPECT_EQ(verify_exact(maker.description(), {.rays = 200}).solids, 1u);
}

TEST(ExactCrossings, AWrongCrossingIsFarFromTheTruth) {
    // Basis of the check: the formula detects a sphere that is wrong in the last digits.
    const ExactLine line{{-3, Real128(0.3), 0}, {1, 0, 0}};
    const ExactCrossings truth = exact_crossings(Sphere{{0, 0, 0}, 1}, line);
    const ExactCrossings wrong = exact_crossings(Sphere{{0, 0, 0}, 1 + 1e-15}, line);
    ASSERT_EQ(truth.t.size(), 2u);
    const double off = static_cast<double>(truth.t[0] - wrong.t[0]);
    EXPECT_NEAR(off, 1e-15 / std::sqrt(1 - 0.09), 2e-16);
}

/// Kummer's quartic with its sixteen double points.
Algebraic kummer() {
    Algebraic surface;
    surface.expression = "(x^2+y^2+z^2-1.5)^2-(11/7)*((1-z)^2-2*x^2)*((1+z)^2-2*y^2)";
    surface.clip_box = {{-3, -3, -3}, {3, 3, 3}};
    return surface;
}

TEST(VerifyExact, ASurfaceWithDoublePointsIsRight) {
    SceneMaker maker;
    maker.add(kummer());
    (void)maker.compile();
    const std::uint64_t rays = testing::thorough() ? 7000 : 2000;
    const ExactReport report = verify_exact(maker.description(), {.rays = rays});
    EXPECT_GT(report.crossings, rays * 5 / 7);
    EXPECT_EQ(report.disagreements, 0u) << first_of(report);
}

TEST(VerifyExact, RootsBesideDoublePointsAreRightToTheLastDigits) {
    Algebraic surface = kummer();
    surface.prepare();
    const Ray ray{{0.24948949458353442, -1.0149472953527794, -0.1074664059135908},
                  {0.49753556098682122, 0.8355357222830907, -0.23310603695393398}};
    ShapeHit hits[Algebraic::kMaxHits];
    ASSERT_EQ(surface.intersect(ray, hits), 2);
    const ExactLine line{Vec3Of<Real128>(ray.origin), Vec3Of<Real128>(ray.direction)};
    const ExactCrossings truth = exact_crossings(surface, line);
    ASSERT_EQ(truth.t.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(hits[i].t, static_cast<double>(truth.t[i]), 4e-16 * hits[i].t);
    }
}

TEST(VerifyExact, SolidsWithoutAFormulaAreNamedWithTheReason) {
    SceneMaker maker;
    const ObjectIndex cut = maker.object("cut");
    maker.description().objects.back().combine = Combine::Difference;
    maker.add(Sphere{}, MaterialId{0}, {}, cut);
    maker.add(maker.mesh(testing::tetrahedron()), MaterialId{0}, {}, cut);
    maker.add(Sphere{{9, 0, 0}, 1});
    maker.add(cut);
    (void)maker.compile();
    const ExactReport report = verify_exact(maker.description(), {.rays = 100});
    EXPECT_EQ(report.solids, 1u);
    EXPECT_EQ(report.unchecked, 1u);
    ASSERT_EQ(report.unchecked_solids.size(), 1u);
    const UncheckedSolid& one = report.unchecked_solids.front();
    EXPECT_NE(one.reason.find("has no formula"), std::string::npos) << one.reason;
    EXPECT_NE(one.name.find("cut"), std::string::npos) << one.name;
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
