#include "alhazen/base/control_characters.h"

#include <gtest/gtest.h>

#include "alhazen/base/diagnostics.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using namespace std::string_literals;

TEST(ControlCharacters, AreShownAsTheirCodes) {
    EXPECT_EQ(escape_controls("a\x1b[31m\a\x7f\0b\r\n"s), "a\\x1b[31m\\x07\\x7f\\x00b\\x0d\\x0a");
    EXPECT_EQ(escape_controls("a\nb\tc", Newlines::Keep), "a\nb\\x09c");
}

TEST(ControlCharacters, ThoseBeyondAsciiAreEscapedAndLettersAreNot) {
    EXPECT_EQ(escape_controls("\xc2\x9b"
                              "31m"),
              "\\xc2\\x9b31m");
    for (const char* text : {"Gr\xc3\xbc\xc3\x9f"
                             "e",
                             "\xc2\xa0", "\xe2\x82\xac", "\xc2", "\xff"}) {
        EXPECT_EQ(escape_controls(text), text);
    }
}

TEST(ControlCharacters, OfNamesDoNotReachMessages) {
    Diagnostics found;
    found.error({"a\x1b.mtl", 3, 0}, "no '\a\nb\0c'"s);
    EXPECT_EQ(to_string(found.all()[0]), "a\\x1b.mtl:3: error: no '\\x07\\x0ab\\x00c'");
    const Error error(ErrorKind::Scene, "x\0y\x1bz\nw"s);
    EXPECT_STREQ(error.what(), "x\\x00y\\x1bz\nw");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
