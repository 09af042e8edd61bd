#include "alhazen/base/lower_case.h"

#include <gtest/gtest.h>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(LowerCase, OnlyAsciiLettersChange) {
    EXPECT_EQ(lower_case("AZaz09_[@\xC3\x84"), "azaz09_[@\xC3\x84");
    EXPECT_EQ(lower_case(""), "");
}

TEST(LowerCase, ASuffixIsThatOfTheNameAlone) {
    EXPECT_EQ(lower_suffix("dir.D/Picture.one.PNG"), ".png");
    EXPECT_EQ(lower_suffix("dir.D/picture"), "");
    EXPECT_EQ(lower_suffix(".hidden"), "");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
