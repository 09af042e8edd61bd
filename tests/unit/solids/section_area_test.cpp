#include "alhazen/solids/solid_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "alhazen/base/error.h"
#include "closed_forms.h"
#include "one_solid.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::known_solids;
using testing::LoneScene;
using testing::OneSolid;
using testing::SceneMaker;

TEST(SectionArea, ASectionDoesNotDependOnTheLengthOfTheNormal) {
    const LoneScene scene(known_solids()[0]);
    const SectionArea one = section_area(scene.solid, {{1, 1, 0}, 0.1});
    EXPECT_GT(one.area.value, 0.1);
    for (const double size : {0x1p-1000, 0x1p-600, 0x1p600}) {
        const SectionArea other = section_area(scene.solid, {{size, size, 0}, 0.1 * size});
        EXPECT_EQ(other.area.value, one.area.value) << size;
        EXPECT_EQ(other.area.half_width, one.area.half_width) << size;
    }
}

TEST(SectionArea, SectionsHaveTheAreaOfDiscsEllipsesAndRectangles) {
    SceneMaker maker;
    maker.add(Sphere{{1, 1, 1}, 2});
    maker.add(Cylinder{{0, 0, -5}, {0, 0, 5}, 1});
    maker.add(BoxShape{{0, 0, 0}, {1, 2, 3}});
    const SolidList solids(maker.compile().aggregate);
    const MeasureOptions options{.relative_error = 1e-6, .seconds = 20};
    const SectionArea disc =
        section_area(IsolatedSolid(solids, SolidId{0}), {{0, 0, 2}, 4}, options);
    EXPECT_NEAR(disc.area.value, 3 * std::numbers::pi, 2 * disc.area.half_width);
    EXPECT_LT(disc.area.half_width, 1e-5);
    // A cut at 60 degrees to the axis has the semi-axes 1 and 2.
    const double s = std::sqrt(3.0) / 2;
    const SectionArea ellipse =
        section_area(IsolatedSolid(solids, SolidId{2}), {{0, s, 0.5}, 0.1}, options);
    EXPECT_NEAR(ellipse.area.value, 2 * std::numbers::pi, 2 * ellipse.area.half_width);
    const SectionArea rectangle =
        section_area(IsolatedSolid(solids, SolidId{1}), {{1, 0, 0}, 0.5}, options);
    EXPECT_NEAR(rectangle.area.value, 6, 1e-12);
    EXPECT_EQ(section_area(IsolatedSolid(solids, SolidId{1}), {{1, 0, 0}, 5}).area.value, 0);
    EXPECT_THROW((void)frame_of({{0, 0, 0}, 1}), Error);
}

TEST(SectionArea, SectionsOfPartsFarApartAndOfThreadsAreMetOrWide) {
    const MeasureOptions options{.relative_error = 1e-4, .seconds = 20};
    const double pi = std::numbers::pi;
    const OneSolid two(
        "union { sphere { radius=1e-3 } sphere { center=(1e6,3,0); radius=0.01 } "
        "sphere { center=(0,0,700) } }");
    const SectionArea discs = section_area(two.solid, {{0, 0, 1}, 0}, options);
    EXPECT_TRUE(discs.reached);
    EXPECT_NEAR(discs.area.value, pi * 1.01e-4, 2 * discs.area.half_width);
    // Between the parts there is nothing.
    const SectionArea between = section_area(two.solid, {{0, 0, 1}, 100}, options);
    EXPECT_TRUE(between.reached);
    EXPECT_EQ(between.area.hi(), 0.0);
    const OneSolid thread("cylinder { base=(-5,-7,-3); top=(5,7,3); radius=1e-10 }");
    const SectionArea point = section_area(thread.solid, {{0, 0, 1}, 0.5}, options);
    EXPECT_FALSE(point.reached);
    EXPECT_TRUE(point.area.holds(pi * 1e-20 * std::sqrt(83.0) / 3));
    EXPECT_GT(point.area.half_width, 1e-4);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
