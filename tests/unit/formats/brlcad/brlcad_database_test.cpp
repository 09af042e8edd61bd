/// Parsing of the text of BRL-CAD databases, and its error messages.

#include <gtest/gtest.h>

#include <cmath>

#include "alhazen/formats/brlcad/brlcad_v4_reader.h"
#include "alhazen/formats/brlcad/brlcad_v5_reader.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::mentions;
using testing::text_of;

const std::string kOne = " 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 0\n";
const std::string kZeros = " 0 0 0 0 0 0 0 0 0 0 0 0";

template <class Reader>
BrlcadDatabase read(std::string_view text, Diagnostics& found, ImportOptions options = {}) {
    BrlcadDatabase database;
    database.file = "a.asc";
    const ImportSource source{text, "a.asc", options};
    Reader(source, database, found).read();
    return database;
}
BrlcadDatabase v4(const std::string& records, Diagnostics& found) {
    return read<BrlcadV4Reader>("I 1 v4\nTitle\n" + records, found);
}
BrlcadDatabase v5(const std::string& text, Diagnostics& found) {
    return read<BrlcadV5Reader>(text, found);
}

/// Prints a tree with brackets: -(a b) is a minus b.
std::string shown(const BrlcadTree& tree, std::uint32_t index) {
    if (index == BrlcadTree::kEmpty) return "nothing";
    const BrlcadNode& node = tree.node(index);
    if (node.op == BrlcadOperator::Leaf) return node.member;
    std::string text(1, ".u+-^"[static_cast<int>(node.op)]);
    for (std::size_t i = 0; i < node.operands.size(); ++i) {
        text += (i == 0 ? "(" : " ") + shown(tree, node.operands[i]);
    }
    return text + ")";
}
std::string tree_of(const BrlcadDatabase& database, const std::string& name) {
    const BrlcadObject* object = database.find(name);
    if (object == nullptr) return "missing";
    const BrlcadTree& tree = std::get<BrlcadCombination>(object->what).tree;
    return shown(tree, tree.root());
}
template <class Form>
Form solid(const BrlcadDatabase& database, const std::string& name) {
    return std::get<Form>(std::get<BrlcadSolid>(database.find(name)->what).form);
}

TEST(BrlcadV4, UnionBindsLeastAndTheOthersGoFromLeftToRight) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("C Y c 1 0 5 0 1 100 1 255 0 51 0 0 1\nM + a" + kOne + "M - b" + kOne + "M + c" + kOne +
               "M u d" + kOne + "M - e" + kOne + "C N empty -1 0 0\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(database.title, "Title");
    EXPECT_EQ(tree_of(database, "c"), "u(+(-(a b) c) -(d e))");
    EXPECT_EQ(tree_of(database, "empty"), "nothing");
    const auto& comb = std::get<BrlcadCombination>(database.find("c")->what);
    EXPECT_TRUE(comb.region);
    EXPECT_TRUE(comb.inherit);
    EXPECT_EQ(comb.region_id, 1);
    EXPECT_EQ(comb.color, (Rgb{1, 0, 0.2}));
}

TEST(BrlcadV4, ShadersStandOnLinesOfTheirOwnAndOldRecordsAreShort) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("C Y a 1 3 1 0 1 100 0 0 0 0 1 1 0\nmirror\nre=.5 sh=3\nM u s" + kOne +
               "C Y b 1 0 1 -31704 1 100 1 0 255 0 1\nplastic\nM u s" + kOne +
               "C N g 0 0 1 -5128 0 0 -1 127 63 124\nM u a" + kOne + "m 0 1 5 255 0 0\n",
           found);
    EXPECT_EQ(text_of(found), "");
    const auto comb = [&](const char* name) {
        return std::get<BrlcadCombination>(database.find(name)->what);
    };
    EXPECT_EQ(comb("a").shader, "mirror re=.5 sh=3");
    EXPECT_EQ(comb("a").air, 3);
    EXPECT_EQ(comb("b").shader, "plastic");
    EXPECT_EQ(comb("b").color, (Rgb{0, 1, 0}));
    EXPECT_FALSE(comb("g").color.has_value());
    ASSERT_EQ(database.region_colors.size(), 1u);
    EXPECT_EQ(database.region_colors[0].last, 5);
}

