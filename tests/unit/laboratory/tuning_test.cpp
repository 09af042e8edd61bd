#include "alhazen/laboratory/tuning.h"

#include <gtest/gtest.h>

#include <map>

#include "alhazen/aggregates/accelerator_table.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Tuning, EverySettingThatIsTriedExists) {
    int tried = 0;
    for (const AcceleratorEntry& entry : accelerator_table()) {
        for (const TuningStep& step : tuning_steps(entry.name)) {
            for (const char* value : step.values) {
                const std::string accelerator =
                    std::string(entry.name) + ":" + step.setting + "=" + value;
                EXPECT_NO_THROW(check_accelerator(accelerator)) << accelerator;
                ++tried;
            }
        }
    }
    EXPECT_GT(tried, 10);
}

const auto kAlways = [] { return true; };

TEST(Tuning, KeepsTheBestValueOfEverySettingInTurn) {
    const std::map<std::string, double> cost{{"hierarchy", 10},
                                             {"hierarchy:bound=sphere", 8},
                                             {"hierarchy:bound=slabs7", 5},
                                             {"hierarchy:bound=slabs13", 6},
                                             {"hierarchy:bound=slabs7,order=stored", 4}};
    const TuningResult result = tune(
        "hierarchy", [&](const std::string& a) { return cost.at(a); }, kAlways);
    EXPECT_EQ(result.accelerator, "hierarchy:bound=slabs7,order=stored");
    EXPECT_EQ(result.tried, 4);
    EXPECT_FALSE(result.cut_short);
}

TEST(Tuning, StaysWithTheDefaultsForGainsThatAreNoise) {
    const TuningResult result = tune(
        "hierarchy", [](const std::string& a) { return a == "hierarchy" ? 1.0 : 0.98; }, kAlways);
    EXPECT_EQ(result.accelerator, "hierarchy");
}

TEST(Tuning, EndsWhenToldToAndSaysSo) {
    int left = 2;
    const TuningResult result = tune(
        "octree", [](const std::string&) { return 1.0; }, [&] { return left-- > 0; });
    EXPECT_TRUE(result.cut_short);
    EXPECT_EQ(result.tried, 2);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
