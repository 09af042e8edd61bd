#include "alhazen/base/error.h"

#include <gtest/gtest.h>

#include "alhazen/base/diagnostics.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(FileLocation, LeavesOutWhatIsNotKnown) {
    EXPECT_EQ(to_string(FileLocation{"a.yaml", 3, 7}), "a.yaml:3:7");
    EXPECT_EQ(to_string(FileLocation{"a.yaml", 3, 0}), "a.yaml:3");
    EXPECT_EQ(to_string(FileLocation{"a.yaml", 0, 7}), "a.yaml");
    EXPECT_EQ(to_string(FileLocation{}), "");
}

TEST(Error, CarriesKindAndPlace) {
    const Error error(ErrorKind::Scene, "radius must be positive", {"a.yaml", 3, 7});
    EXPECT_STREQ(error.what(), "a.yaml:3:7: radius must be positive");
    EXPECT_EQ(error.kind(), ErrorKind::Scene);
    EXPECT_EQ(error.location(), (FileLocation{"a.yaml", 3, 7}));
    EXPECT_STREQ(Error(ErrorKind::Usage, "no such renderer").what(), "no such renderer");
}

TEST(Diagnostics, WarningsDoNotThrow) {
    Diagnostics diagnostics;
    diagnostics.warning({"a.yaml", 1, 1}, "odd");
    diagnostics.throw_if_errors();
    EXPECT_EQ(diagnostics.warning_count(), 1u);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    EXPECT_EQ(to_string(diagnostics.all().front()), "a.yaml:1:1: warning: odd");
}

TEST(Diagnostics, AllErrorsAreThrownAtOnce) {
    Diagnostics diagnostics;
    diagnostics.error({"a.yaml", 1, 1}, "first");
    diagnostics.warning({}, "odd");
    diagnostics.error({}, "second");
    try {
        diagnostics.throw_if_errors();
        FAIL() << "did not throw";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "a.yaml:1:1: error: first\nerror: second");
        EXPECT_EQ(error.kind(), ErrorKind::Scene);
    }
}

TEST(Diagnostics, ErrorsAreListedInTheOrderOfTheirLines) {
    Diagnostics diagnostics;
    diagnostics.error({"b.ray", 9, 1}, "late");
    diagnostics.error({"a.ray", 1, 1}, "of another file");
    diagnostics.error({"b.ray", 2, 5}, "right");
    diagnostics.error({"b.ray", 2, 1}, "left");
    diagnostics.error({"b.ray", 2, 5}, "right again");
    try {
        diagnostics.throw_if_errors();
        FAIL() << "did not throw";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "b.ray:2:1: error: left\nb.ray:2:5: error: right\n"
                     "b.ray:2:5: error: right again\nb.ray:9:1: error: late\n"
                     "a.ray:1:1: error: of another file");
    }
}

TEST(Diagnostics, AFloodIsCountedButNotKept) {
    Diagnostics diagnostics;
    for (int i = 0; i < 2500; ++i) diagnostics.error({}, "bad");
    EXPECT_EQ(diagnostics.all().size(), Diagnostics::kMaxKept);
    EXPECT_EQ(diagnostics.error_count(), 2500u);
    try {
        diagnostics.throw_if_errors();
        FAIL() << "did not throw";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("(and 1500 more errors)"), std::string::npos);
    }
}

TEST(Diagnostics, AnErrorAfterAFloodOfWarningsIsStillAnError) {
    Diagnostics diagnostics;
    for (int i = 0; i < 2500; ++i) diagnostics.warning({}, "odd");
    diagnostics.error({}, "bad");
    EXPECT_THROW(diagnostics.throw_if_errors(), Error);
}

TEST(Diagnostics, AFloodOfWarningsDoesNotHideAnError) {
    Diagnostics diagnostics;
    for (std::size_t i = 0; i < 2 * Diagnostics::kMaxKept; ++i) diagnostics.warning({}, "odd");
    diagnostics.error({"a", 7, 0}, "bad");
    try {
        diagnostics.throw_if_errors();
        FAIL() << "did not throw";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "a:7: error: bad");
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