TEST(BrlcadV4, SolidsHaveTheirVectorsRelativeToTheFirst) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("S 20 box 1 1 2 3 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n"
           "S 16 ring 6 0 0 0 0 0 2 3 4 0" +
               kZeros + " 0 0 0\n" + "S 24 half 24 0 0 1 -100" + kZeros + " 0 0 0 0 0 0 0 0\n" +
               "S 99 strange 1" + kZeros + kZeros + "\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(solid<BrlcadArb8>(database, "box").corners[6], (Vec3{2, 3, 4}));
    EXPECT_EQ(solid<BrlcadTorus>(database, "ring").major, 5);
    EXPECT_EQ(solid<BrlcadTorus>(database, "ring").minor, 2);
    EXPECT_EQ(solid<BrlcadHalfSpace>(database, "half").distance, -100);
    (void)solid<BrlcadUnsupported>(database, "strange");
}

TEST(BrlcadV4, MatricesAreDividedByTheirLastNumber) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("C N c 0 0 1\nM u a 0 -1 0 6 1 0 0 0 0 0 1 2 0 0 0 0.5 0\n", found);
    EXPECT_EQ(text_of(found), "");
    const Affine m =
        std::get<BrlcadCombination>(database.find("c")->what).tree.node(0).comb_from_member;
    EXPECT_EQ(m.point({1, 0, 0}), (Vec3{12, 2, 4}));
}

TEST(BrlcadV4, RoundedMatricesAreDividedByTheirLastNumberAndToldOnce) {
    // As BRL-CAD's editor writes them.
    const std::string rounded = " 1 0 0 6 0 1 0 0 0 0 1 4 9e-10 0 0 .9999996 0\n";
    Diagnostics found;
    const BrlcadDatabase database =
        v4("C N c 0 0 3\nM u a" + rounded + "M u b" + rounded + "M u d" + kOne, found);
    EXPECT_EQ(text_of(found),
              "a.asc:4:1: warning: the last row of the matrix of member 'a' is rounded; it and "
              "others are taken as 0 0 0 1 after division by the last number\n");
    const BrlcadTree& tree = std::get<BrlcadCombination>(database.find("c")->what).tree;
    EXPECT_EQ(tree.node(1).comb_from_member.point({1, 0, 0}),
              (Vec3{1 / .9999996 + 6 * (1 / .9999996), 0, 4 * (1 / .9999996)}));
}

TEST(BrlcadV4, WhetherAMatrixIsRoundedIsRelativeToItsLastNumber) {
    const auto last_row = [](double a, double b, double c, double w) {
        return HomogeneousMatrix({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, a, b, c, w}).last_row;
    };
    EXPECT_EQ(last_row(0, 0, 0, 1e-9), LastRow::Exact);
    EXPECT_EQ(last_row(0, -9e-6, 0, 1), LastRow::Rounded);
    EXPECT_EQ(last_row(0, 0, 2e-5, -4), LastRow::Rounded);
    EXPECT_EQ(last_row(0, 0, 2e-5, 1), LastRow::Perspective);
    EXPECT_EQ(last_row(9e-10, 0, 0, 1e-9), LastRow::Perspective);
    EXPECT_EQ(last_row(0, 0, 0, 0), LastRow::Perspective);
    EXPECT_EQ(last_row(std::nan(""), 0, 0, 1), LastRow::Perspective);
    EXPECT_EQ(last_row(0, 0, 0, std::nan("")), LastRow::Perspective);
}

