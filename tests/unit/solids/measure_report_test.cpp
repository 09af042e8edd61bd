#include "alhazen/solids/measure_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace alhazen {
namespace {

TEST(MeasureReport, WhatIsNotKnownIsNull) {
    MeasureReport report;
    report.solids.emplace_back();
    const auto nothing = measure_json(report)["solids"][0];
    EXPECT_TRUE(nothing["centroid"].is_null());
    EXPECT_TRUE(nothing["inertia_xx_yy_zz_xy_yz_zx"].is_null());
    EXPECT_NE(measure_text(report).find("centroid  none"), std::string::npos);
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

}  // namespace
}  // namespace alhazen
