/// Ray statistics of the Standard Procedural Databases are independent of the accelerator: small
/// sizes, every accelerator of the table (`spd_invariants_heavy_test.cpp`: the published sizes).

#include "spd_counters.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

constexpr int kSide = 24;

TEST(SpdInvariants, HoldForEveryAcceleratorAtSmallSizes) {
    for (const std::string& name : testing::databases()) {
        if (name == "sombrero") continue;  // at least 1922 triangles: in the heavy test
        const bool one = name == "gears" || name == "rings" || name == "shells";
        const SceneDescription description = generate(name, name == "tree" ? 4 : one ? 1 : 2);
        const RayCounters expected = testing::spd_counters(description, "list", kSide);
        EXPECT_EQ(expected[RayKind::Eye].cast, static_cast<std::uint64_t>(kSide * kSide));
        EXPECT_GT(expected[RayKind::Eye].hit, 50u) << name;
        EXPECT_GT(expected[RayKind::Shadow].cast, 20u) << name;
        for (const AcceleratorEntry& entry : accelerator_table()) {
            testing::expect_same_counters(testing::spd_counters(description, entry.name, kSide),
                                          expected, name + " " + entry.name);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