TEST(BrlcadV4, FaultsAreToldWithTheirLineAndReadingGoesOn) {
    const auto message = [](const std::string& record) {
        Diagnostics found;
        const BrlcadDatabase database =
            v4(record + "\nS 19 last 1 0 0 0 1 0 0 0 1 0 0 0 1" + kZeros + "\n", found);
        EXPECT_NE(database.find("last"), nullptr) << record;
        EXPECT_EQ(found.error_count(), 0u) << record;
        EXPECT_EQ(database.faults, found.warning_count()) << record;
        return text_of(found);
    };
    const auto has = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    has(message("S 19 a 1 0 0 0"), "a.asc:3:15: warning: expected 24 numbers, found the end");
    has(message("S 19 a 1 0 0 nan"), "expected 24 numbers, found 'nan'");
    has(message("S 19 a 1 0 0 1e999"), "found '1e999'");
    has(message("M u a 1 0"), "without a combination");
    has(message("C Y c 0 0 1\nM x a" + kOne), "'x' is not an operator");
    has(message("C Y c 0 0 1\nM u a 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 0 0"), "not an affine transform");
    has(message("C Y c 0 0 1\nM u a 1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 1 0"), "not an affine transform");
    has(message("C Q c 0 0 1"), "a combination is Y");
    has(message("? what"), "'?' is not a record type");
    has(message("t b 2 1 0 1 1\n0: 0 0 0\n0: 0 0 7"), "from 0 to 0, found '7'");
    has(message("t b 2 1 0 99999999999 1"), "expected a whole number from 0");
    has(message("A 21 a 3 9 1 3 0 0 0 0 0 0"), "need 2 records each");
    has(message("n a 3\nn 1 0 0 1"), "expected plane 2 of 3");
}

TEST(BrlcadV4, ASolidThatCannotBeReadIsThereAsOneThatIsNotSupported) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("t b 2 1 0 2 1\n0: 0 0 0\n1: 1 0 x\n0: 0 0 1\nS 19 last 1 0 0 0 1 0 0 0 1 0 0 0 1" +
               kZeros + "\n",
           found);
    EXPECT_EQ(solid<BrlcadUnsupported>(database, "b").reason, "could not be read");
    EXPECT_NE(database.find("last"), nullptr);
    // The rest of its record is no second fault.
    EXPECT_EQ(text_of(found), "a.asc:5:8: warning: expected 3 numbers, found 'x' as number 3\n");
}

