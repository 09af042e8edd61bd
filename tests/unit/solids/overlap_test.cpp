#include "alhazen/solids/solid_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "one_solid.h"
#include "support/scene_maker.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::OneSolid;
using testing::SceneMaker;

TEST(OverlapOfSolids, TheLensOfTwoSpheresIsTheirOverlap) {
    SceneMaker maker;
    maker.add(Sphere{{0, 0, 0}, 1});
    maker.add(Sphere{{0.6, 0.8, 0}, 1});
    maker.add(Sphere{{5, 0, 0}, 1});
    const SolidList solids(maker.compile().aggregate);
    const IsolatedSolid a(solids, SolidId{0}), b(solids, SolidId{1}), c(solids, SolidId{2});
    // Two caps of height 1/2: 2 pi h^2 (3 - h) / 3 = 5 pi / 12.
    const SolidMeasures lens =
        measure(Overlap(a, b), {.relative_error = 1e-4, .seconds = 20, .area = false});
    EXPECT_NEAR(lens.volume.value, 5 * std::numbers::pi / 12, 2 * lens.volume.half_width);
    EXPECT_LT(lens.volume.half_width, 2e-4);
    EXPECT_EQ(measure(Overlap(a, c), {.area = false}).volume.value, 0);
}

TEST(OverlapOfSolids, BicylindersAreRightToFiveDigits) {
    // The intersection of two cylinders, 16 r^3 / 3; axis-aligned and rotated.
    for (const Affine& placement :
         {Affine{}, Affine::rotate({1, -2, 1}, 0.8) * Affine::scale({2, 2, 2})}) {
        SceneMaker maker;
        maker.add(Cylinder{{-2, 0, 0}, {2, 0, 0}, 1}, MaterialId{0}, placement);
        maker.add(Cylinder{{0, -2, 0}, {0, 2, 0}, 1}, MaterialId{0}, placement);
        const SolidList solids(maker.compile().aggregate);
        const IsolatedSolid a(solids, SolidId{0}), b(solids, SolidId{1});
        const SolidMeasures m =
            measure(Overlap(a, b), {.relative_error = 1e-5, .seconds = 20, .area = false});
        const double truth = 16.0 / 3 * std::abs(determinant(placement.linear));
        EXPECT_TRUE(m.reached);
        EXPECT_NEAR(m.volume.value, truth, 2 * m.volume.half_width);
        EXPECT_LE(m.volume.half_width, 1e-5 * truth);
    }
}

TEST(OverlapOfSolids, OverlapsOfPartsFarApartAreMet) {
    const OneSolid a(
        "union { sphere { radius=1 } sphere { center=(1000,0,0); radius=0.01 } "
        "sphere { center=(0,0,500) } }");
    const OneSolid b(
        "union { sphere { center=(-900,0,0) } sphere { center=(1000,0,0); radius=0.005 } }");
    const double volume = 4 * std::numbers::pi / 3 * 1.25e-7;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const MeasureOptions options{
            .relative_error = 1e-3, .seconds = 20, .area = false, .seed = seed};
        for (const Overlap& both : {Overlap(a.solid, b.solid), Overlap(b.solid, a.solid)}) {
            const SolidMeasures m = measure(both, options);
            EXPECT_TRUE(m.reached);
            EXPECT_NEAR(m.volume.value, volume, 2 * m.volume.half_width);
        }
    }
    // The boxes of the wholes overlap, those of the parts do not.
    const OneSolid apart("union { sphere { center=(0,0,9) } sphere { center=(1000,9,0) } }");
    const SolidMeasures nothing = measure(Overlap(a.solid, apart.solid), {.area = false});
    EXPECT_TRUE(nothing.reached);
    EXPECT_EQ(nothing.volume.hi(), 0.0);
}

TEST(OverlapOfSolids, AnOverlapThatNoLineMetHasAWideInterval) {
    const OneSolid thread("cylinder { base=(-5,-7,-3); top=(5,7,3); radius=1e-10 }");
    const OneSolid block("box { lo=(-1,-9,-9); hi=(1,9,9) }");
    const SolidMeasures m = measure(
        Overlap(thread.solid, block.solid),
        {.relative_error = 1e-3, .seconds = 0.2, .area = false, .most_lines_of_round = 1 << 14});
    EXPECT_FALSE(m.reached);
    EXPECT_TRUE(m.volume.holds(std::numbers::pi * 1e-20 * std::sqrt(332.0) / 5));
    EXPECT_GT(m.volume.half_width, 1e-4);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
