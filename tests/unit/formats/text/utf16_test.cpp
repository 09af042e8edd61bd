/// Every reader of a text format says of UTF-16 and UTF-32 text what it is.

#include <gtest/gtest.h>

#include "alhazen/shading/lights/ies_profile.h"
#include "unit/formats/import_text.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::TemporaryFolder;

/// ASCII as UTF-16 with its mark.
std::string utf16(std::string_view text, bool big_endian = false) {
    std::string bytes = big_endian ? "\xFE\xFF" : "\xFF\xFE";
    for (const char c : text) {
        bytes += big_endian ? '\0' : c;
        bytes += big_endian ? c : '\0';
    }
    return bytes;
}

/// ASCII in units of `width` bytes, without a mark.
std::string wide(std::string_view text, std::size_t width, bool big_endian) {
    std::string bytes;
    for (const char c : text) {
        const std::string zeros(width - 1, '\0');
        bytes += big_endian ? zeros + c : c + zeros;
    }
    return bytes;
}

/// The findings of importing a file, or its error.
std::string findings_of(const std::filesystem::path& path, const ImportOptions& options = {}) {
    Diagnostics found;
    try {
        (void)import_scene(path, options, found);
    } catch (const Error& error) {
        return error.what();
    }
    return testing::text_of(found);
}

constexpr std::string_view kFound = "the file is UTF-16 text; expected ASCII or UTF-8";

TEST(Utf16, IsToldOfInScenesOfEveryTextFormat) {
    const TemporaryFolder folder;
    for (const char* suffix : {"alhazen", "ray", "nff", "aff", "gltf", "obj", "ply", "stl", "asc",
                               "bpt", "rib", "txt"}) {
        for (const bool big_endian : {false, true}) {
            const auto path =
                folder.write(std::string("a.") + suffix, utf16("ply\nformat ascii", big_endian));
            const std::string said = findings_of(path);
            EXPECT_TRUE(said.starts_with(path.string() + ":1:1: ")) << said;
            EXPECT_TRUE(said.ends_with(kFound)) << said;
        }
    }
}

TEST(Utf16, IsToldOfWithoutAMarkAndAsUtf32) {
    using namespace std::string_view_literals;
    const TemporaryFolder folder;
    for (const char* suffix : {"alhazen", "ray", "nff", "aff", "gltf", "obj", "ply", "stl", "asc",
                               "bpt", "rib", "txt"}) {
        for (const bool big_endian : {false, true}) {
            for (const std::size_t width : {2, 4}) {
                for (const bool marked : {false, true}) {
                    if (marked && width == 2) continue;
                    const std::string_view mark = !marked      ? ""sv
                                                  : big_endian ? "\0\0\xFE\xFF"sv
                                                               : "\xFF\xFE\0\0"sv;
                    const auto path = folder.write(
                        std::string("a.") + suffix,
                        std::string(mark) + wide("ply\nformat ascii", width, big_endian));
                    const std::string said = findings_of(path);
                    EXPECT_TRUE(said.starts_with(path.string() + ":1:1: ")) << said;
                    EXPECT_TRUE(said.ends_with(
                        width == 2 ? "the file is UTF-16 text; expected ASCII or UTF-8"
                                   : "the file is UTF-32 text; expected ASCII or UTF-8"))
                        << said;
                }
            }
        }
    }
}

TEST(Utf16, IsToldOfInFilesThatScenesName) {
    const TemporaryFolder folder;
    const std::string text = utf16("newmtl a\n");
    for (const char* name : {"a.mtl", "a.bpt", "a.xyz", "a.ies", "view.txt"}) {
        (void)folder.write(name, text);
    }
    const auto scene = [&](const char* name, const std::string& bytes) {
        return findings_of(folder.write(name, bytes));
    };
    const std::string obj = scene("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_NE(obj.find("warning: the material file cannot be read: "), std::string::npos) << obj;
    EXPECT_NE(obj.find("a.mtl:1:1: " + std::string(kFound)), std::string::npos) << obj;
    for (const char* item : {"patch_mesh { file = \"a.bpt\"; }", "mesh { file = \"a.xyz\"; }",
                             "point_light { position = (0, 0, 2); profile = \"a.ies\"; }"}) {
        const std::string said = scene("a.alhazen", std::string("alhazen 1\nsphere {}\n") + item);
        EXPECT_NE(said.find(kFound), std::string::npos) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
    const auto database =
        folder.write("b.asc",
                     "title {a}\nunits mm\nput b.s ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\n"
                     "put b.r comb region yes tree {l b.s}\n");
    EXPECT_EQ(findings_of(database), "");
    const auto script = folder.path() / "view.txt";
    EXPECT_EQ(findings_of(database, {.view_script = script}),
              script.string() + ":1:1: " + std::string(kFound));
}

TEST(Utf16, TheMarkOfUtf8IsNoPartOfScriptsAndProfiles) {
    const std::string mark = "\xEF\xBB\xBF";
    const TemporaryFolder folder;
    const auto database =
        folder.write("b.asc",
                     "title {a}\nunits mm\nput b.s ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\n"
                     "put b.r comb region yes tree {l b.s}\n");
    const std::string view = "viewsize 1; eye_pt 0 3 4; lookat_pt 0 0 0; start 0; end;";
    const auto eye = [&](const std::string& text) {
        Diagnostics found;
        const SceneDescription scene =
            import_scene(database, {.view_script = folder.write("view.rt", text)}, found);
        EXPECT_EQ(testing::text_of(found), "");
        return std::get<OrthographicCamera>(scene.cameras.at(0).camera).up;
    };
    EXPECT_EQ(eye(mark + view), eye(view));
    // The factor 0.25 counts in files of before 1995, which have no such first line.
    const std::string ies =
        "IESNA:LM-63-1995\n[TEST] x\nTILT=NONE\n1 1 1 2 1 1 2 0 0 0\n0.5 0.25 100\n0 90\n0\n80 "
        "80\n";
    EXPECT_EQ(IesProfile(mark + ies, "a.ies").candela(0, 0), 40.0);
}

/// A requirement of YAML 1.1 (5.2).
TEST(Utf16, IsReadInYaml) {
    const TemporaryFolder folder;
    const std::string text =
        "Materials:\n    A: {Shader: Blinn-Phong Shader}\nRoot:\n    Name: Root\n    Components: "
        "{Transform: {}}\n    Children:\n    -   Name: Ball\n        Components:\n"
        "            Sphere: {Material: A}\n            Transform: {}\n";
    const std::string plain = findings_of(folder.write("a.yaml", text));
    for (const bool big_endian : {false, true}) {
        EXPECT_EQ(findings_of(folder.write("a.yaml", utf16(text, big_endian))), plain);
    }
    Diagnostics found;
    EXPECT_EQ(import_scene(folder.path() / "a.yaml", {}, found).objects.front().parts.size(),
              import_scene(folder.write("b.yaml", text), {}, found).objects.front().parts.size());
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
