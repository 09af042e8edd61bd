/// Files that scenes of the native format name: meshes and includes.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "native_scene.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using testing::import_native;
using testing::import_native_file;
using testing::Imported;
using testing::material_of;

/// A folder of files that is removed at the end of a test.
class Folder {
  public:
    Folder() {
        const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        path_ = std::filesystem::temp_directory_path() /
                ("alhazen_native_" + test +
                 std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this)));
        std::filesystem::create_directories(path_);
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    std::filesystem::path write(const std::string& name, const std::string& text) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name) << text;
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

TEST(NativeImporter, ReadsMeshFilesAndReportsMissingOnes) {
    const Folder folder;
    folder.write("m/tri.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const Imported good =
        import_native_file(folder.write("a.alhazen", "alhazen 1 mesh { file = \"m/tri.obj\" }"));
    EXPECT_EQ(good.messages(), "");
    EXPECT_EQ(good.scene.meshes.at(0).mesh->triangles.size(), 1u);
    const Imported bad = import_native_file(
        folder.write("b.alhazen", "alhazen 1\nmesh {\n file = \"m/none.obj\"; material = \"x\" }"));
    EXPECT_EQ(bad.errors(), 2u) << bad.messages();
    EXPECT_TRUE(bad.says("b.alhazen:3:9: error: ")) << bad.messages();
    EXPECT_EQ(import_native("mesh { file = \"../x.obj\" }").errors(), 1u);
    EXPECT_EQ(import_native("mesh { file = \"/x.obj\" }").errors(), 1u);
    EXPECT_EQ(import_native("texture \"t\" { file = \"none.png\" }").errors(), 1u);
    EXPECT_EQ(import_native("texture \"t\" { }").errors(), 1u);
}

TEST(NativeImporter, ReadsPatchFiles) {
    const Folder folder;
    const std::string flat = "1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n";
    folder.write("flat.bpt", "1\n" + flat);
    folder.write("two.bpt", "2\n" + flat + "2 1\n0 0 0\n0 1 0\n1 0 1\n1 1 1\n2 0 0\n2 1 0\n");
    const Imported good = import_native_file(
        folder.write("a.alhazen", "alhazen 1 patch_mesh { file = \"flat.bpt\" }"));
    EXPECT_EQ(good.messages(), "");
    const auto* shape = std::get_if<AnyShape>(&good.parts().at(0).what);
    ASSERT_NE(shape, nullptr);
    const auto* mesh = std::get_if<PatchMesh>(shape);
    ASSERT_NE(mesh, nullptr);
    EXPECT_EQ(mesh->degree_u, 1u);
    EXPECT_EQ(mesh->points.size(), 4u);
    const auto error_of = [&](const std::string& block) {
        return import_native_file(folder.write("b.alhazen", "alhazen 1\n" + block)).messages();
    };
    EXPECT_NE(error_of("patch_mesh { file = \"two.bpt\" }").find("2 pairs of degrees"),
              std::string::npos);
    EXPECT_NE(error_of("patch_mesh { file = \"flat.bpt\"; degree_u = 3 }").find("not both"),
              std::string::npos);
    EXPECT_NE(error_of("patch_mesh { file = \"none.bpt\" }").find("none.bpt"), std::string::npos);
    EXPECT_NE(error_of("patch_mesh { file = \"../flat.bpt\" }").find("error"), std::string::npos);
}

TEST(NativeImporter, AByteOrderMarkIsNoPartOfAFile) {
    const Folder folder;
    folder.write("i.alhazen",
                 "\xEF\xBB\xBF"
                 "alhazen 1\nsphere {}\n");
    folder.write("p.bpt",
                 "\xEF\xBB\xBF"
                 "1\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n");
    const Imported read = import_native_file(folder.write(
        "a.alhazen", "alhazen 1 include \"i.alhazen\"; patch_mesh { file = \"p.bpt\" }"));
    EXPECT_EQ(read.messages(), "");
    EXPECT_EQ(read.parts().size(), 2u);
}

TEST(NativeImporter, Utf16TextIsToldOf) {
    const Folder folder;
    const std::string text(
        "\xFF\xFE"
        "a\0l\0",
        6);
    EXPECT_EQ(import_native_file(folder.write("u.alhazen", text)).messages(),
              (folder.write("u.alhazen", text).string() +
               ":1:1: error: the file is UTF-16 text; expected ASCII or UTF-8\n"));
    const Imported outer =
        import_native_file(folder.write("a.alhazen", "alhazen 1 include \"u.alhazen\";"));
    EXPECT_EQ(outer.errors(), 1u);
    EXPECT_TRUE(outer.says("u.alhazen:1:1: error: the file is UTF-16 text")) << outer.messages();
}

TEST(NativeImporter, AFailedPatchFileIsOneError) {
    const Folder folder;
    folder.write("bad.bpt", "1\n1 1\n0 0 0\n0 x 0\n1 0 0\n1 1 0\n");
    for (const char* file : {"bad.bpt", "none.bpt", "../a.bpt"}) {
        Imported read = import_native_file(folder.write(
            "a.alhazen",
            "alhazen 1 sphere {} patch_mesh { file = \"" + std::string(file) + "\" }"));
        validate(read.scene, read.diagnostics);
        EXPECT_EQ(read.errors(), 1u) << read.messages();
    }
}

TEST(NativeImporter, IncludesFilesRelativeToTheIncludingOne) {
    const Folder folder;
    folder.write("parts/inner.alhazen", "alhazen 1 material \"m\" { diffuse = .3 } sphere { }");
    folder.write("parts/outer.alhazen",
                 "alhazen 1 include \"inner.alhazen\"; defaults { material = \"m\" }");
    const Imported i = import_native_file(
        folder.write("scene.alhazen", "alhazen 1 include \"parts/outer.alhazen\"\nbox { }"));
    EXPECT_EQ(i.messages(), "");
    ASSERT_EQ(i.parts().size(), 2u);
    EXPECT_EQ(material_of(i, 1).diffuse.color, (Rgb{.3, .3, .3}));
    EXPECT_EQ(i.parts()[0].location.file,
              (std::filesystem::path(i.scene.path).parent_path() / "parts/inner.alhazen").string());
}

TEST(NativeImporter, RefusesIncludesThatAreMissingOutsideOrCircular) {
    const Folder folder;
    folder.write("b.alhazen", "alhazen 1\n include \"a.alhazen\"");
    const Imported circle =
        import_native_file(folder.write("a.alhazen", "alhazen 1 include \"b.alhazen\" sphere { }"));
    EXPECT_EQ(circle.errors(), 1u);
    EXPECT_TRUE(circle.says("b.alhazen:2:10: error: include: the file includes itself"))
        << circle.messages();
    EXPECT_EQ(circle.parts().size(), 1u);
    EXPECT_EQ(import_native("include \"none.alhazen\"").errors(), 1u);
    EXPECT_EQ(import_native("include \"../x.alhazen\"").errors(), 1u);
    EXPECT_EQ(import_native("include \"/etc/passwd\"").errors(), 1u);
    const Imported bare = import_native("include x");
    EXPECT_EQ(bare.errors(), 1u);
    EXPECT_TRUE(bare.says("names are in quotes: include \"x\"")) << bare.messages();
    EXPECT_EQ(import_native("include \"x\" { }").errors(), 1u);
    folder.write("plain.txt", "hello");
    const Imported plain =
        import_native_file(folder.write("c.alhazen", "alhazen 1 include \"plain.txt\""));
    EXPECT_TRUE(plain.says("expected the header 'alhazen 1'")) << plain.messages();
}

TEST(NativeImporter, BoundsTheDepthCountAndSizeOfIncludedFiles) {
    const Folder folder;
    for (int k = 0; k < 15; ++k) {
        const std::string next = "include \"f" + std::to_string(k + 1) + ".alhazen\"\n";
        folder.write("f" + std::to_string(k) + ".alhazen", "alhazen 1\n" + next + next);
    }
    folder.write("f15.alhazen", "alhazen 1");
    const auto kind_of = [&](const ImportOptions& options) {
        try {
            (void)import_native_file(folder.write("s.alhazen", "alhazen 1 include \"f0.alhazen\""),
                                     options);
        } catch (const Error& error) {
            return error.kind();
        }
        return ErrorKind::Render;
    };
    EXPECT_EQ(kind_of({.max_include_depth = 30}), ErrorKind::Resource);  // 2^15 files
    EXPECT_EQ(kind_of({.max_include_depth = 5}), ErrorKind::Resource);
    EXPECT_EQ(kind_of({.max_include_depth = 30, .max_included_bytes = 100}), ErrorKind::Resource);
}

TEST(NativeImporter, CountsNestingThroughIncludedFiles) {
    const Folder folder;
    std::string groups = "alhazen 1\n";
    for (int k = 0; k < 150; ++k) groups += "group {";
    std::string closers(150, '}');
    folder.write("b.alhazen", groups + "sphere { }" + closers);
    const Imported i =
        import_native_file(folder.write("a.alhazen", groups + "include \"b.alhazen\"" + closers));
    EXPECT_EQ(i.errors(), 1u) << i.messages();
    EXPECT_TRUE(i.says("nested deeper than 256"));
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
