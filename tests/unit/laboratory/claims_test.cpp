#include "alhazen/laboratory/claims/claims.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "alhazen/base/error.h"
#include "alhazen/laboratory/claims/claim_run.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Claims, IdsAreUniqueAndParsed) {
    std::set<std::string> ids;
    for (const ClaimEntry& entry : claims()) EXPECT_TRUE(ids.insert(entry.id).second) << entry.id;
    EXPECT_EQ(parse_claims("all").size(), claims().size());
    EXPECT_EQ(parse_claims("B6,A2"), (std::vector<std::string>{"B6", "A2"}));
    for (const char* wrong : {"", "A0", "A1,", "a1"}) {
        EXPECT_THROW((void)parse_claims(wrong), Error) << wrong;
    }
}

TEST(Claims, TheExampleAndTheRuleHold) {
    const std::vector<ClaimReport> reports = check_claims({"B1", "B6"}, {.time_limit = 0.2});
    ASSERT_EQ(reports.size(), 2u);
    for (const ClaimReport& report : reports) {
        EXPECT_EQ(report.verdict, Verdict::Holds) << claims_table({&report, 1});
        EXPECT_FALSE(report.findings.empty());
    }
}

TEST(Claims, WhatDoesNotExistIsNotAvailable) {
    ClaimReport report;
    TrialCache trials;
    const ClaimOptions options;
    const ClaimRun run(report, options, trials);
    EXPECT_THROW((void)run.generated("cathedral", 4), ClaimUnavailable);
    EXPECT_THROW(run.need_accelerator("wishes"), ClaimUnavailable);
    EXPECT_NO_THROW(run.need_accelerator("kd_tree"));
    EXPECT_EQ(report.verdict, Verdict::NotAvailable);
}

TEST(Claims, TablesSayWhatDoesNotHold) {
    ClaimReport report{"X1", "all swans are white", "no other colour"};
    report.verdict = Verdict::Fails;
    report.findings = {{"swans", "3 black", "0", false}, {"seen", "20", "", {}}};
    EXPECT_NE(claims_table({&report, 1}).find("does not hold"), std::string::npos);
    const std::string markdown = claims_markdown({&report, 1});
    EXPECT_NE(markdown.find("| X1 | all swans are white | no other colour | **does not hold** |"),
              std::string::npos);
    EXPECT_NE(markdown.find("| swans | 3 black | 0 | NO |"), std::string::npos);
}

TEST(Claims, SlopesAreThoseOfPowers) {
    const std::array n{10.0, 100.0, 1000.0}, value{2.0, 2e3, 2e6};
    EXPECT_NEAR(log_log_slope(n, value), 3.0, 1e-12);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
