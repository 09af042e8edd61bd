#include "alhazen/solids/measure_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(MeasureReport, WhatIsNotKnownIsNull) {
    MeasureReport report;
    report.solids.emplace_back();
    const auto nothing = measure_json(report)["solids"][0];
    EXPECT_TRUE(nothing["centroid"].is_null());
    EXPECT_TRUE(nothing["inertia_xx_yy_zz_xy_yz_zx"].is_null());
    EXPECT_NE(measure_text(report).find("centroid  none"), std::string::npos);
    EXPECT_TRUE(nothing["box"].is_null());
    EXPECT_NE(measure_text(report).find("box       none"), std::string::npos);
    report.solids[0].measures.box = {{1, 2, 3}, {4, 5, 6}};
    EXPECT_EQ(measure_json(report)["solids"][0]["box"][1][2], 6);
    report.solids[0].measures.has_moments = true;
    EXPECT_EQ(measure_json(report)["solids"][0]["centroid"].size(), 3u);
}

TEST(MeasureReport, NumbersOutOfRangeAreACheckThatFails) {
    MeasureReport report;
    report.solids.emplace_back();
    EXPECT_TRUE(report.holds());
    report.solids[0].measures.in_range = false;
    EXPECT_FALSE(report.holds());
    EXPECT_NE(measure_text(report).find("overflow"), std::string::npos);
}

TEST(MeasureReport, TheRoundingOfATotalAddsUp) {
    MeasureReport report;
    for (int i = 0; i < 3; ++i) {
        report.solids.emplace_back();
        report.solids.back().measures.volume = {1, 0.5, 0.25};
    }
    // Rounding 3/4, and scatter of 1/4 three times.
    const auto interval = measure_json(report)["total"]["volume"]["interval"];
    EXPECT_NEAR(interval[1].get<double>(), 3 + 0.75 + 0.25 * std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
