#include "alhazen/formats/text/text_cursor.h"

#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

/// As std::from_chars reads it.
double by_the_library(const std::string& text) {
    double value = 0.0;
    const char* const end = text.data() + text.size();
    EXPECT_EQ(std::from_chars(text.data(), end, value).ptr, end) << text;
    return value;
}

void expect_number(const std::string& text) {
    double value = 1.5;
    for (const char* behind : {"", " ", "\n"}) {
        const std::string line = text + behind;
        TextCursor cursor(line);
        ASSERT_TRUE(cursor.number(value)) << text;
        EXPECT_EQ(std::bit_cast<std::uint64_t>(value),
                  std::bit_cast<std::uint64_t>(by_the_library(text)))
            << text;
        EXPECT_EQ(cursor.bytes_left(), line.size() - text.size());
    }
}

TEST(TextCursor, NumbersAreTheNearestDoubles) {
    std::mt19937_64 random(5);
    for (int turn = 0; turn < 20'000; ++turn) {
        const std::size_t digits = 1 + random() % 20, point = random() % (digits + 1);
        std::string text = random() % 2 == 0 ? "-" : "";
        for (std::size_t i = 0; i < digits; ++i) {
            if (i == point) text += '.';
            text += char('0' + random() % (turn % 3 == 0 ? 2 : 10));
        }
        expect_number(text);
    }
    for (const char* text : {"0", "-0", "-0.0", "00012", "5.", ".5", "-.5", "1e3", "1.25E-4", "2e0",
                             "123456789012345", "1234567890123456", "0.000000000000001",
                             "0.0000000000000001", "999999999999999.9", "9007199254740993"}) {
        expect_number(text);
    }
}

TEST(TextCursor, WhatIsNoNumberIsLeftWhereItIs) {
    for (const char* text : {"", "-", ".", "-.", "x", "1x", "1.5x", "1.2.3", "1,5", "--1", "+-1",
                             "1-", "1e999", "nan", "inf", "12/3"}) {
        double value = 0.0;
        TextCursor cursor(text);
        EXPECT_FALSE(cursor.number(value)) << text;
        EXPECT_EQ(cursor.bytes_left(), std::string(text).size()) << text;
    }
}

TEST(TextCursor, IntegersEndAtAnythingElse) {
    struct Row {
        const char* text;
        std::int64_t value;
        std::size_t left;
    };
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    for (const Row& row : {Row{"0", 0, 0}, Row{"12/34", 12, 3}, Row{"007 ", 7, 1}, Row{"-5", -5, 0},
                           Row{"+5", 5, 0}, Row{"999999999999999999", 999999999999999999, 0},
                           Row{"9223372036854775807", kMost, 0}, Row{"3.5", 3, 2}}) {
        std::int64_t value = 0;
        TextCursor cursor(row.text);
        ASSERT_TRUE(cursor.leading_integer(value)) << row.text;
        EXPECT_EQ(value, row.value);
        EXPECT_EQ(cursor.bytes_left(), row.left) << row.text;
    }
    for (const char* text :
         {"", "-", "+", "x", "/1", "9223372036854775808", "99999999999999999999", "+-1"}) {
        std::int64_t value = 0;
        TextCursor cursor(text);
        EXPECT_FALSE(cursor.leading_integer(value)) << text;
        EXPECT_EQ(cursor.bytes_left(), std::string(text).size()) << text;
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
