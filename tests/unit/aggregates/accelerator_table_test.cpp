#include "alhazen/aggregates/accelerator_table.h"

#include <gtest/gtest.h>

#include "alhazen/base/error.h"
#include "unit/aggregates/random_tables.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(AcceleratorTable, EveryNameMakesAnAggregateThatFindsASphere) {
    for (const AcceleratorEntry& entry : accelerator_table()) {
        testing::TableBuilder builder;
        builder.add_sphere({0, 0, 0}, 1);
        const auto aggregate = make_aggregate(entry.name, builder.finish());
        Hit hit;
        EXPECT_TRUE(aggregate->closest({{0, 0, 5}, {0, 0, -1}}, hit, nullptr)) << entry.name;
        EXPECT_EQ(hit.t, 4.0) << entry.name;
        EXPECT_EQ(aggregate->primitives().size(), 1u);
        EXPECT_STRNE(entry.description, "");
    }
}

TEST(AcceleratorTable, TheDefaultIsInIt) {
    EXPECT_EQ(std::string(accelerator_table().front().name), kDefaultAccelerator);
}

TEST(AcceleratorTable, AnUnknownNameIsRefusedWithTheValidOnes) {
    try {
        (void)make_aggregate("kd_tee", testing::TableBuilder{}.finish());
        FAIL() << "an unknown name was taken";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Usage);
        const std::string message = error.what();
        EXPECT_NE(message.find("kd_tee"), std::string::npos) << message;
        EXPECT_NE(message.find("wide_bvh, list"), std::string::npos) << message;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
