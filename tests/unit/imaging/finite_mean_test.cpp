#include "alhazen/imaging/film/finite_mean.h"

#include <gtest/gtest.h>

#include <limits>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(FiniteMean, IsTheMeanOfTheFiniteSamples) {
    FiniteMean mean;
    EXPECT_EQ(mean.value(), Rgb{});
    EXPECT_TRUE(mean.add({1, 2, 3}));
    EXPECT_EQ(mean.value(), (Rgb{1, 2, 3}));
    EXPECT_FALSE(mean.add({0, std::numeric_limits<double>::quiet_NaN(), 0}));
    EXPECT_FALSE(mean.add({std::numeric_limits<double>::infinity(), 0, 0}));
    EXPECT_TRUE(mean.add({3, 0, 1}));
    EXPECT_EQ(mean.value(), (Rgb{2, 1, 2}));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
