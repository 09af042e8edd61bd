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
                             "\xc2\xa0", "\xe2\x82\xac", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"}) {
        EXPECT_EQ(escape_controls(text), text);
    }
}

TEST(ControlCharacters, BytesThatAreNotUtf8AreEscaped) {
    const std::pair<const char*, const char*> kTexts[] = {
        {"Gr\xfcn", "Gr\\xfcn"},
        {"\xc2", "\\xc2"},
        {"\xff", "\\xff"},
        {"\x9b", "\\x9b"},
        {"\xe2\x82", "\\xe2\\x82"},
        {"\xe2\x82z", "\\xe2\\x82z"},
        {"\xc0\xaf", "\\xc0\\xaf"},                    // overlong
        {"\xe0\x9f\xbf", "\\xe0\\x9f\\xbf"},           // overlong
        {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // a surrogate
        {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // above U+10FFFF
        {"\xff\xc3\xbc", "\\xff\xc3\xbc"},
    };
    for (const auto& [text, shown] : kTexts) EXPECT_EQ(escape_controls(text), shown);
    const Error error(ErrorKind::Scene, "no 'Gr\xfcn'");
    EXPECT_STREQ(error.what(), "no 'Gr\\xfcn'");
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
