/// Ray statistics of the Standard Procedural Databases of the published sizes are independent of
/// the accelerator.

#include "spd_counters.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(SpdInvariants, HoldForEveryAcceleratorAtThePublishedSizes) {
    for (const std::string& name : testing::databases()) {
        const SceneDescription description = generate(name);
        const RayCounters expected = testing::spd_counters(description, "list", 48);
        for (const AcceleratorEntry& entry : accelerator_table()) {
            testing::expect_same_counters(testing::spd_counters(description, entry.name, 48),
                                          expected, name + " " + entry.name);
        }
    }
}

/// All rays of the protocol, as in Havran and Sixta, without accelerators that test every primitive
/// for every ray, which would take hours.
TEST(SpdInvariants, HoldForAllRaysOfTheProtocol) {
    for (const char* name : {"balls", "gears", "teapot", "tetra"}) {
        const SceneDescription description = generate(name);
        const RayCounters expected = testing::spd_counters(description, kDefaultAccelerator, 0);
        EXPECT_EQ(expected[RayKind::Eye].cast, 263169u);
        for (const AcceleratorEntry& entry : accelerator_table()) {
            if (testing::tests_everything(entry.name)) continue;
            testing::expect_same_counters(testing::spd_counters(description, entry.name, 0),
                                          expected, std::string(name) + " " + entry.name);
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
