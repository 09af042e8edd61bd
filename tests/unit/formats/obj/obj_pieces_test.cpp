#include "alhazen/formats/obj/obj_pieces.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "alhazen/formats/obj/obj_statements.h"
#include "alhazen/parallel/parallel.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::text_of;

/// Some kinds of lines each for a while, so that pieces of one kind are among those of several.
/// `plain`: as they are; else with comments behind them, which are not read as plain lines.
std::string lines_of_kind(int kinds, int count, bool plain) {
    std::mt19937 random(5);
    const std::string end = plain ? "\n" : " # x\n";
    std::string text;
    int positions = 0, kind = 0;
    for (int i = 0; i < count; ++i) {
        if (i % 5000 == 0) kind = int(random() % unsigned(kinds));
        const auto number = [&] { return std::to_string(int(random() % 20001) - 10000) + ".25"; };
        const auto index = [&] { return std::to_string(1 + random() % unsigned(positions + 9)); };
        const std::size_t line = random() % 40;
        if (line == 0) {
            text += "# a comment \\\n";
        } else if (line == 1) {
            text += "\r\n";
        } else if (kind == 0 || i < 10) {
            text += "v " + number() + "\t" + number() + " " + number() + end;
            ++positions;
        } else if (kind == 1) {
            text += "f " + index() + " " + index() + "  " + index() + end;
        } else if (kind == 2) {
            text += "f " + index() + " \\\n " + index() + " " + index() + end;
        } else if (line < 10) {
            text += "v " + number() + " " + number() + " " + number() + " 1 0.5 0.25" + end;
            ++positions;
        } else if (line < 20) {
            text += "vt 0 1\nf 1/1 2/1 3/1" + end;
        } else if (line < 30) {
            text += "f -1 -2 -3 -4" + end + "o " + std::to_string(random() % 3) + "\n";
        } else {
            text += "f 1 2 3" + end + "v 1 2 3" + end;
            ++positions;
        }
    }
    return text;
}

struct Read {
    ObjStatements statements;
    std::string found;
};

Read read(const std::string& text, int threads, const ImportOptions& options = {}) {
    Read result;
    Diagnostics found;
    ThreadLimit(threads).run(
        [&] { result.statements = read_obj_statements(text, "a.obj", options, found); });
    result.found = text_of(found);
    return result;
}

void expect_same(const ObjStatements& a, const ObjStatements& b) {
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_EQ(a.weights, b.weights);
    EXPECT_EQ(a.uvs.size(), b.uvs.size());
    EXPECT_EQ(a.names, b.names);
    EXPECT_TRUE(a.corners.position == b.corners.position);
    EXPECT_TRUE(a.corners.uv == b.corners.uv);
    EXPECT_TRUE(a.corners.normal == b.corners.normal);
    ASSERT_EQ(a.colors.size(), b.colors.size());
    for (std::size_t i = 0; i < a.colors.size(); ++i) {
        ASSERT_TRUE(a.colors[i].r == b.colors[i].r && a.colors[i].b == b.colors[i].b) << i;
    }
    ASSERT_EQ(a.faces.size(), b.faces.size());
    for (std::size_t i = 0; i < a.faces.size(); ++i) {
        ASSERT_EQ(a.faces[i].end, b.faces[i].end) << i;
        ASSERT_EQ(a.faces[i].line, b.faces[i].line) << i;
    }
    ASSERT_EQ(a.runs.size(), b.runs.size());
    for (std::size_t i = 0; i < a.runs.size(); ++i) {
        ASSERT_EQ(a.runs[i].first_face, b.runs[i].first_face) << i;
        ASSERT_EQ(a.runs[i].name, b.runs[i].name) << i;
    }
}

TEST(ObjPieces, PlainLinesAreReadAsAnyOther) {
    for (const int kinds : {1, 2, 3, 4}) {
        const std::string plain = lines_of_kind(kinds, 60'000, true);
        const Read any = read(lines_of_kind(kinds, 60'000, false), 1);
        ASSERT_GT(obj_pieces(plain).size(), 6u);
        EXPECT_EQ(any.found, "") << kinds;
        for (const int threads : {1, 2, 5}) {
            const Read all = read(plain, threads);
            EXPECT_EQ(all.found, "") << kinds;
            expect_same(all.statements, any.statements);
        }
    }
}

TEST(ObjPieces, FindingsHaveTheirLine) {
    for (const char* wrong :
         {"v 1 2\n", "v 1 2 x\n", "f 1 2 0\n", "f 1 2\n", "f 1 99999999999 3\n", "unknown 1\n"}) {
        for (const int kinds : {1, 2}) {
            const std::string lines = lines_of_kind(kinds, 30'000, true);
            const std::string others = lines_of_kind(kinds, 30'000, false);
            const Read plain = read(lines + wrong + lines, 2);
            EXPECT_NE(plain.found, "") << wrong;
            EXPECT_EQ(plain.found, read(others + wrong + others, 1).found) << wrong;
        }
    }
}

TEST(ObjPieces, TheLimitOfElementsIsThatOfAnyOtherLine) {
    const auto line_of_error = [](const std::string& text) {
        ImportOptions options;
        options.max_elements = 20'000;
        try {
            (void)read(text, 2, options);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Resource);
            return error.location().line;
        }
        return 0;
    };
    for (const int kinds : {1, 2}) {
        const int line = line_of_error(lines_of_kind(kinds, 60'000, true));
        EXPECT_GT(line, 1000);
        EXPECT_EQ(line, line_of_error(lines_of_kind(kinds, 60'000, false)));
    }
}

TEST(ObjPieces, PiecesEndWhereLinesAreNotContinued) {
    for (const auto& [blanks, end] : {std::pair<std::string, std::string>{"", "\n"},
                                      {"", "\r\n"},
                                      {"  \t", "\n"},
                                      {" ", "\r\n"}}) {
        const std::string next = "\\" + blanks + end;
        std::string text;
        while (text.size() < 1'000'000) text += "f 1 " + next + "2 " + next + "3" + end;
        std::size_t bytes = 0;
        const std::vector<std::string_view> pieces = obj_pieces(text);
        EXPECT_GT(pieces.size(), 5u);
        for (const std::string_view piece : pieces) {
            EXPECT_EQ(piece.data(), text.data() + bytes);
            bytes += piece.size();
            EXPECT_TRUE(piece.ends_with("3" + end));
            const PlainObjLines lines = read_plain_obj_lines(piece);
            EXPECT_EQ(lines.face_lines.size() * 3, lines.corners.size());
            EXPECT_EQ(std::size_t(lines.lines), lines.corners.size());
        }
        EXPECT_EQ(bytes, text.size());
    }
}

TEST(ObjPieces, OtherLinesAreNotPlain) {
    for (const char* line : {"v 1 2\n", "v 1 2 3 4\n", "v 1 2 3 # c\n", "v 1 2 3", "f 1 2 3 4\n",
                             "f -1 -2 -3\n", "f 1/1 2 3\n", "f 0 1 2\n", "vt 0 0\n", "o a\n"}) {
        EXPECT_EQ(read_plain_obj_lines(line).lines, 0) << line;
    }
    EXPECT_EQ(read_plain_obj_lines("# c\n\n v 1 2 3\n\tf 1 1 1\r\n").lines, 4);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