TEST(BrlcadV4, SolidsOfUnsupportedTypesAreKnownByName) {
    Diagnostics found;
    const BrlcadDatabase database =
        v4("# a comment\nd sk 0 0 0 1 0 0 0 1 0 4 2\n -1 -1 1 -1 1 1 -1 1\n L 0 0 1\n L 0 1 2\n"
           "e ex sk 0 0 0 -9 0 0 18 1 0 0 0 1 0\nb spl 2\nD 2 2 2 2 1 1 3 1 1\n0\n1\n0\n1\n-1\n-1\n"
           "0\nD 2 2 2 2 1 1 3 1 1\n0\n1\n0\n1\n1\n1\n0\nS 19 last 1 0 0 0 1 0 0 0 1 0 0 0 1" +
               kZeros + "\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(database.objects.size(), 4u);
    for (const char* name : {"sk", "ex", "spl"}) (void)solid<BrlcadUnsupported>(database, name);
    EXPECT_NE(database.find("last"), nullptr);
}

TEST(BrlcadV4, OnlyPlatesOfMode3HaveThicknessesInTheFile) {
    Diagnostics found;
    const std::string rest = "0: 0 0 0\n1: 1 0 0\n2: 0 1 0\n";
    const BrlcadDatabase database = v4(
        "t a 3 2 0 3 1\n" + rest + "0: 0 1 2 0.5\n 80\n" + "t b 4 2 0 3 1\n" + rest + "0: 0 1 2\n",
        found);
    EXPECT_EQ(text_of(found), "");
    for (const char* name : {"a", "b"}) {
        const BrlcadMesh bot = solid<BrlcadMesh>(database, name);
        EXPECT_TRUE(bot.plate) << name;
        EXPECT_EQ(bot.mesh->triangles.size(), 1u) << name;
    }
}

TEST(BrlcadV4, RadiiOfAHornTorusMayDifferByTheRoundingOfFloat) {
    const auto minor = [](const char* radius) {
        Diagnostics found;
        const BrlcadDatabase database =
            v4("S 16 a 6 0 0 0 0 0 " + std::string(radius) + " 5 0 0 0 5 0" + kZeros + "\n", found);
        EXPECT_EQ(text_of(found), "");
        return solid<BrlcadTorus>(database, "a").minor;
    };
    EXPECT_EQ(minor("5.0000005"), 5);
    EXPECT_EQ(minor("5.001"), 5.001);
    EXPECT_EQ(minor("4.9999995"), 4.9999995);
}

TEST(BrlcadV4, OfTheSameNameTwiceTheFirstIsKept) {
    Diagnostics found;
    (void)v4("C N a 0 0 0\nC N a 0 0 0\n", found);
    EXPECT_TRUE(
        mentions(found, "a.asc:4:1: warning: 'a' is defined again; the object of line 3 is kept"));
}

TEST(BrlcadV4, WhatEndsTooSoonIsAnError) {
    for (const char* record :
         {"N 1 a 1000000000\n", "w a\n1 1 1 1 1 1\n", "t b 2 1 0 9 9\n0: 0 0 0\n"}) {
        Diagnostics found;
        (void)v4(record, found);
        EXPECT_EQ(found.error_count(), 1u) << record << text_of(found);
    }
}

TEST(BrlcadV4, NoMoreIsReadThanIsAllowed) {
    ImportOptions options;
    options.max_elements = 5;
    Diagnostics found;
    std::string text = "I 1 v4\nt\nC N c 0 0 9\n";
    for (int i = 0; i < 9; ++i) text += "M u a" + kOne;
    EXPECT_THROW((void)read<BrlcadV4Reader>(text, found, options), Error);
}

TEST(BrlcadV5, TreesOfAnyDepthAreReadAndTheirChainsAreFlat) {
    Diagnostics found;
    std::string chain = "{l m0}";
    for (int i = 1; i < 4000; ++i) chain = "{u " + chain + " {l m" + std::to_string(i) + "}}";
    const BrlcadDatabase database =
        v5("put {long} comb region no tree " + chain +
               "\nput c comb tree {- {- {u {l a} {l {b c}}} {l d}} {^ {l e} {n {l f} {l g}}}}\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(tree_of(database, "c"), "-(u(a b c) d ^(e +(f g)))");
    const BrlcadTree& tree = std::get<BrlcadCombination>(database.find("long")->what).tree;
    EXPECT_EQ(tree.node(tree.root()).operands.size(), 4000u);
}

TEST(BrlcadV5, AttributesOverrideWhatPutSays) {
    Diagnostics found;
    const BrlcadDatabase database =
        v5("title {A {nested} title}\nunits mm\n# a comment\n"
           "attr set {_GLOBAL} {regionid_colortable} {{1 2 255 0 0} {3 4 0 255 0}}\n"
           "put {a} comb region no rgb {255 0 0} tree {l s {1 0 0 4  0 1 0 5  0 0 1 6  0 0 0 2}}\n"
           "attr set {a} {region} {R} {region_id} {7} {rgb} {0/255/0} \\\n {oshader} {plastic} "
           "{inherit} 1 {comment} {free}\ncolor 5 6 0 0 255\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(database.title, "A {nested} title");
    const auto& comb = std::get<BrlcadCombination>(database.find("a")->what);
    EXPECT_TRUE(comb.region && comb.inherit);
    EXPECT_EQ(comb.region_id, 7);
    EXPECT_EQ(comb.color, (Rgb{0, 1, 0}));
    EXPECT_EQ(comb.shader, "plastic");
    EXPECT_EQ(comb.tree.node(0).comb_from_member.point({0, 2, 0}), (Vec3{2, 3.5, 3}));
    EXPECT_EQ(database.region_colors.size(), 3u);
}

TEST(BrlcadV5, EverySolidHasItsParameters) {
    Diagnostics found;
    const BrlcadDatabase database =
        v5("put box arb8 V1 {0 0 0} V2 {1 0 0} V3 {1 1 0} V4 {0 1 0} V5 {0 0 1} V6 {1 0 1} V7 {1 1 "
           "1} V8 {0 1 1}\n"
           "put e ehy V {0 0 0} H {0 0 2} A {0 1 0} r_1 3 r_2 4 c 5\n"
           "put b bot mode surf orient lh V { { 0 0 0 } { 1 0 0 } {0 1 0} } F { {0 1 2} }\n"
           "put a ars NC 2 PPC 3 C0 { {0 0 0} {0 0 0} {0 0 0} } C1 { {1 0 0} {0 1 0} {0 0 1} }\n"
           "put n arbn N 1 P0 {0 0 1 5}\nput d dsp src f file {a b.dsp} w 3 n 3\n",
           found);
    EXPECT_EQ(text_of(found), "");
    EXPECT_EQ(solid<BrlcadArb8>(database, "box").corners[6], (Vec3{1, 1, 1}));
    EXPECT_EQ(solid<BrlcadConicDome>(database, "e").apex_distance, 5);
    const BrlcadMesh bot = solid<BrlcadMesh>(database, "b");
    EXPECT_FALSE(bot.solid);
    EXPECT_EQ(bot.mesh->triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
    EXPECT_EQ(solid<BrlcadMesh>(database, "a").mesh->triangles.size(), 3u);
    EXPECT_EQ(solid<BrlcadPolyhedron>(database, "n").planes.size(), 1u);
    EXPECT_EQ(std::get<BrlcadSolid>(database.find("d")->what).type, "dsp");
}

TEST(BrlcadV5, FaultsAreToldAndReadingGoesOnWhereItCan) {
    const auto message = [](const std::string& command, bool goes_on) {
        Diagnostics found;
        const BrlcadDatabase database = v5(command + "\nput last half N {0 0 1} d 0\n", found);
        EXPECT_EQ(database.find("last") != nullptr, goes_on) << command;
        EXPECT_EQ(found.all().size(), 1u) << command << text_of(found);
        EXPECT_EQ(found.error_count(), goes_on ? 0u : 1u) << command << text_of(found);
        return text_of(found);
    };
    const auto has = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    has(message("put a ell V {0 0} A {1 0 0} B {0 1 0} C {0 0 1}", true),
        "expected 3 numbers of V");
    has(message("put a ell V {0 0 nan} A {1 0 0}", true), "a.asc:1:");
    has(message("put a ell V {0 0 0}", true), "expected a parameter A");
    has(message("put a comb tree {l}", true), "expected the name of a member");
    has(message("put a comb tree {u {l a}}", true), "two operands, not 1");
    has(message("put a comb tree {x {l a} {l b}}", true), "expected an operator");
    has(message("put a comb tree {! {l a}}", true), "operator ! (not)");
    has(message("put a comb tree {l a {1 0 0}}", true), "sixteen numbers");
    has(message("put a comb tree {u {l a} {l b}} {l c}", true), "expected a value");
    has(message("exec rm", true), "'exec' is not a command");
    has(message("put a", true), "expected put NAME TYPE");
    has(message("put b bot mode volume V {{0 0 0}} F {{0 0 1}}", true),
        "has an invalid vertex number");
    has(message("put b bot mode volume V {{0 0 0}} F {{0 0 -1}}", true), "invalid vertex number");
    has(message("put b ars NC 1e9 PPC 1e9", true), "whole number from");
    has(message("put a comb tree {u {l a}", false),
        "a.asc:1:17: error: this brace is never closed");
    has(message("title \"open", false), "never closed");
    has(message("put $a half", false), "variables");
    has(message("put {a}b half", false), "expected a blank");
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
