#include "alhazen/base/file.h"

#include <csignal>
#include <fstream>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "alhazen/base/error.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

namespace fs = std::filesystem;

class File : public ::testing::Test {
  protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "alhazen-file-XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    void put(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::size_t file_count() const {
        return std::size_t(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

template <class Call>
ErrorKind kind_of_error(Call call) {
    try {
        call();
    } catch (const Error& error) {
        return error.kind();
    }
    ADD_FAILURE() << "nothing was thrown";
    return ErrorKind::Render;
}

TEST_F(File, ReadsBackEveryByteThatWasWritten) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += char(i * 7);
    write_file_atomically(folder_ / "a", text);
    EXPECT_EQ(read_file(folder_ / "a"), text);
    write_file_atomically(folder_ / "a", std::string());
    EXPECT_EQ(read_file(folder_ / "a"), "");
    write_file_atomically(folder_ / "a", std::as_bytes(std::span(text)), Sync::Later);
    EXPECT_EQ(read_file(folder_ / "a"), text);
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, MissingFilesAndFoldersAreFileErrors) {
    EXPECT_EQ(kind_of_error([&] { (void)read_file(folder_ / "none"); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { (void)read_file(folder_); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { (void)read_file(""); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { write_file_atomically(folder_ / "x" / "y", "text"); }),
              ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { write_file_atomically(folder_, "text"); }), ErrorKind::File);
}

TEST_F(File, NamesThatHoldANulAreRefused) {
    put("a", "text");
    const fs::path name = folder_ / std::string("a\0b", 3);
    EXPECT_EQ(kind_of_error([&] { (void)read_file(name); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { write_file_atomically(name, "new"); }), ErrorKind::File);
    EXPECT_EQ(read_file(folder_ / "a"), "text");
}

TEST_F(File, PipesAndDevicesAreRefusedAtOnce) {
    const fs::path pipe = folder_ / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_EQ(kind_of_error([&] { (void)read_file(pipe); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { (void)read_file("/dev/zero"); }), ErrorKind::File);
    EXPECT_EQ(kind_of_error([&] { write_file_atomically(pipe, "text"); }), ErrorKind::File);
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST_F(File, ReadingStopsAtTheByteLimit) {
    put("a", "12345");
    EXPECT_EQ(read_file(folder_ / "a", 5), "12345");
    EXPECT_EQ(kind_of_error([&] { (void)read_file(folder_ / "a", 4); }), ErrorKind::Resource);
}

TEST_F(File, FilesThatReportNoSizeAreReadWhole) {
    if (!fs::exists("/proc/self/status")) GTEST_SKIP() << "no /proc here";
    EXPECT_FALSE(read_file("/proc/self/status").empty());
    EXPECT_EQ(kind_of_error([&] { (void)read_file("/proc/self/status", 10); }),
              ErrorKind::Resource);
}

TEST_F(File, AFailedWriteLeavesTheOldFileAndNothingElse) {
    put("a", "old");
    // A limit on the size of files simulates a full disk.
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit small = before;
    small.rlim_cur = 1000;
    const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const ErrorKind kind =
        kind_of_error([&] { write_file_atomically(folder_ / "a", std::string(5000, 'x')); });
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, old_handler);
    EXPECT_EQ(kind, ErrorKind::File);
    EXPECT_EQ(read_file(folder_ / "a"), "old");
    EXPECT_EQ(file_count(), 1u);
}

TEST_F(File, WritingKeepsPermissionsAndLinks) {
    put("a", "old");
    ASSERT_EQ(::chmod((folder_ / "a").c_str(), 0640), 0);
    fs::create_symlink("a", folder_ / "link");
    write_file_atomically(folder_ / "link", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(read_file(folder_ / "a"), "new");
    EXPECT_EQ(int(fs::status(folder_ / "a").permissions()), 0640);
}

TEST_F(File, ALinkToAFileThatIsMissingStaysALink) {
    fs::create_directory(folder_ / "own");
    fs::create_symlink("../second", folder_ / "own/first");
    fs::create_symlink("third", folder_ / "second");
    check_writable(folder_ / "own/first");
    write_file_atomically(folder_ / "own/first", "new");
    EXPECT_TRUE(fs::is_symlink(folder_ / "own/first"));
    EXPECT_TRUE(fs::is_symlink(folder_ / "second"));
    EXPECT_EQ(read_file(folder_ / "third"), "new");
    fs::create_symlink("nowhere/file", folder_ / "lost");
    EXPECT_EQ(kind_of_error([&] { check_writable(folder_ / "lost"); }), ErrorKind::File);
    fs::create_symlink("round", folder_ / "round");
    EXPECT_EQ(kind_of_error([&] { write_file_atomically(folder_ / "round", "new"); }),
              ErrorKind::File);
    EXPECT_TRUE(fs::is_symlink(folder_ / "round"));
}

TEST_F(File, NamesOfTheGreatestLengthCanBeWritten) {
    const std::string name(255, 'n');
    write_file_atomically(folder_ / name, "text");
    EXPECT_EQ(read_file(folder_ / name), "text");
}

TEST(ResolveInside, NamesBelowTheRootAreFound) {
    EXPECT_EQ(resolve_inside("/a", "/a/b", "c.png"), "/a/b/c.png");
    EXPECT_EQ(resolve_inside("/a", "/a/b", "../c.png"), "/a/c.png");
    EXPECT_EQ(resolve_inside("/a/", "/a/b/", "./x/../c.png"), "/a/b/c.png");
    EXPECT_EQ(resolve_inside("", "", "c.png"), "c.png");
    EXPECT_EQ(resolve_inside(".", "sub", "../c.png"), "c.png");
    EXPECT_EQ(resolve_inside("/", "/", "c.png"), "/c.png");
    EXPECT_EQ(resolve_inside("/a", "/a", "..c.png"), "/a/..c.png");
}

TEST(ResolveInside, NamesThatLeaveTheRootAreSceneErrors) {
    const std::vector<std::string> names{"",          "/etc/passwd", "../c", "../ab/c",
                                         "b/../../c", "..",          "./..", "../../../../c",
                                         {"c\0d", 3}, "b/./../../c", "//c"};
    for (const std::string& name : names) {
        EXPECT_EQ(kind_of_error([&] { (void)resolve_inside("/a", "/a", name); }), ErrorKind::Scene)
            << name;
    }
    EXPECT_EQ(kind_of_error([&] { (void)resolve_inside("", "", "../c"); }), ErrorKind::Scene);
}

TEST(ResolveInside, AnyOfSeveralRootsIsEnough) {
    const std::vector<std::filesystem::path> roots{"/a", "/x/y"};
    EXPECT_EQ(resolve_inside(roots, "/a", "b/c"), "/a/b/c");
    EXPECT_EQ(resolve_inside(roots, "/a", "../x/y/c"), "/x/y/c");
    EXPECT_EQ(resolve_inside(roots, "/a", "/x/y/c"), "/x/y/c");
    EXPECT_EQ(resolve_inside(roots, "/a", "/a/c"), "/a/c");
    for (const char* name : {"../x/c", "/x/yc", "/x/y/../c", "/etc/passwd"}) {
        EXPECT_EQ(kind_of_error([&] { (void)resolve_inside(roots, "/a", name); }), ErrorKind::Scene)
            << name;
    }
}

TEST_F(File, LinksMustLeadIntoOneOfTheRoots) {
    for (const char* name : {"own", "other", "third"}) fs::create_directory(folder_ / name);
    fs::create_symlink("../other", folder_ / "own/link");
    fs::create_symlink("../third", folder_ / "own/away");
    const std::vector<fs::path> roots{folder_ / "own", folder_ / "other"};
    EXPECT_EQ(resolve_inside(roots, folder_ / "own", "link/c"), folder_ / "own/link/c");
    EXPECT_EQ(kind_of_error([&] { (void)resolve_inside(roots, folder_ / "own", "away/c"); }),
              ErrorKind::Scene);
    EXPECT_EQ(kind_of_error(
                  [&] { (void)resolve_inside(roots, folder_, (folder_ / "own/away/c").string()); }),
              ErrorKind::Scene);
}

TEST_F(File, OutputsAreDistinctByWhateverName) {
    fs::create_directory(folder_ / "deep");
    fs::create_symlink("out.png", folder_ / "link.png");
    fs::create_symlink(".", folder_ / "here");
    const fs::path out = folder_ / "out.png", other = folder_ / "out.json";
    check_distinct(std::vector<fs::path>{out, other, folder_ / "deep/out.png"});
    check_distinct(std::vector<fs::path>{"/dev/null", out, "/dev/null"});
    const fs::path relative = fs::relative(out);
    for (const bool exists : {false, true}) {
        if (exists) write_file_atomically(out, "a picture");
        for (const fs::path& same : {out, folder_ / "./out.png", folder_ / "deep/../out.png",
                                     folder_ / "link.png", folder_ / "here/out.png", relative}) {
            EXPECT_EQ(kind_of_error([&] {
                          check_distinct(std::vector<fs::path>{other, out, same});
                      }),
                      ErrorKind::Usage)
                << same << exists;
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
