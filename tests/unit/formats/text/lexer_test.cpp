#include "alhazen/formats/text/lexer.h"

#include <gtest/gtest.h>

#include <random>

#include "alhazen/formats/text/text_tree.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

struct Lexed {
    std::vector<Token> tokens;
    Diagnostics diagnostics;
};

Lexed lex(const SourceText& source) {
    Lexed result;
    Lexer lexer(source, result.diagnostics);
    for (Token token = lexer.next(); token.kind != TokenKind::End; token = lexer.next()) {
        result.tokens.push_back(token);
    }
    return result;
}

TEST(Lexer, ACommentEndsWithItsLineWhateverEndsTheLine) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
        const std::string text = "1 // a" + std::string(end) + "2";
        const SourceText source(text, "f");
        EXPECT_EQ(lex(source).tokens.size(), 2u);
    }
}

double number_of(const std::string& text) {
    const SourceText source(text, "f");
    const Lexed lexed = lex(source);
    EXPECT_EQ(lexed.diagnostics.error_count(), 0u) << text;
    EXPECT_EQ(lexed.tokens.size(), 1u) << text;
    return lexed.tokens.empty() ? -1e9 : lexed.tokens[0].number;
}

std::string first_error(const std::string& text) {
    const SourceText source(text, "f");
    const Lexed lexed = lex(source);
    EXPECT_EQ(lexed.diagnostics.error_count(), 1u) << text;
    return lexed.diagnostics.all().empty() ? "" : to_string(lexed.diagnostics.all()[0]);
}

TEST(Lexer, ReadsEveryFormOfNumber) {
    EXPECT_EQ(number_of("1"), 1.0);
    EXPECT_EQ(number_of("-.3"), -0.3);
    EXPECT_EQ(number_of("5."), 5.0);
    EXPECT_EQ(number_of("+2.5"), 2.5);
    EXPECT_EQ(number_of("1e+05"), 1e5);
    EXPECT_EQ(number_of("2E-3"), 2e-3);
    EXPECT_EQ(number_of("9.9e-005"), 9.9e-5);
}

TEST(Lexer, TakesNumbersThatAreTooSmallForADoubleAsZero) {
    EXPECT_EQ(number_of("1e-999"), 0.0);
    EXPECT_EQ(number_of("0.001e-400"), 0.0);
    EXPECT_EQ(number_of("0e999"), 0.0);
}

TEST(Lexer, RefusesNumbersThatAreNotFiniteOrNotNumbers) {
    EXPECT_NE(first_error("1e999").find("f:1:1: error: number 1e999 is too large"),
              std::string::npos);
    EXPECT_NE(first_error("  1000e99999999999999999").find("f:1:3"), std::string::npos);
    EXPECT_NE(first_error("-inf").find("not a finite number"), std::string::npos);
    EXPECT_NE(first_error("-nan").find("not a finite number"), std::string::npos);
    EXPECT_NE(first_error("1-2").find("malformed number '1-2'"), std::string::npos);
    EXPECT_NE(first_error("0x10").find("malformed number"), std::string::npos);
    EXPECT_NE(first_error("1.2.3").find("malformed number"), std::string::npos);
    EXPECT_NE(first_error("-").find("malformed number"), std::string::npos);
    EXPECT_NE(first_error("+-1").find("malformed number"), std::string::npos);
    EXPECT_NE(first_error("1e").find("malformed number"), std::string::npos);
}

TEST(Lexer, PlacesTokensByLineAndColumn) {
    const SourceText source("a\n  bc // x\n/* y\n */ \"d e\"", "f");
    const Lexed lexed = lex(source);
    ASSERT_EQ(lexed.tokens.size(), 3u);
    EXPECT_EQ(source.location(lexed.tokens[0].offset), (FileLocation{"f", 1, 1}));
    EXPECT_EQ(source.location(lexed.tokens[1].offset), (FileLocation{"f", 2, 3}));
    EXPECT_EQ(source.location(lexed.tokens[2].offset), (FileLocation{"f", 4, 5}));
    EXPECT_EQ(lexed.tokens[2].text, "d e");
}

TEST(Lexer, CountsLinesWhateverEndsThem) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        const std::string text = "a" + end + end + " bc" + end + "d";
        const SourceText source(text, "f");
        const Lexed lexed = lex(source);
        ASSERT_EQ(lexed.tokens.size(), 3u);
        EXPECT_EQ(source.location(lexed.tokens[1].offset), (FileLocation{"f", 3, 2}));
        EXPECT_EQ(source.location(lexed.tokens[2].offset), (FileLocation{"f", 4, 1}));
    }
    const SourceText mixed("a\n\rb", "f");
    EXPECT_EQ(mixed.location(3), (FileLocation{"f", 3, 1}));
}

TEST(Lexer, ReportsAnUnterminatedCommentWhereItBegins) {
    EXPECT_EQ(first_error("a\n /* b").substr(0, 6), "f:2:2:");
    EXPECT_EQ(first_error("a /*/").substr(0, 6), "f:1:3:");
}

TEST(Lexer, ReportsAnUnterminatedStringAndGoesOnInTheNextLine) {
    const SourceText source("\"abc\ndef", "f");
    const Lexed lexed = lex(source);
    EXPECT_EQ(lexed.diagnostics.error_count(), 1u);
    ASSERT_EQ(lexed.tokens.size(), 2u);
    EXPECT_EQ(lexed.tokens[1].text, "def");
}

