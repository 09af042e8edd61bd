// A million rays each: at shared edges and corners of bilinear patches, and at Steiner patches
// against their quartics.

#include "simple_patches.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(SimplePatches, AMillionRaysAtSharedEdgesOfBilinearPatchesCrossOne) {
    testing::Random random(1);
    testing::expect_no_leaks(random, 1000, 1000);
}

TEST(SimplePatches, AMillionRaysAtSteinerPatchesCrossThemAsByTheQuartic) {
    testing::Random random(2);
    const testing::QuarticComparison counts = testing::compare_with_quartic(random, 1000, 1000);
    EXPECT_EQ(counts.rays, 1000000);
    EXPECT_LE(counts.missed, 20);
    RecordProperty("crossings", counts.found);
    RecordProperty("delicate", counts.delicate);
    RecordProperty("missed_by_the_quartic", counts.missed);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