TEST(Lexer, ReportsARunOfRubbishOnce) {
    EXPECT_NE(first_error("a \x01\xff\x80 b").find("unexpected '\\x01\\xff\\x80'"),
              std::string::npos);
    EXPECT_NE(first_error("a / b").find("unexpected '/'"), std::string::npos);
}

TEST(Lexer, KeepsHyphensInsideWords) {
    const SourceText source("SBT-raytracer x_1", "f");
    const Lexed lexed = lex(source);
    ASSERT_EQ(lexed.tokens.size(), 2u);
    EXPECT_EQ(lexed.tokens[0].text, "SBT-raytracer");
}

// ---- syntax tree

std::vector<std::string> syntax_errors(const std::string& text) {
    const SourceText source(text, "f");
    Diagnostics diagnostics;
    const TextTree tree(source, {}, diagnostics);
    std::vector<std::string> messages;
    for (const Diagnostic& d : diagnostics.all()) messages.push_back(to_string(d));
    return messages;
}

TEST(TextTree, HoldsPairsEntriesListsAndBlocks) {
    const SourceText source("h 1 a { b = (1, 2); c = [x, \"y\", q(3)] } { d; } e \"n\" { }", "f");
    Diagnostics diagnostics;
    const TextTree tree(source, {}, diagnostics);
    EXPECT_EQ(diagnostics.error_count(), 0u);
    std::vector<TextNode> items;
    for (const TextNode item : tree.root()) items.push_back(item);
    ASSERT_EQ(items.size(), 4u);
    EXPECT_TRUE(items[0].is(NodeKind::Entry, "h"));
    EXPECT_EQ(items[0].first().number(), 1.0);
    const TextNode a = items[1].first();
    ASSERT_TRUE(a.is(NodeKind::Block));
    ASSERT_EQ(a.size(), 2u);
    EXPECT_TRUE(a.first().is(NodeKind::Pair, "b"));
    EXPECT_EQ(a.first().first().size(), 2u);
    EXPECT_TRUE(items[2].is(NodeKind::Block));
    EXPECT_EQ(items[3].size(), 2u);
}

TEST(TextTree, ReportsOneErrorForEachMistake) {
    EXPECT_EQ(syntax_errors("a { b = (1 2 3); c = 1 }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { b = ; c = 1 }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { b = (1, ; c = 1 }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { b = (1, 2]; c = 1 }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { b = (1, 2,); c = 1 }").size(), 1u);
    EXPECT_EQ(syntax_errors("t(1, 2, s { m = 1; ) b { }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { } } b { }").size(), 1u);
    EXPECT_EQ(syntax_errors("a { b = (1 ; } c { d = (2 3 ); }").size(), 2u);
    EXPECT_EQ(syntax_errors("a { , , b = 1 }").size(), 1u);
}

TEST(TextTree, ReportsATruncatedFileOnceWithThePlaceOfTheOpenBracket) {
    for (const char* text : {"a {", "a { b", "a { b = ", "a { b = (", "a { b = (1,", "a { b = (1",
                             "a { b = (c {", "a { b = (c {} "}) {
        const auto errors = syntax_errors(text);
        ASSERT_EQ(errors.size(), 1u) << text;
        EXPECT_NE(errors[0].find("the end of the file"), std::string::npos) << errors[0];
        EXPECT_NE(errors[0].find("opened in line 1, column "), std::string::npos) << errors[0];
    }
}

TEST(TextTree, RefusesDeepNestingWithOneError) {
    for (const char* open : {"(", "{", "a{", "a(", "[", "a=("}) {
        std::string text = "x = ";
        if (open[0] == '{' || open[0] == 'a') text.clear();
        for (int i = 0; i < 100'000; ++i) text += open;
        const auto errors = syntax_errors(text);
        ASSERT_GE(errors.size(), 1u) << open;
        EXPECT_LE(errors.size(), 1u) << open << ": " << errors.back();
    }
}

TEST(TextTree, StopsAtTheLimitOfValues) {
    const SourceText source("a = (1, 2, 3, 4, 5, 6, 7, 8)", "f");
    Diagnostics diagnostics;
    EXPECT_THROW(TextTree(source, {.max_nodes = 5}, diagnostics), Error);
}

TEST(TextTree, SurvivesRandomBytesAndRandomTokens) {
    const std::string pieces[] = {"a",     "name", "=",  "(",  ")",  "{", "}",
                                  "[",     "]",    ",",  ";",  "1",  "x", "\"",
                                  "\"s\"", "//",   "/*", "*/", "\n", "-", "\xff"};
    std::mt19937 random(457);
    for (int round = 0; round < 3000; ++round) {
        std::string text;
        const int length = static_cast<int>(random() % 60);
        for (int i = 0; i < length; ++i) {
            if (round % 3 == 0) {
                text += static_cast<char>(random() % 256);
            } else {
                text += pieces[random() % std::size(pieces)] + (random() % 2 ? " " : "");
            }
        }
        SCOPED_TRACE("round " + std::to_string(round) + ": " + text);
        const SourceText source(text, "f");
        Diagnostics diagnostics;
        const TextTree tree(source, {.max_nesting = 8}, diagnostics);
        // Every node must lie inside its parent, and the traversal must end.
        std::size_t nodes = 0;
        std::vector<TextNode> pending{tree.root()};
        while (!pending.empty()) {
            const TextNode node = pending.back();
            pending.pop_back();
            ++nodes;
            (void)node.describe();
            for (const TextNode child : node) pending.push_back(child);
        }
        ASSERT_LE(nodes, 2 * text.size() + 1);
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
